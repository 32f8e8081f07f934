// Determines the discretisation errors of mesh and step from trial runs, and the factors by which these may be changed.
#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "error_control/model_search.hpp"
#include "error_control/search_constants.hpp"
#include "run/plan.hpp"

namespace traverse::error_control {

using run::acceleration;
using run::axial_displacement;
using run::axial_force;
using run::low_passed;
using run::moment;
using run::quantities;
using run::wheel_force;

namespace {

/// Whether supports have dampers that act only in contact, so that accelerations jump.
bool has_contact_dampers(const beam::Foundation& foundation) {
  bool found = false;
  for_points(foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points)
      found = found || (point.c > 0.0 && (point.law.one_sided || point.law.gap > 0.0));
  });
  return found;
}

/// A mesh between this one and half of it, with nodes at the springs if this one has them; otherwise half of it.
int mesh_in_between(const scene::Scene& scene, int mesh) {
  const int between = 2 * (3 * mesh / 8);
  return between > mesh / 2 && (aligned(scene, between) || !aligned(scene, mesh)) ? between : mesh / 2;
}

/// The factor from the change by a mesh in between to the change by half the elements, for an error of second order.
double halving_factor(int mesh, int between) {
  return (std::exp2(search::mesh_order) - 1.0) /
         (std::pow(static_cast<double>(mesh) / between, search::mesh_order) - 1.0);
}

}  // namespace

// Also measures a given mesh or step if coarser ones exist for comparison.
void ModelSearch::measure() {
  const run::ResponseExtremes& fine = trials_.run(mesh_, step_);
  Errors time = time_, space = space_;
  for (std::size_t i = 0; i < quantities; ++i) {
    const auto q = static_cast<run::Quantity>(i);
    const bool filtered =
        q == low_passed && is_controlled(scene_, q);  // present even if a run that ends early has no settled peak
    const bool axial = q == axial_displacement || q == axial_force;  // close to rounding errors, unless controlled
    estimates_[q].present =
        (fine.failed() || fine.largest(q).value != 0.0 || filtered) && (!axial || is_controlled(scene_, q));
    if (open_step_ || step_ <= longest_step_) time[q] = error_in_time(q);
    if (mesh_ % 2 == 0) space[q] = error_in_space(q);
  }
  time_ = time;
  space_ = space;
  count_agreements();
  measured_ = {step_, mesh_};
}

// Contact forces of impacts are pulses: two steps may agree by chance.
void ModelSearch::count_agreements() {
  const auto agrees = [&](run::Quantity q) { return !has_estimate(q) || time_[q].change <= scene_.accuracy; };
  if (!trials_.lost_contact() || !open_step_)
    impact_agreement_ = search::required_agreements;
  else
    impact_agreement_ = agrees(acceleration) && agrees(wheel_force) && agrees(low_passed) ? impact_agreement_ + 1 : 0;
}

ErrorModel ModelSearch::error_in_time(run::Quantity q) {
  const double change = run::difference(trials_.run(mesh_, 2.0 * step_), trials_.run(mesh_, step_), q, 6.0 * step_);
  // Without damping a moment is a sum of 1/n^2 over all modes, of which a step resolves those below a frequency: two
  // steps may agree although both neglect the same part.
  const bool sums = q == moment && undamped_;
  double most = !sums ? search::full_order : time_[q].known && time_[q].order > 1.5 ? 2.0 : 1.0;
  if ((q == acceleration || q == low_passed) && has_contact_dampers(scene_.beam->foundation)) most = 1.0;
  return error_from((sums ? search::undamped_sum : 1.0) * growth_ * change, step_, time_[q], most);
}

double ModelSearch::change_by_mesh(int other, double step, run::Quantity q, const std::string& integrator) {
  const run::ResponseExtremes& rough = trials_.run(other, step, integrator);
  return std::pow(growth_, 0.75) * run::difference(rough, trials_.run(mesh_, step, integrator), q, 3.0 * step);
}

// Uses twice the step at half the cost, because the error in time needs these runs too. A step that passes more than
// one element would hide the error of the mesh. Along a track, where more elements cost more than a trial run, the step
// itself is tried before the mesh is refined, because long steps overestimate the error of the mesh.
ErrorModel ModelSearch::error_in_space(run::Quantity q) {
  const double element = *std::max_element(scene_.beam->spans.begin(), scene_.beam->spans.end()) / mesh_;
  // Without damping the contact's vibration excites different modes of different meshes: the error is not regular.
  // At small accuracies the mesh error of an acceleration and of a wheel force depends on the positions of the nodes.
  // Then at most the second order is assumed, and a mesh in between shows whether two meshes agree by chance.
  const bool irregular = (q == acceleration || q == wheel_force) && scene_.accuracy <= search::small_error;
  const double max_order = irregular ? search::mesh_order : search::full_order;
  const int between = irregular && has_estimate(q) ? mesh_in_between(scene_, mesh_) : mesh_ / 2;
  const auto change = [&](double step) {
    const double halved = change_by_mesh(mesh_ / 2, step, q);
    if (between == mesh_ / 2) return halved;
    return std::max(halved, halving_factor(mesh_, between) * change_by_mesh(between, step, q));
  };
  const double most = q == low_passed && undamped_ ? 1.0 : max_order;
  const auto error = [&](double step) { return error_from(change(step), 1.0 / mesh_, space_[q], most); };
  if (!open_step_ || 2.0 * step_ * scene::greatest_speed(scene_) >= element) return error(step_);
  const ErrorModel long_step_error = error(2.0 * step_);
  const bool uses_own_step = scene_.beam->track && has_estimate(q) && long_step_error.value > allowed(space_, q);
  return uses_own_step ? error(step_) : long_step_error;
}

