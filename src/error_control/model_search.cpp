// Halves step and elements until the estimated errors are small enough, then compares cheaper steps, meshes and
// integrators with the finest run.
#include "error_control/model_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/numbers.hpp"
#include "base/one_step_methods.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_window.hpp"
#include "integrate/integrators.hpp"
#include "run/deck_acceleration.hpp"
#include "run/plan.hpp"

namespace traverse::error_control {

using run::acceleration;
using run::low_passed;
using run::quantities;
using run::wheel_force;

namespace {

constexpr double max_windows = 10.0;  // initial windows: largest duration of trial runs that include later events
constexpr double energy_step_factor = 0.25;  // reduction of a step that dissipates too much energy
constexpr double whole_run_share = 0.8;      // share of the run from which trial runs cover it completely

/// The largest number of two digits that does not exceed x.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::floor(x / unit * (1.0 + 1e-9)) * unit;
}

double first_omega(const run::SharedBeam& shared) { return shared.omega ? shared.omega->first : 0.0; }

int max_trial_elements(const scene::Scene& scene) {
  const int dense = search::max_in_all / static_cast<int>(std::min<std::size_t>(scene.beam->spans.size(), 1000));
  return std::max(scene.beam->track ? search::max_in_a_bay : std::clamp(dense, 32, search::max_in_a_span),
                  4 * mesh_of(scene));
}

}  // namespace

ModelSearch::ModelSearch(MPI_Comm comm, const scene::Scene& scene, const run::SharedBeam& shared, double end)
    : comm_(comm),
      scene_(scene),
      end_(end),
      window_(scene.accuracy_whole ? end - trimmed_time() : window_end(shared)),
      trials_(comm, restrict_to_window(trim_approach(scene), window_)),
      open_mesh_(scene.mesh_open),
      open_step_(!scene.model.step),
      open_integrator_(!integrate::type_is_given() && !scene.sweep && !scene.study),
      allowed_error_((scene.accuracy > search::small_error ? search::share : search::small_share) * scene.accuracy),
      mesh_(mesh_of(scene)),
      max_elements_(max_trial_elements(scene)) {
  for (ErrorEstimate& p : estimates_) p.present = p.accepted = true;
  for (ErrorModel& e : space_)
    if (scene.beam->track) e.order = search::track_order;
  const double omega = first_omega(shared);
  const FirstSteps steps = first_steps(scene, omega, window_);
  longest_step_ = steps.longest;
  step_of_period_ = open_step_ ? steps.of_period : 0.0;
  step_reason_ = open_step_ ? steps.why : "the step is given";
  first_step_ = step_ = open_step_ ? two_digits(steps.first) : *scene.model.step;
  const auto ratios = shared.damping_ratios();
  const double decay = scene.by_given_modes() ? scene.beam->given->ratio.front() * omega
                       : ratios.empty()       ? 0.0
                                              : (ratios.front().beam + ratios.front().dampers) * omega;
  const double remaining = end - trimmed_time();
  growth_ = std::clamp(std::min(remaining, decay > 0.0 ? 1.0 / decay : remaining) / window_, 1.0, search::max_growth);
  for (std::size_t q = 0; q < quantities; ++q)
    if (!is_controlled(scene, q)) reject(q, why_not_controlled(scene, q));
  if (!resolves_contacts(scene, step_))
    reject(wheel_force, fmt::format("the contact vibrates at {:.3g} Hz, which steps of {:.2g} s do not resolve",
                                    contact_frequency(scene) / (2.0 * std::numbers::pi), step_));
  // A force that enters a beam excites all modes, the nth with an acceleration proportional to 1/n.
  undamped_ = shared.rayleigh.b <= 0.0 && !scene.beam->track && !scene.by_given_modes();
  if (undamped_) reject(acceleration, no_sum);
}

/// The time by which trial runs start later than the run, s.
double ModelSearch::trimmed_time() const {
  return initial_window(scene_, end_) - initial_window(trim_approach(scene_), end_);
}

