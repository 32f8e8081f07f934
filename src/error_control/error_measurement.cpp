// What trial runs say of the errors of mesh and step, and how far these may be changed.
#include <algorithm>
#include <cmath>

#include "base/whole.hpp"
#include "error_control/model_search.hpp"
#include "error_control/search_constants.hpp"
#include "run/plan.hpp"

namespace traverse::app {
namespace {

/// Whether there are supports whose dampers act only while they are touched: then accelerations jump.
bool dampers_let_go(const beam::Foundation& foundation) {
  bool found = false;
  for_points(foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points)
      found = found || (point.c > 0.0 && (point.law.one_sided || point.law.gap > 0.0));
  });
  return found;
}

/// A mesh between this one and half of it, with nodes at the springs where these have them; else half of it.
int mesh_between(const Scene& scene, int mesh) {
  const int between = 2 * (3 * mesh / 8);
  return between > mesh / 2 && (aligned(scene, between) || !aligned(scene, mesh)) ? between : mesh / 2;
}

/// What half the elements would change, times what a mesh between changes, where errors fall with the square.
double as_if_halved(int mesh, int between) {
  return (std::exp2(search::mesh_order) - 1.0) /
         (std::pow(static_cast<double>(mesh) / between, search::mesh_order) - 1.0);
}

}  // namespace

// Those of a given mesh or step too, where there are coarser ones to compare with.
void ModelSearch::measure() {
  const ResponseExtremes& fine = trials_.run(mesh_, step_);
  Errors time = time_, space = space_;
  for (std::size_t i = 0; i < quantities; ++i) {
    const auto q = static_cast<Quantity>(i);
    const bool filtered = q == low_passed && asks_for(scene_, q);  // a run that soon ends has no peak that is settled
    const bool axial =
        q == axial_displacement || q == axial_force;  // little more than rounding, unless it is asked for
    promises_[q].present =
        (fine.failed() || fine.largest(q).value != 0.0 || filtered) && (!axial || asks_for(scene_, q));
    if (open_step_ || step_ <= longest_step_) time[q] = error_in_time(q);
    if (mesh_ % 2 == 0) space[q] = error_in_space(q);
  }
  time_ = time;
  space_ = space;
  count_alike();
  measured_ = {step_, mesh_};
}

// Forces of wheels that strike are pulses: a step may agree with the next one by chance.
void ModelSearch::count_alike() {
  const auto alike = [&](Quantity q) { return !promised(q) || time_[q].change <= scene_.accuracy; };
  if (!trials_.lost_contact() || !open_step_)
    impact_agreement_ = search::enough_alike;
  else
    impact_agreement_ = alike(acceleration) && alike(wheel_force) && alike(low_passed) ? impact_agreement_ + 1 : 0;
}

ErrorModel ModelSearch::error_in_time(Quantity q) {
  const double change = difference(trials_.run(mesh_, 2.0 * step_), trials_.run(mesh_, step_), q, 6.0 * step_);
  // Without damping a moment is a sum of 1/n^2 over all modes, of which a step follows those below a frequency: two
  // may agree on what they both leave.
  const bool sums = q == moment && undamped_;
  double most = !sums ? search::full_order : time_[q].known && time_[q].order > 1.5 ? 2.0 : 1.0;
  if ((q == acceleration || q == low_passed) && dampers_let_go(scene_.beam->foundation)) most = 1.0;
  return error_from((sums ? search::undamped_sum : 1.0) * growth_ * change, step_, time_[q], most);
}

double ModelSearch::changed_by_mesh(int other, double step, Quantity q, const std::string& integrator) {
  const ResponseExtremes& rough = trials_.run(other, step, integrator);
  return std::pow(growth_, 0.75) * difference(rough, trials_.run(mesh_, step, integrator), q, 3.0 * step);
}

// With twice the step, at half the cost: runs that the error in time asks for too. Steps over more than an element
// would hide what elements do. Along a track, where more elements cost more than a trial run, the step itself is tried
// before these are: long ones see more in the mesh than there is.
ErrorModel ModelSearch::error_in_space(Quantity q) {
  const double element = *std::max_element(scene_.beam->spans.begin(), scene_.beam->spans.end()) / mesh_;
  // Without damping the contact's vibration meets one mode of the elements or another: nothing falls regularly.
  // At fine accuracies what a mesh leaves of an acceleration and of a wheel's force comes and goes with where its nodes
  // are: the square is believed at most, and a mesh between tells whether the two agree by chance.
  const bool comes_and_goes = (q == acceleration || q == wheel_force) && scene_.accuracy <= search::small_error;
  const double by_nodes = comes_and_goes ? search::mesh_order : search::full_order;
  const int between = comes_and_goes && promised(q) ? mesh_between(scene_, mesh_) : mesh_ / 2;
  const auto change = [&](double step) {
    const double halved = changed_by_mesh(mesh_ / 2, step, q);
    if (between == mesh_ / 2) return halved;
    return std::max(halved, as_if_halved(mesh_, between) * changed_by_mesh(between, step, q));
  };
  const double most = q == low_passed && undamped_ ? 1.0 : by_nodes;
  const auto error = [&](double step) { return error_from(change(step), 1.0 / mesh_, space_[q], most); };
  if (!open_step_ || 2.0 * step_ * greatest_speed(scene_) >= element) return error(step_);
  const ErrorModel by_long_steps = error(2.0 * step_);
  const bool tries_again = scene_.beam->track && promised(q) && by_long_steps.value > allowed(space_, q);
  return tries_again ? error(step_) : by_long_steps;
}

