// Evaluates responses at the probes, reactions, peaks and the energy balance at every sample, and stops a run whose
// energy residual is too large for a valid result.
#include "run/run_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/envelope.hpp"

namespace traverse::app {
namespace {

// Largest energy residual of a valid result, relative to the change of the energies. At 5 % wheel forces have an error
// of a tenth. A mechanism without a bridge loses its phase: at 0.6 % the four-bar linkages are half a turn away.
constexpr double max_imbalance = 0.05, max_imbalance_of_mechanism = 0.005;
constexpr double diverging_imbalance = 1.0;  // the limit during the run, when energies may have changed little so far
constexpr double rounding = 1e-9;            // relative to the energies

constexpr double max_static_work =
    2e5;  // probes times nodes, up to which static deflections are computed at every probe

}  // namespace

void check_balance(const Scene& scene, const results::Summary& summary) {
  const double allowed = scene.beam ? max_imbalance : max_imbalance_of_mechanism;
  if (summary.energy_residual > allowed * summary.energy_scale + rounding * summary.largest_energy)
    throw StepTooLong(fmt::format(
        "the energy does not balance: {:g} J are missing where the energies change by {:g} J; the step is "
        "too long for this integrator, use a smaller -ts_dt or an implicit -ts_type, and where contacts are lost "
        "and gained a greater -contact_impact_steps",
        summary.energy_residual, summary.energy_scale));
}

RunObserver::RunObserver(const Scene& scene, coupling::System& system, const beam::Beam* beam,
                         results::Recorder& recorder, const Outputs* outputs)
    : scene_(scene),
      system_(system),
      beam_(beam),
      recorder_(recorder),
      outputs_(recorder.writes() ? outputs : nullptr),
      recorded_(outputs != nullptr) {
  if (beam != nullptr) {
    recovery_.emplace(*beam, scene.output.probes, scene.self_weight ? scene.gravity : 0.0);
    now_.ground.emplace(*beam);
    if (!scene.support_motion.empty()) {
      ground_.assign(beam->model().supports.size(), 0.0);
      for (const double x : scene.output.probes) support_lines_.push_back(beam::support_line(beam->model(), x));
    }
    if (recorded_ && !scene.output.sleepers.empty()) now_.sleepers.emplace(*beam, scene.output.sleepers);
    if (beam->rail() != nullptr) {
      rail_recovery_.emplace(*beam, *beam->rail(), scene.output.probes, 0.0);
      if (recorded_) now_.devices.emplace(*beam);
    }
  }
  for (const train::Member& member : system.fleet().members) wheel_count_ += member.type->wheels.size();
  const double lag = beam != nullptr && scene.model.modes == 0 ? beam->rayleigh().b : 0.0;
  if (recovery_) movement_.emplace(*recovery_);
  if (lag > 0.0) lag_.emplace(*recovery_, *movement_, lag);
  exits_ = ExitStates(scene);
  peaks_ = peaks_for(scene, wheel_count_, lag);
  wheels_ = WheelExtremes(wheel_count_, system.surface_kinks());
}

void RunObserver::sample(const integrate::Instant& instant) {
  const bool stored = is_stored(instant.purpose);
  const bool all = stored || limit_check_ || extrapolation_check_.needs_springs() || exits_.needs_bodies() ||
                   scene_.train.drive == Drive::free;
  system_.observe(instant.time, instant.y, instant.acceleration, now_.motion, all);
  const structure::NodalMotion& beam = now_.motion.beam;
  sample_.time = instant.time;
  if (beam_ != nullptr) {
    if (instant.drag != nullptr) drag(instant.drag);
    if (!beam.drag.empty()) drag(beam.drag.data());
    recovery_->evaluate(beam.v, beam.w, beam.a, now_.motion.bridge_loads, now_.probes);
    if (instant.purpose != integrate::Purpose::exit) {  // the same instant follows for peaks
      movement_->advance(instant.time, now_.motion.bridge_loads);
      if (lag_) lag_->apply(now_.probes);
    }
    for (beam::Response& probe : now_.probes)
      if (!lag_) probe.moment_rate = std::numeric_limits<double>::quiet_NaN();
    if (scene_.by_given_modes())
      for (beam::Response& probe : now_.probes)  // section forces are unknown
        probe = {probe.deflection, probe.velocity, probe.acceleration, probe.relative_deflection};
    subtract_support_motion();
    for (std::size_t i = 0; i < drag_response_.size(); ++i)
      now_.probes[i].acceleration -= drag_response_[i].acceleration;
  }
  exits_.add(instant.time, system_.fleet(), now_.probes);
  if (instant.purpose == integrate::Purpose::exit) return;
  step(instant.time);  // the first instant is not the end of a step
  record_peaks();
  record_largest_deflection();
  if (limit_check_) limit_check_->sample(instant.time, beam.v);
  axle_passages_.add(instant.time, system_.fleet());
  if (beam_ != nullptr && scene_.train.drive == Drive::free) paths_.add(instant.time, system_.fleet());
  if (stored) store(instant.purpose == integrate::Purpose::end);
}

void RunObserver::subtract_support_motion() {
  const structure::SupportMotion* moved = system_.structure()->support_motion();
  if (moved == nullptr) return;
  for (std::size_t i = 0; i < ground_.size(); ++i) ground_[i] = moved->upward()[i].displacement;
  for (std::size_t p = 0; p < support_lines_.size(); ++p)
    now_.probes[p].relative_deflection -= support_lines_[p].height(ground_);
}

void RunObserver::store(bool end) {
  if (beam_ != nullptr) {
    const structure::NodalMotion& beam = now_.motion.beam;
    if (rail_recovery_) rail_recovery_->evaluate(beam.v, beam.w, beam.a, now_.motion.loads, now_.rail);
    beam_->reactions(beam.v, beam.damped_w, beam.a, beam.P.data(), now_.supports);
    if (const structure::SupportMotion* moved = system_.structure()->support_motion()) {
      moved->add_reactions(now_.supports);
      now_.support_motion = {moved->upward(), moved->along()};
    }
    now_.ground->evaluate(beam.v, beam.damped_w, beam.a);
    if (now_.sleepers) now_.sleepers->evaluate(beam.v, beam.w);
    if (now_.devices && !now_.devices->x().empty()) now_.devices->evaluate(beam.v);
  }
  record_energy();
  if (outputs_ != nullptr) outputs_->fill(now_, sample_.values);
  if (end)
    recorder_.end(sample_);
  else
    recorder_.add(sample_);
  if (summary_.energy_residual > diverging_imbalance * summary_.energy_scale + rounding * summary_.largest_energy)
    throw StepTooLong(
        fmt::format("the motion diverges: {:g} J have come from nowhere by t = {:g} s; the step is too long for this "
                    "integrator, use a smaller -ts_dt or an implicit -ts_type",
                    now_.energy.residual, sample_.time));
}

// Modal damping acts like inertia: its acceleration contributes to all forces, but not to the accelerations of the
// probes.
void RunObserver::drag(const double* drag) {
  structure::NodalMotion& beam = now_.motion.beam;
  const auto size = static_cast<std::size_t>(beam_->local_unknowns());
  const std::vector<double> zero(size, 0.0);
  recovery_->evaluate(zero.data(), zero.data(), drag, {}, drag_response_);
  with_drag_.assign(beam.a, beam.a + size);
  for (std::size_t i = 0; i < size; ++i) with_drag_[i] += drag[i];
  beam.a = with_drag_.data();
}

void RunObserver::record_peaks() {
  wheel_forces_.clear();
  const train::Fleet& fleet = system_.fleet();
  for (const train::Member& member : fleet.members) {
    const int first = fleet.vehicles[member.unit].first_wheel + member.first_wheel;
    for (std::size_t i = 0; i < member.type->wheels.size(); ++i)
      wheel_forces_.push_back(fleet.load(fleet.wheels[first + i]).normal);
  }
  extrapolation_check_.add(sample_.time, fleet, now_.motion.beam.foundation, peaks_);
  peaks_.add(sample_.time, now_.probes, wheel_forces_,
             movement_ ? movement_->passages() : std::span<const beam::StationPassage>());
  if (deck_) deck_->add(sample_.time, now_.probes);
}

void RunObserver::record_largest_deflection() {
  double deflection = 0.0;
  for (const beam::Response& probe : now_.probes)
    deflection = std::max(deflection, std::abs(probe.relative_deflection));
  if (deflection > largest_deflection_value_) {
    largest_deflection_value_ = deflection;
    largest_deflection_.time = sample_.time;
    const structure::NodalMotion& beam = now_.motion.beam;
    const int size = beam_->local_unknowns();
    largest_deflection_.v.assign(beam.v, beam.v + size);
    largest_deflection_.w.assign(beam.w, beam.w + size);
    largest_deflection_.a.assign(beam.a, beam.a + size);
    largest_deflection_.loads = now_.motion.bridge_loads;
    largest_deflection_.ground = ground_;
  }
}

void RunObserver::record_energy() {
  const coupling::Energy& e = now_.motion.energy;
  if (at_first_sample_) energy_at_start_ = e;
  at_first_sample_ = false;
  const coupling::Energy& start = energy_at_start_;
  const double stored = (e.kinetic - start.kinetic) + (e.strain - start.strain) + (e.potential - start.potential);
  now_.energy = {e.kinetic, e.strain, e.potential, e.dissipated, e.work, stored + e.dissipated - e.work};
  summary_.structure_energy = std::max(summary_.structure_energy, e.structure);
  summary_.energy_residual = std::max(summary_.energy_residual, std::abs(now_.energy.residual));
  for (double term : {e.kinetic, e.strain, e.potential, e.largest_work})
    summary_.largest_energy = std::max(summary_.largest_energy, std::abs(term));
  // Without steps that end at kinks the work of the drive is not accurate enough to be separated.
  const bool separate = scene_.train.drive == Drive::constant && scene_.model.step_kinks;
  const double forward = separate ? start.kinetic : 0.0;
  for (double change :
       {e.kinetic - forward, e.strain - start.strain, e.potential - start.potential, e.dissipated, e.work})
    summary_.energy_scale = std::max(summary_.energy_scale, std::abs(change));
}

void RunObserver::step(double t) {
  const train::Fleet& fleet = system_.fleet();
  std::size_t wheel = 0;
  const bool due = filtered_wheels_ && filtered_wheels_->is_due(t);
  for (const train::WheelContact& c : fleet.wheels)
    if (!c.is_further) {
      const double force = fleet.load(c).normal;
      if (due) filtered_wheels_->add(force);
      wheels_.add(wheel++, t, fleet.coordinates(c).x(), force);
    }
}

void RunObserver::record_wheels() {
  const train::Fleet& fleet = system_.fleet();
  summary_.least_wheel_force = wheel_count_ == 0 ? 0.0 : wheels_.least().value;
  summary_.greatest_wheel_force = wheel_count_ == 0 ? 0.0 : wheels_.greatest().value;
  const Extreme& least = wheels_.least();
  if (std::isinf(least.value)) return;
  summary_.least_wheel_force_time = least.time;
  summary_.least_wheel = wheel_name(fleet, least.place);
  const Extreme& largest = wheels_.unloading();
  if (largest.value >= 0.0 && scene_.start == Start::equilibrium)
    summary_.unloading = {largest.value, largest.time, wheel_name(fleet, largest.place)};
}

void RunObserver::record_separations() {
  const train::Fleet& fleet = system_.fleet();
  std::vector<results::Separation> list;
  for (const train::Separation& s : system_.contacts().separations().list()) {
    const double duration = s.duration >= 0.0 ? s.duration : system_.contacts().separations().time() - s.start;
    list.push_back({std::to_string(fleet.member(s.contact)), fleet.name(s.contact), s.x, s.start, duration,
                    s.approach_speed, s.impact_force});
    if (s.from_start || s.contact >= static_cast<int>(fleet.wheels.size())) continue;
    ++summary_.contact_losses;
    summary_.longest_loss = std::max(summary_.longest_loss, duration);
  }
  recorder_.separations(list);
}

void RunObserver::check_extrapolation(double until) {
  extrapolation_check_ = ExtrapolationCheck(until, system_.fleet(), beam_ == nullptr ? nullptr : &beam_->model());
}

bool RunObserver::has_uncovered_event(double losses_covered_until) const {
  const std::vector<double> lost = losses();
  return !extrapolation_check_.new_event().empty() ||
         extrapolation_check_.roughness(peaks_) > ExtrapolationCheck::smooth ||
         std::any_of(lost.begin(), lost.end(), [&](double t) { return t > losses_covered_until; });
}

std::vector<double> RunObserver::losses() const {
  std::vector<double> times;
  for (const train::Separation& s : system_.contacts().separations().list())
    if (!s.from_start && s.contact < static_cast<int>(system_.fleet().wheels.size())) times.push_back(s.start);
  return times;
}

const ResponseExtremes& RunObserver::finished_peaks() {
  if (!finished_) {
    peaks_.finish();
    if (deck_) deck_->finish(peaks_);
  }
  finished_ = true;
  return peaks_;
}

const results::Summary& RunObserver::finished_extremes() {
  finished_peaks();
  wheels_.finish();
  record_wheels();
  record_separations();
  return summary_;
}

void RunObserver::keep(base::Archive& archive) {
  archive.same(peaks_, extrapolation_check_, wheels_, paths_, energy_at_start_, at_first_sample_, sample_.time,
               now_.probes, largest_deflection_value_);
  if (movement_) archive.same(*movement_);
  if (lag_) archive.same(*lag_);
  if (limit_check_) archive.same(*limit_check_);
  archive.same(axle_passages_, exits_);
  // The first rank only stores the deck's accelerations.
  deck_ ? archive.same(*deck_) : archive.same();
  filtered_wheels_ ? archive.same(*filtered_wheels_) : archive.same();
  archive.same(summary_.structure_energy, summary_.energy_residual, summary_.largest_energy, summary_.energy_scale);
  archive.same(largest_deflection_.time, largest_deflection_.loads, largest_deflection_.ground);
  bool stored = largest_deflection_value_ > 0.0;
  archive.same(stored);
  if (!stored) return;
  for (std::vector<double>* nodal : {&largest_deflection_.v, &largest_deflection_.w, &largest_deflection_.a}) {
    nodal->resize(static_cast<std::size_t>(beam_->local_unknowns()));
    archive.cut(*nodal);
  }
}

results::Summary RunObserver::finish() {
  const ResponseExtremes& peaks = finished_peaks();
  const auto extreme = [&](Quantity q) {
    const Extreme& peak = peaks.largest(q);
    return results::Extreme{peak.value, peak.time, scene_.output.probes[static_cast<std::size_t>(peak.place)]};
  };
  if (!scene_.output.probes.empty()) {
    summary_.probes = beam_ != nullptr;
    summary_.deflection = extreme(deflection);
    summary_.relative_to_supports = scene_.supports_displaced();
    summary_.acceleration = extreme(acceleration);
    summary_.moments = !scene_.by_given_modes();
    summary_.moment = extreme(moment);
    const auto if_known = [&](Quantity q) {
      return peaks.largest(q).value != 0.0 ? std::optional(extreme(q)) : std::nullopt;
    };
    summary_.shear = if_known(shear_force);
    summary_.axial_displacement = if_known(axial_displacement);
    summary_.axial_force = if_known(axial_force);
  }
  if (!axle_passages_.empty()) {
    recorder_.datasets(axle_passages_.datasets());
    recorder_.tables({{"/passages/wheel", axle_passages_.wheels(system_.fleet())}});
  }
  if (!exits_.empty()) {
    recorder_.datasets(exits_.datasets());
    recorder_.tables({{"/exit/body", exits_.bodies(system_.fleet())}});
  }
  if (deck_) {
    summary_.low_passed = deck_->peak();
    if (scene_.output.low_passed_series) recorder_.datasets({deck_->stored()});
  }
  if (filtered_wheels_) summary_.filtered_unloading = filtered_wheels_->finish(system_.fleet());
  finished_extremes();
  if (beam_ == nullptr) return summary_;
  int some = largest_deflection_.v.empty() && beam_->local_unknowns() > 0 ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_INT, MPI_MIN, beam_->comm());
  if (some == 0) return summary_;
  if (scene_.analysis == Analysis::transient)
    summary_.static_deflection = system_.weights().static_peak(summary_.deflection.place, paths_, sample_.time);
  if (summary_.static_deflection > 0.0)
    summary_.amplification = std::abs(summary_.deflection.value) / summary_.static_deflection;
  recorder_.shape(shape_of(*beam_, scene_, largest_deflection_));
  recorder_.datasets(envelopes(peaks, !scene_.by_given_modes()));
  record_static_deflections();
  return summary_;
}

// Computes the static deflections, at every probe if that is cheap.
void RunObserver::record_static_deflections() {
  const std::vector<double>& probes = scene_.output.probes;
  const auto size = static_cast<double>(probes.size()) * beam_->mesh().nodes();
  if (!recorded_ || summary_.static_deflection <= 0.0 || size > max_static_work) return;
  std::vector<double> deflections;
  for (const double x : probes) deflections.push_back(system_.weights().static_peak(x, paths_, sample_.time));
  recorder_.datasets({{"/envelope/static_deflection", {probes.size()}, std::move(deflections), "m"}});
}

std::vector<results::Verdict> RunObserver::verdicts(const results::Summary& summary) const {
  return limit_check_ ? limit_check_->verdicts(summary, peaks_.largest_of_each(deflection))
                      : std::vector<results::Verdict>();
}

}  // namespace traverse::app