/// The end of trial runs, s: the initial window, extended by the later events.
double ModelSearch::window_end(const run::SharedBeam& shared) {
  const scene::Scene scene = trim_approach(scene_);
  const double first = initial_window(scene, end_);
  const double step = scene_.model.step.value_or(first_steps(scene_, first_omega(shared), first).first);
  double until = first;
  for (const LaterEvent& event : later_events(scene, first, end_ - trimmed_time())) {
    const TrialRuns longer(comm_, restrict_to_window(scene, event.until));
    if (event.until <= max_windows * first ||
        search::typical_runs * longer.seconds(mesh_of(scene_), step) < search::cheap_seconds) {
      until = event.until;
    } else if (not_covered_.empty()) {
      not_covered_ = event.what;
    }
  }
  if (scene_.accuracy <= search::small_error && is_controlled(scene_, wheel_force))
    until =
        scene_.accuracy < search::small_error && has_undamped_vehicle(scene) ? end_ : extend_by_bounce(scene, until);
  if (is_controlled(scene_, low_passed)) until += run::unsettled_end(*scene_.output.low_pass);
  const double whole = end_ - trimmed_time();
  return until < whole_run_share * whole ? until : whole;
}

void ModelSearch::run() {
  search();
  reject_given_model();
  for (std::size_t q = 0; q < quantities && !not_covered_.empty(); ++q)
    reject(q, "trial runs that include " + not_covered_ + " would be too long");
}

// If trial runs become too expensive, the measured errors decide.
void ModelSearch::search() {
  try {
    if (search::min_runs * trials_.seconds(mesh_, step_) > search::max_seconds) throw CostLimitExceeded();
    accept_damped_vibration();
    refine();
    coarsen();
    coarsen_mesh();
    try_cheaper_methods();
    check_predicted_mesh();
  } catch (const CostLimitExceeded&) {
    if (!measured_) throw_too_expensive();
    std::tie(step_, mesh_) = *measured_;
    max_coarsening_ = 1.0;
    reject_inaccurate();
    for (std::size_t q = 0; q < quantities; ++q)
      if (prediction_fails(q)) reject(q, "the mesh that it needs would require too many trial runs");
  }
}

// Steps that are long compared with the beam's first period give the static response to forces: the method damps the
// vibration at once. The dissipated energy is proportional to the square of the vibration's amplitude, relative to the
// static response.
void ModelSearch::accept_damped_vibration() {
  if (step_of_period_ == 0.0) return;
  const double amplitude = search::share_of_vibration * allowed_error_;
  while (step_ > step_of_period_ && trials_.energy_missing(mesh_, step_) > amplitude * amplitude)
    step_ = two_digits(std::max(energy_step_factor * step_, step_of_period_));
  first_step_ = step_;
  if (step_ > step_of_period_)
    reject(acceleration, fmt::format("the beam vibrates with the first period of {:.3g} s, which steps of {:.2g} s do "
                                     "not resolve",
                                     trial_steps_per_period * step_of_period_, step_));
}

void ModelSearch::throw_too_expensive() const {
  throw InputError(
      fmt::format("accuracy = {:g}: the trial runs that choose mesh and step would take {:.1g} steps of {:.1g} s with "
                  "{} elements a {} and more ({}), which exceeds their limit; check the masses, stiffnesses and "
                  "lengths of the scene, or set ts_dt and {} to avoid trial runs",
                  scene_.accuracy, window_ / step_, step_, mesh_, unit_of_mesh(), step_reason_,
                  scene_.beam->track ? "track_elements_per_bay" : "beam_elements_per_span"));
}

void ModelSearch::refine() {
  for (int round = 0; round < search::max_halvings; ++round) {
    measure();
    reject_unconverged();
    const auto converged = [&] { return can_extrapolate(time_) && impact_agreement_ >= search::required_agreements; };
    const bool refine_mesh = open_mesh_ && !can_extrapolate(space_);
    if (!refine_mesh && converged()) measure_shifted_steps();
    const bool halve_step = open_step_ && !converged();
    if (!halve_step && !refine_mesh) return;
    if (!is_affordable(halve_step ? 0.5 * step_ : step_, refine_mesh ? 2 * mesh_ : mesh_)) return reject_inaccurate();
    if (halve_step) step_ *= 0.5;
    if (refine_mesh) mesh_ *= 2;
  }
  reject_inaccurate();
}

// Compares longer steps with the finest one.
void ModelSearch::coarsen() {
  finest_step_ = step_;
  finest_ = time_;
  if (!open_step_) return;
  for (double step = 2.0 * finest_step_; step <= longest_step_; step *= 2.0) {
    if (trials_.run(mesh_, step).failed()) return;  // errors of steps in between are unknown
    Errors longer = finest_;
    for (std::size_t q = 0; q < quantities; ++q)
      longer[q].value += change_by_step(step, finest_step_, static_cast<run::Quantity>(q));
    if (excess(longer, finest_, space_) > 1.0) {
      coarser_ = longer;
      return;
    }
    step_ = step;
    time_ = longer;
  }
}