/// Of a quantity's error. A track's mesh, of which there are so few to choose from, may have what the step leaves.
double ModelSearch::allowed(const Errors& errors, std::size_t q) const {
  const bool few_meshes = &errors == &space_ && scene_.beam->track;
  return few_meshes ? wanted_ + std::max(0.0, wanted_ - time_[q].value) : wanted_;
}

/// Times the step (or the element) at which all that is promised keeps its share.
double ModelSearch::room(const Errors& errors) const {
  double least = search::farthest_left * search::farthest_guess;
  for (std::size_t q = 0; q < quantities; ++q)
    if (promised(q)) least = std::min(least, errors[q].room(allowed(errors, q)));
  return least;
}

/// What could not be promised is not to become much worse than it was.
double ModelSearch::room_to_coarsen(const Errors& errors) const {
  double least = room(errors);
  for (std::size_t q = 0; q < quantities; ++q)
    if (promises_[q].present && tried_[q]) least = std::min(least, std::max(1.0, errors[q].room(effort())));
  return least;
}

bool ModelSearch::costs_next_to_nothing() const {
  return trials_.seconds() + 2.0 * trials_.seconds(2 * mesh_, 0.5 * step_) < search::free_seconds;
}

/// How far the peaks of a step are from those of the finest one. Where it costs next to nothing, the larger one of this
/// and of a slightly shorter step, which ends at other places.
double ModelSearch::changed_by_step(double step, double finest, Quantity q) {
  const ResponseExtremes& fine = trials_.run(mesh_, finest);
  double change = step == finest ? 0.0 : difference(trials_.run(mesh_, step), fine, q, 3.0 * step);
  if (costs_next_to_nothing())
    change = std::max(change, difference(trials_.run(mesh_, search::elsewhere * step), fine, q, 3.0 * step));
  return growth_ * change;
}

// What peaks depend on where steps end is an error of the step, and nothing tells how fast it falls.
void ModelSearch::measure_elsewhere() {
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!open_step_ || !promised(q)) continue;
    const double change = changed_by_step(step_, step_, static_cast<Quantity>(q));
    if (change <= std::max(wanted_, time_[q].value)) continue;
    time_[q].value = change;
    time_[q].order = search::least_order;
    time_[q].known = true;
  }
}

bool ModelSearch::within_reach(const Errors& errors) const {
  const bool cheap = costs_next_to_nothing();
  for (std::size_t q = 0; q < quantities; ++q) {
    const ErrorModel& e = errors[q];
    // Two changes tell an order by chance; where it costs next to nothing a third one is asked, of sums in any case.
    const bool told = e.change <= wanted_ && !(undamped_ && q == moment);
    if (cheap && promised(q) && !e.confirmed && !told) return false;
    const double room = e.room(allowed(errors, q));
    if (!promised(q) || room >= 1.0) continue;
    if ((e.known && e.order < 1.0) || room < 1.0 / (e.known ? search::farthest : search::farthest_supposed))
      return false;
  }
  return true;
}

// Longer steps only between two that are measured.
double ModelSearch::factor_of_step() const {
  const double factor = std::clamp(room(time_), 1.0 / search::farthest_left, 1.0);
  if (factor < 1.0 || !coarser_) return factor;
  double least = std::min(2.0, room_to_coarsen(time_));
  for (std::size_t q = 0; q < quantities; ++q) {
    if (!promised(q) || time_[q].value == 0.0) continue;
    const double growth = (*coarser_)[q].value / time_[q].value,
                 allowed = search::share_between * wanted_ / time_[q].value;
    if (growth > allowed) least = std::min(least, std::exp2(std::log(allowed) / std::log(growth)));
  }
  return std::max(least, 1.0);
}

double ModelSearch::factor_of_elements() const {
  return std::clamp(room(space_) < 1.0 ? room(space_) : room_to_coarsen(space_), 1.0 / search::farthest_left,
                    most_coarsening_);
}

/// Times the step (or the element) that the run will need, as far as is known: what would need still less by the order
/// that was measured will be refused.
double ModelSearch::guess(const Errors& errors) const {
  double least = 1.0;
  for (std::size_t q = 0; q < quantities; ++q) {
    const double room = promised(q) ? errors[q].room(allowed(errors, q)) : 1.0;
    if (room >= 1.0 / search::farthest_guess || !errors[q].known)
      least = std::min(least, std::max(room, 1.0 / search::farthest_guess));
  }
  return least;
}

// Whether trial runs with these cost no more than a part of what the whole run will, or hardly anything.
bool ModelSearch::worth_it(double step, int mesh) const {
  const double run = trials_.seconds(base::whole(mesh_ / guess(space_)), guess(time_) * step_) * end_ / horizon_;
  return trials_.seconds() + 2.0 * trials_.seconds(mesh, step) <
         std::max(search::cheap_seconds,
                  (scene_.accuracy_whole ? search::part_of_run_whole : search::part_of_run) * run);
}

}  // namespace traverse::app
