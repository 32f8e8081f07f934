// The search itself: step and elements are halved until the estimated errors are small enough, then steps, meshes and
// integrators of less cost are compared with the finest run.
#include "error_control/model_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/one_step_methods.hpp"
#include "base/whole.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_window.hpp"
#include "integrate/integrator_choice.hpp"
#include "run/deck_acceleration.hpp"
#include "run/plan.hpp"

namespace traverse::app {
namespace {

constexpr double most_beginnings = 10.0;     // that trial runs may last, to see what comes later
constexpr double less_of_the_energy = 0.25;  // times a step that loses too much of it
constexpr double most_of_the_run = 0.8;      // from there trial runs go on to see what a vehicle does behind the bridge

/// The largest number of two digits that does not exceed x.
double two_digits(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::floor(x / unit * (1.0 + 1e-9)) * unit;
}

double first_omega(const SharedBeam& shared) { return shared.omega ? shared.omega->first : 0.0; }

int most_trial_elements(const Scene& scene) {
  const int dense = search::most_in_all / static_cast<int>(std::min<std::size_t>(scene.beam->spans.size(), 1000));
  return std::max(scene.beam->track ? search::most_in_a_bay : std::clamp(dense, 32, search::most_in_a_span),
                  4 * mesh_of(scene));
}

}  // namespace

ModelSearch::ModelSearch(MPI_Comm comm, const Scene& scene, const SharedBeam& shared, double end)
    : comm_(comm),
      scene_(scene),
      end_(end),
      horizon_(scene.accuracy_whole ? end - moved_by() : until_all_is_met(shared)),
      trials_(comm, restrict_to_window(trim_approach(scene), horizon_)),
      open_mesh_(scene.mesh_open),
      open_step_(!scene.model.step),
      open_integrator_(!integrate::type_is_given() && !scene.sweep && !scene.study),
      wanted_((scene.accuracy > search::small_error ? search::share : search::small_share) * scene.accuracy),
      mesh_(mesh_of(scene)),
      most_elements_(most_trial_elements(scene)) {
  for (ErrorEstimate& p : promises_) p.present = p.kept = true;
  for (ErrorModel& e : space_)
    if (scene.beam->track) e.order = search::track_order;
  const double omega = first_omega(shared);
  const FirstSteps steps = first_steps(scene, omega, horizon_);
  longest_step_ = steps.longest;
  step_of_period_ = open_step_ ? steps.of_period : 0.0;
  shortest_ = open_step_ ? steps.why : "the step is given";
  first_step_ = step_ = open_step_ ? two_digits(steps.first) : *scene.model.step;
  const double decay = scene.by_given_modes() ? scene.beam->given->ratio.front() * omega
                                              : 0.5 * (shared.rayleigh.a + shared.rayleigh.b * omega * omega);
  const double left = end - moved_by();
  growth_ = std::clamp(std::min(left, decay > 0.0 ? 1.0 / decay : left) / horizon_, 1.0, search::most_growth);
  for (std::size_t q = 0; q < quantities; ++q)
    if (!asks_for(scene, q)) refuse(q, why_not_asked(scene, q));
  if (!follows_contacts(scene, step_))
    refuse(wheel_force, fmt::format("the contact vibrates at {:.3g} Hz, which steps of {:.2g} s do not follow",
                                    contact_frequency(scene) / (2.0 * std::numbers::pi), step_));
  // A force that comes onto a beam starts all its modes, the nth with an acceleration like 1/n.
  undamped_ = shared.rayleigh.b <= 0.0 && !scene.beam->track && !scene.by_given_modes();
  if (undamped_) refuse(acceleration, no_sum);
}

/// How much later than the run its trials begin, s.
double ModelSearch::moved_by() const {
  return initial_window(scene_, end_) - initial_window(trim_approach(scene_), end_);
}

/// The end of trial runs, s: the beginning, or as much later as it takes to see what is unlike all before.
double ModelSearch::until_all_is_met(const SharedBeam& shared) {
  const Scene scene = trim_approach(scene_);
  const double first = initial_window(scene, end_);
  const double step = scene_.model.step.value_or(first_steps(scene_, first_omega(shared), first).first);
  double until = first;
  for (const LaterEvent& meeting : later_events(scene, first, end_ - moved_by())) {
    const TrialRuns longer(comm_, restrict_to_window(scene, meeting.until));
    if (meeting.until <= most_beginnings * first ||
        search::usual_trials * longer.seconds(mesh_of(scene_), step) < search::cheap_seconds) {
      until = meeting.until;
    } else if (not_covered_.empty()) {
      not_covered_ = meeting.what;
    }
  }
  if (scene_.accuracy <= search::small_error && asks_for(scene_, wheel_force))
    until = scene_.accuracy < search::small_error && vibrates_on(scene) ? end_ : with_swing_behind(scene, until);
  if (asks_for(scene_, low_passed)) until += unsettled_end(*scene_.output.low_pass);
  const double whole = end_ - moved_by();
  return until < most_of_the_run * whole ? until : whole;
}

void ModelSearch::run() {
  search();
  refuse_what_is_given();
  for (std::size_t q = 0; q < quantities && !not_covered_.empty(); ++q)
    refuse(q, "trial runs would have to go on too long to see " + not_covered_);
}

// Where trial runs become too many, what was measured has to do.
void ModelSearch::search() {
  try {
    if (search::surely_taken * trials_.seconds(mesh_, step_) > search::most_seconds) throw TooMuchWork();
    accept_damped_vibration();
    refine();
    coarsen();
    coarsen_mesh();
    try_cheaper_methods();
    check_predicted_mesh();
  } catch (const TooMuchWork&) {
    if (!measured_) refuse_scene();
    std::tie(step_, mesh_) = *measured_;
    most_coarsening_ = 1.0;
    refuse_what_is_far();
    for (std::size_t q = 0; q < quantities; ++q)
      if (misses_when_predicted(q)) refuse(q, "trial runs of the mesh that it asks for would become too many");
  }
}

// Steps that are long against the beam's first period give the static response to forces, whose vibration the method
// damps out at once. The energy that goes so tells its amplitude: its square, of that of the static response.
void ModelSearch::accept_damped_vibration() {
  if (step_of_period_ == 0.0) return;
  const double amplitude = search::share_of_vibration * wanted_;
  while (step_ > step_of_period_ && trials_.energy_missing(mesh_, step_) > amplitude * amplitude)
    step_ = two_digits(std::max(less_of_the_energy * step_, step_of_period_));
  first_step_ = step_;
  if (step_ > step_of_period_)
    refuse(acceleration, fmt::format("the beam vibrates with the first period of {:.3g} s, which steps of {:.2g} s do "
                                     "not follow",
                                     trial_steps_a_period * step_of_period_, step_));
}

void ModelSearch::refuse_scene() const {
  throw InputError(
      fmt::format("accuracy = {:g}: the trial runs that find mesh and step would take {:.1g} steps of {:.1g} s with {} "
                  "elements a {} "
                  "and more ({}), which is beyond what they may take; look at the masses, stiffnesses and lengths of "
                  "the scene, or give ts_dt and {}, "
                  "which need no trial runs",
                  scene_.accuracy, horizon_ / step_, step_, mesh_, unit_of_mesh(), shortest_,
                  scene_.beam->track ? "track_elements_per_bay" : "beam_elements_per_span"));
}

void ModelSearch::refine() {
  for (int round = 0; round < search::most_halvings; ++round) {
    measure();
    refuse_what_does_not_settle();
    const auto settles = [&] { return within_reach(time_) && impact_agreement_ >= search::enough_alike; };
    const bool denser = open_mesh_ && !within_reach(space_);
    if (!denser && settles()) measure_elsewhere();
    const bool finer = open_step_ && !settles();
    if (!finer && !denser) return;
    if (!worth_it(finer ? 0.5 * step_ : step_, denser ? 2 * mesh_ : mesh_)) return refuse_what_is_far();
    if (finer) step_ *= 0.5;
    if (denser) mesh_ *= 2;
  }
  refuse_what_is_far();
}

// Longer steps against the finest one.
void ModelSearch::coarsen() {
  finest_step_ = step_;
  finest_ = time_;
  if (!open_step_) return;
  for (double step = 2.0 * finest_step_; step <= longest_step_; step *= 2.0) {
    if (trials_.run(mesh_, step).failed()) return;  // and nothing is known of steps between
    Errors longer = finest_;
    for (std::size_t q = 0; q < quantities; ++q)
      longer[q].value += changed_by_step(step, finest_step_, static_cast<Quantity>(q));
    if (excess(longer, finest_, space_) > 1.0) {
      coarser_ = longer;
      return;
    }
    step_ = step;
    time_ = longer;
  }
}

// Where something was refused that asked for more elements than all the rest needs.
void ModelSearch::coarsen_mesh() {
  if (!open_mesh_ || std::none_of(tried_.begin(), tried_.end(), [](bool tried) { return tried; })) return;
  most_coarsening_ = 1.0;
  const Errors finest = space_;
  const int finest_mesh = mesh_;
  for (int mesh = finest_mesh / 2; mesh % 2 == 0; mesh /= 2) {
    Errors coarser = finest;
    for (std::size_t q = 0; q < quantities; ++q)
      coarser[q].value += growth_ * difference(trials_.run(mesh, step_), trials_.run(finest_mesh, step_),
                                               static_cast<Quantity>(q), 3.0 * step_);
    if (excess(coarser, finest, time_) > 1.0) return;
    mesh_ = mesh;
    space_ = coarser;
    finest_step_ = step_;  // on this mesh
    finest_ = time_;
  }
}

// A method of fewer solves a step and lower order, against the finest run, where trying it costs a part of what it
// saves.
void ModelSearch::try_cheaper_methods() {
  if (!open_step_ || !open_integrator_) return;
  const double usual = factor_of_step() * step_;
  const double run = trials_.seconds(base::whole(mesh_ / factor_of_elements()), usual) * end_ / horizon_;
  double spent = 0.0;
  for (const structure::MethodRow& method : structure::methods().subspan(1))
    for (const double factor : search::shorter_steps) {
      const double step = factor * usual;
      spent += trials_.seconds(mesh_, step, method.name);
      if (spent > search::part_that_saves * run) return;
      Errors errors = finest_;
      for (std::size_t q = 0; q < quantities; ++q)
        errors[q].value += growth_ * difference(trials_.run(mesh_, step, method.name), trials_.run(mesh_, finest_step_),
                                                static_cast<Quantity>(q), 3.0 * step);
      double most = 0.0;  // of what the mesh leaves
      for (std::size_t q = 0; q < quantities; ++q)
        if (promised(q)) most = std::max(most, errors[q].value / (2.0 * wanted_ - std::min(space_[q].value, wanted_)));
      if (most * std::pow(search::shorter_steps.back() / factor, method.order) > 1.0)
        break;  // not with the shortest either
      if (most > 1.0 || excess(errors, finest_, space_) > 2.0) continue;
      integrator_ = method.name;
      step_ = step;
      time_ = errors;
      coarser_.reset();
      return;
    }
}

/// The elements of a span (or bay) that do, as far as is known.
int ModelSearch::predicted_mesh() const {
  const double fewer = factor_of_elements();
  int mesh = mesh_;
  if (open_mesh_ && scene_.beam->track) mesh = base::whole(std::ceil(mesh_ / fewer));
  if (open_mesh_ && !scene_.beam->track) {
    int needed = std::max(4, 2 * base::whole(std::ceil(0.5 * mesh_ / fewer)));
    // Peaks depend on where nodes are: where about twice as many are needed, meshes go on as they were compared.
    if (needed > 1.5 * mesh_ && needed < 2.5 * mesh_) needed = 2 * mesh_;
    mesh = aligned_mesh(scene_, needed);
    // What was measured with nodes at the springs does not hold beside them.
    if (aligned(scene_, mesh_) && !aligned(scene_, mesh)) mesh = needed <= mesh_ ? mesh_ : 2 * mesh_;
  }
  return mesh;
}

// Nodes may pass wheels as fast as these vibrate, so that errors are not those of the meshes that were compared: one
// that was foreseen has a trial of its own.
void ModelSearch::check_predicted_mesh() {
  if (scene_.beam->track || scene_.vehicles.empty()) return;
  for (int mesh = predicted_mesh(); mesh != mesh_; mesh = predicted_mesh()) {
    bool holds = true;
    if (mesh > mesh_ && promised(low_passed)) check_step_on(mesh);
    for (std::size_t q = 0; q < quantities; ++q) {
      if (!promised(q)) continue;
      const double off = changed_by_mesh(mesh, step_, static_cast<Quantity>(q), integrator_);
      predicted_errors_[q] = mesh < mesh_ ? off : std::max(0.0, off - space_[q].value);
      holds = holds && !misses_when_predicted(q);
    }
    if (holds) return;
    if (mesh < mesh_) {
      most_coarsening_ = 1.0;
    } else if (mesh == 2 * mesh_ || (2 * mesh_ <= most_elements_ && worth_it(step_, 2 * mesh_))) {
      mesh_ *= 2;
      Errors space;
      for (std::size_t q = 0; q < quantities; ++q) space[q] = error_in_space(static_cast<Quantity>(q));
      space_ = space;
      measured_ = {step_, mesh_};
    } else {
      for (std::size_t q = 0; q < quantities; ++q)
        if (misses_when_predicted(q))
          refuse(q, fmt::format("{} and {} elements a span differ by {:.1g}", mesh_, mesh, predicted_errors_[q]));
    }
  }
}

// A filter takes instants a step apart, which a wheel passes in one place of an element or another: what steps leave of
// a low-passed acceleration changes with the mesh, by chance to next to nothing on the one that was tried.
void ModelSearch::check_step_on(int mesh) {
  if (step_ == finest_step_ && integrator_.empty()) return;
  const ResponseExtremes& fine = trials_.run(mesh, finest_step_);
  Errors time = time_;
  for (std::size_t q = 0; q < quantities; ++q) {
    const double off = difference(trials_.run(mesh, step_, integrator_), fine, static_cast<Quantity>(q), 3.0 * step_);
    time[q].value = std::max(time[q].value, finest_[q].value + growth_ * off);
  }
  if (excess(time, finest_, space_) > 1.0) {
    step_ = finest_step_;
    time = finest_;
    integrator_.clear();
    coarser_.reset();
  }
  time_ = time;
}

/// With the step that is foreseen.
bool ModelSearch::misses_when_predicted(std::size_t q) const {
  return predicted_errors_[q] + time_[q].at(std::min(1.0, factor_of_step())) > scene_.accuracy;
}

/// What the errors are of those wanted, at most. finest: of the finest run, other: of the mesh where errors are of the
/// step; nothing that is refused can better these.
double ModelSearch::excess(const Errors& errors, const Errors& finest, const Errors& other) const {
  double most = 0.0;
  for (std::size_t q = 0; q < quantities; ++q) {
    if (promised(q)) most = std::max(most, errors[q].value / wanted_);
    if (promises_[q].present && tried_[q])
      most = std::max(most, errors[q].value / std::max({effort(), finest[q].value, other[q].value}));
  }
  return most;
}

Choice ModelSearch::choice() const {
  Choice choice{scene_.model, {}, {}};
  Accuracy& result = choice.accuracy;
  result.measured = true;
  result.lost_contact = trials_.lost_contact();
  if (horizon_ < end_ - moved_by()) result.seen_until = horizon_ + moved_by();
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
    if (coarser_ && ratio > 1.0 && time_[q].value > 0.0)  // between two that are measured
      in_time = time_[q].value * std::pow((*coarser_)[q].value / time_[q].value, std::log2(ratio));
    result.estimates[q] = promises_[q];
    const double in_space =
        std::max(space_[q].at(static_cast<double>(mesh_) / mesh), mesh != mesh_ ? predicted_errors_[q] : 0.0);
    ErrorEstimate& promise = result.estimates[q];
    promise.expected = in_time + in_space;
    const bool told = not_covered_.empty() && time_[q].size > 0.0 && space_[q].size > 0.0;
    if (!promise.present || !is_welcome(scene_, q) || !told) continue;
    promise.kept = promise.expected <= scene_.accuracy;
    promise.why_not =
        fmt::format("{}, and what does for the rest leaves {:.1g}", why_not_asked(scene_, q), promise.expected);
  }
  return choice;
}

}  // namespace traverse::app