// Uses fewer elements where a rejected quantity required more than the others need.
void ModelSearch::coarsen_mesh() {
  if (!open_mesh_ ||
      std::none_of(rejected_by_search_.begin(), rejected_by_search_.end(), [](bool tried) { return tried; }))
    return;
  max_coarsening_ = 1.0;
  const Errors finest = space_;
  const int finest_mesh = mesh_;
  for (int mesh = finest_mesh / 2; mesh % 2 == 0; mesh /= 2) {
    Errors coarser = finest;
    for (std::size_t q = 0; q < quantities; ++q)
      coarser[q].value += growth_ * run::difference(trials_.run(mesh, step_), trials_.run(finest_mesh, step_),
                                                    static_cast<run::Quantity>(q), 3.0 * step_);
    if (excess(coarser, finest, time_) > 1.0) return;
    mesh_ = mesh;
    space_ = coarser;
    finest_step_ = step_;  // on this mesh
    finest_ = time_;
  }
}

// Compares methods of lower order, which have fewer solves in each step, with the finest run, if the cost of the trial
// is only a part of their saving.
void ModelSearch::try_cheaper_methods() {
  if (!open_step_ || !open_integrator_) return;
  const double usual = factor_of_step() * step_;
  const double run = trials_.seconds(base::whole(mesh_ / factor_of_elements()), usual) * end_ / window_;
  double spent = 0.0;
  for (const base::MethodRow& method : base::methods().subspan(1))
    for (const double factor : search::shorter_steps) {
      const double step = factor * usual;
      spent += trials_.seconds(mesh_, step, method.name);
      if (spent > search::trial_share_of_saving * run) return;
      Errors errors = finest_;
      for (std::size_t q = 0; q < quantities; ++q)
        errors[q].value +=
            growth_ * run::difference(trials_.run(mesh_, step, method.name), trials_.run(mesh_, finest_step_),
                                      static_cast<run::Quantity>(q), 3.0 * step);
      double ratio = 0.0;  // relative to the share that the mesh leaves
      for (std::size_t q = 0; q < quantities; ++q)
        if (has_estimate(q))
          ratio = std::max(ratio, errors[q].value / (2.0 * allowed_error_ - std::min(space_[q].value, allowed_error_)));
      if (ratio * std::pow(search::shorter_steps.back() / factor, method.order) > 1.0)
        break;  // the shortest step is not accurate enough either
      if (ratio > 1.0 || excess(errors, finest_, space_) > 2.0) continue;
      integrator_ = method.name;
      step_ = step;
      time_ = errors;
      coarser_.reset();
      return;
    }
}

/// The necessary number of elements of a span (or bay), as far as known.
int ModelSearch::predicted_mesh() const {
  const double fewer = factor_of_elements();
  int mesh = mesh_;
  if (open_mesh_ && scene_.beam->track) mesh = base::whole(std::ceil(mesh_ / fewer));
  if (open_mesh_ && !scene_.beam->track) {
    int needed = std::max(4, 2 * base::whole(std::ceil(0.5 * mesh_ / fewer)));
    // Peaks depend on the positions of nodes: if about twice the elements are needed, exactly twice are used, as
    // compared.
    if (needed > 1.5 * mesh_ && needed < 2.5 * mesh_) needed = 2 * mesh_;
    mesh = aligned_mesh(scene_, needed);
    // Errors that were measured with nodes at the springs are not valid for other nodes.
    if (aligned(scene_, mesh_) && !aligned(scene_, mesh)) mesh = needed <= mesh_ ? mesh_ : 2 * mesh_;
  }
  return mesh;
}