/// The allowed error of a quantity. The mesh of a track, with few possible values, may use the part that the step does
/// not.
double ModelSearch::allowed(const Errors& errors, std::size_t q) const {
  const bool few_meshes = &errors == &space_ && scene_.beam->track;
  return few_meshes ? allowed_error_ + std::max(0.0, allowed_error_ - time_[q].value) : allowed_error_;
}

/// The ratio of the allowed time step (or element length) to the present one: the least ratio of all quantities with an
/// estimate.
double ModelSearch::allowed_ratio(const Errors& errors) const {
  double least = search::max_extrapolation_at_end * search::max_prediction;
  for (std::size_t q = 0; q < quantities; ++q)
    if (has_estimate(q)) least = std::min(least, errors[q].allowed_ratio(allowed(errors, q)));
  return least;
}

/// Like allowed_ratio, but a rejected quantity limits the ratio too, because its error must not become much larger.
double ModelSearch::coarsening_ratio(const Errors& errors) const {
  double least = allowed_ratio(errors);
  for (std::size_t q = 0; q < quantities; ++q)
    if (estimates_[q].present && rejected_by_search_[q])
      least = std::min(least, std::max(1.0, errors[q].allowed_ratio(coarsening_limit())));
  return least;
}

bool ModelSearch::is_cheap() const {
  return trials_.seconds() + 2.0 * trials_.seconds(2 * mesh_, 0.5 * step_) < search::free_seconds;
}

/// The difference between the peaks with a time step and the peaks with the finest step. If runs are cheap, the larger
/// difference of this step and a slightly shorter step is returned, because shorter steps end at other positions.
double ModelSearch::change_by_step(double step, double finest, run::Quantity q) {
  const run::ResponseExtremes& fine = trials_.run(mesh_, finest);
  double change = step == finest ? 0.0 : run::difference(trials_.run(mesh_, step), fine, q, 3.0 * step);
  if (is_cheap())
    change = std::max(change, run::difference(trials_.run(mesh_, search::shifted_step * step), fine, q, 3.0 * step));
  return growth_ * change;
}

// A dependence of the peaks on the end positions of steps is an error of the step; its order is unknown.
void ModelSearch::measure_shifted_steps() {
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!open_step_ || !has_estimate(q)) continue;
    const double change = change_by_step(step_, step_, static_cast<run::Quantity>(q));
    if (change <= std::max(allowed_error_, time_[q].value)) continue;
    time_[q].value = change;
    time_[q].order = search::least_order;
    time_[q].known = true;
  }
}

bool ModelSearch::can_extrapolate(const Errors& errors) const {
  const bool cheap = is_cheap();
  for (std::size_t q = 0; q < quantities; ++q) {
    const ErrorModel& e = errors[q];
    // Two changes may determine an order by chance. A third change is required if runs are cheap, and always for sums
    // over modes.
    const bool certain = e.change <= allowed_error_ && !(undamped_ && q == moment);
    if (cheap && has_estimate(q) && !e.confirmed && !certain) return false;
    const double ratio = e.allowed_ratio(allowed(errors, q));
    if (!has_estimate(q) || ratio >= 1.0) continue;
    if ((e.known && e.order < 1.0) ||
        ratio < 1.0 / (e.known ? search::max_extrapolation : search::max_extrapolation_supposed))
      return false;
  }
  return true;
}

// Allows longer steps only between two measured ones.
double ModelSearch::factor_of_step() const {
  const double factor = std::clamp(allowed_ratio(time_), 1.0 / search::max_extrapolation_at_end, 1.0);
  if (factor < 1.0 || !coarser_) return factor;
  double least = std::min(2.0, coarsening_ratio(time_));
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!has_estimate(q) || time_[q].value == 0.0) continue;
    const double growth = (*coarser_)[q].value / time_[q].value,
                 allowed = search::share_between * allowed_error_ / time_[q].value;
    if (growth > allowed) least = std::min(least, std::exp2(std::log(allowed) / std::log(growth)));
  }
  return std::max(least, 1.0);
}

double ModelSearch::factor_of_elements() const {
  return std::clamp(allowed_ratio(space_) < 1.0 ? allowed_ratio(space_) : coarsening_ratio(space_),
                    1.0 / search::max_extrapolation_at_end, max_coarsening_);
}

/// The ratio of the run's final step (or element) to the present one, as far as known. Quantities that would need a
/// smaller one by their measured order will be rejected.
double ModelSearch::predicted_ratio(const Errors& errors) const {
  double least = 1.0;
  for (std::size_t q = 0; q < quantities; ++q) {
    const double ratio = has_estimate(q) ? errors[q].allowed_ratio(allowed(errors, q)) : 1.0;
    if (ratio >= 1.0 / search::max_prediction || !errors[q].known)
      least = std::min(least, std::max(ratio, 1.0 / search::max_prediction));
  }
  return least;
}

// Whether trial runs with these values cost at most a part of the whole run, or very little.
bool ModelSearch::is_affordable(double step, int mesh) const {
  const double run =
      trials_.seconds(base::whole(mesh_ / predicted_ratio(space_)), predicted_ratio(time_) * step_) * end_ / window_;
  return trials_.seconds() + 2.0 * trials_.seconds(mesh, step) <
         std::max(search::cheap_seconds,
                  (scene_.accuracy_whole ? search::part_of_run_whole : search::part_of_run) * run);
}

}  // namespace traverse::error_control