// Wheels may pass nodes at the frequency of their vibration, so that errors differ from the errors of the compared
// meshes. Therefore a trial run uses the predicted mesh itself.
void ModelSearch::check_predicted_mesh() {
  if (scene_.beam->track || scene_.vehicles.empty()) return;
  for (int mesh = predicted_mesh(); mesh != mesh_; mesh = predicted_mesh()) {
    bool accurate = true;
    if (mesh > mesh_ && has_estimate(low_passed)) check_step_on(mesh);
    for (std::size_t q = 0; q < quantities; ++q) {
      if (!has_estimate(q)) continue;
      const double change = change_by_mesh(mesh, step_, static_cast<run::Quantity>(q), integrator_);
      predicted_errors_[q] = mesh < mesh_ ? change : std::max(0.0, change - space_[q].value);
      accurate = accurate && !prediction_fails(q);
    }
    if (accurate) return;
    if (mesh < mesh_) {
      max_coarsening_ = 1.0;
    } else if (mesh == 2 * mesh_ || (2 * mesh_ <= max_elements_ && is_affordable(step_, 2 * mesh_))) {
      mesh_ *= 2;
      Errors space;
      for (std::size_t q = 0; q < quantities; ++q) space[q] = error_in_space(static_cast<run::Quantity>(q));
      space_ = space;
      measured_ = {step_, mesh_};
    } else {
      for (std::size_t q = 0; q < quantities; ++q)
        if (prediction_fails(q))
          reject(q, fmt::format("the results with {} and {} elements a span differ by {:.1g}", mesh_, mesh,
                                predicted_errors_[q]));
    }
  }
}

// A filter uses the values at the ends of steps, where a wheel has varying positions in an element. The step's error of
// a low-passed acceleration therefore changes with the mesh, and may accidentally be very small on the one that was
// tried.
void ModelSearch::check_step_on(int mesh) {
  if (step_ == finest_step_ && integrator_.empty()) return;
  const run::ResponseExtremes& fine = trials_.run(mesh, finest_step_);
  Errors time = time_;
  for (std::size_t q = 0; q < quantities; ++q) {
    const double change =
        run::difference(trials_.run(mesh, step_, integrator_), fine, static_cast<run::Quantity>(q), 3.0 * step_);
    time[q].value = std::max(time[q].value, finest_[q].value + growth_ * change);
  }
  if (excess(time, finest_, space_) > 1.0) {
    step_ = finest_step_;
    time = finest_;
    integrator_.clear();
    coarser_.reset();
  }
  time_ = time;
}

/// With the predicted step.
bool ModelSearch::prediction_fails(std::size_t q) const {
  return predicted_errors_[q] + time_[q].at(std::min(1.0, factor_of_step())) > scene_.accuracy;
}

/// The largest ratio of an error to its allowed value. finest: errors of the finest run. other: errors of the mesh if
/// `errors` are the errors of the step. Errors of rejected quantities need not be smaller than their errors in
/// `finest`.
double ModelSearch::excess(const Errors& errors, const Errors& finest, const Errors& other) const {
  double most = 0.0;
  for (std::size_t q = 0; q < quantities; ++q) {
    if (has_estimate(q)) most = std::max(most, errors[q].value / allowed_error_);
    if (estimates_[q].present && rejected_by_search_[q])
      most = std::max(most, errors[q].value / std::max({coarsening_limit(), finest[q].value, other[q].value}));
  }
  return most;
}

Choice ModelSearch::choice() const {
  Choice choice{scene_.model, {}, {}};
  Accuracy& result = choice.accuracy;
  result.measured = true;
  result.lost_contact = trials_.lost_contact();
  if (window_ < end_ - trimmed_time()) result.covered_until = window_ + trimmed_time();
  const double step = open_step_ ? two_digits(step_ * factor_of_step()) : step_;
  const int mesh = predicted_mesh();
  choice.model.elements = mesh;
  choice.model.step = step;
  choice.model.method = integrator_;
  choice.model.step_probes = true;
  choice.model.local_compliance = true;
  for (std::size_t q = 0; q < quantities; ++q) {
    const double ratio = step / step_;
    double in_time = time_[q].at(ratio);
    if (coarser_ && ratio > 1.0 && time_[q].value > 0.0)  // between two measured steps
      in_time = time_[q].value * std::pow((*coarser_)[q].value / time_[q].value, std::log2(ratio));
    result.estimates[q] = estimates_[q];
    const double in_space =
        std::max(space_[q].at(static_cast<double>(mesh_) / mesh), mesh != mesh_ ? predicted_errors_[q] : 0.0);
    ErrorEstimate& estimate = result.estimates[q];
    estimate.expected = in_time + in_space;
    const bool measured = not_covered_.empty() && time_[q].size > 0.0 && space_[q].size > 0.0;
    if (!estimate.present || !is_optional(scene_, q) || !measured) continue;
    estimate.accepted = estimate.expected <= scene_.accuracy;
    estimate.why_not = fmt::format("{}, and its error with the model for the other quantities is {:.1g}",
                                   why_not_controlled(scene_, q), estimate.expected);
  }
  return choice;
}

}  // namespace traverse::error_control
