// Evaluates responses at the probes, reactions, peaks and the energy balance at every sample, and stops a run whose
// energy residual is too large for a valid result.
#include "run/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "run/line_results.hpp"

namespace traverse::run {
namespace {

// Largest energy residual of a valid result, relative to the change of the energies. At 5 % wheel forces have an error
// of a tenth. A mechanism without a bridge loses its phase: at 0.6 % the four-bar linkages are half a turn away.
constexpr double max_imbalance = 0.05, max_imbalance_of_mechanism = 0.005;
constexpr double diverging_imbalance = 1.0;  // the limit during the run, when energies may have changed little so far
constexpr double rounding = 1e-9;            // relative to the energies

constexpr double max_static_work =
    2e5;  // probes times nodes, up to which static deflections are computed at every probe

}  // namespace

base::PassagePeaks Result::passage_peaks() const {
  base::PassagePeaks found{{},
                           summary.least_wheel_force,
                           summary.greatest_wheel_force,
                           static_cast<double>(summary.contact_losses),
                           summary.longest_loss};
  for (std::size_t p = 0; p < peaks.probes(); ++p) {
    const auto peak = [&](Quantity q) {
      const Extreme& extreme = peaks.largest_of_each(q)[p];
      return base::Extreme{std::abs(extreme.value), extreme.time};
    };
    found.peaks.push_back({peak(deflection), peak(acceleration), peak(moment)});
  }
  return found;
}

void Result::record(results::Recorder& recorder) const {
  recorder.datasets(datasets);
  recorder.tables(tables);
  recorder.separations(separations);
  if (shape) recorder.shape(*shape);
}

Evaluation::Evaluation(const scene::Scene& scene, coupling::System& system, const beam::Beam* beam, const Plan& plan,
                       const Wants& wants, std::vector<std::string>& notes)
    : scene_(scene), system_(system), beam_(beam), wants_(wants) {
  if (beam != nullptr) {
    recovery_.emplace(*beam, scene.output.probes, scene.self_weight ? scene.gravity : 0.0, scene.output.eccentricities);
    now_.ground.emplace(*beam);
    if (!beam->model().dampers.empty()) now_.dampers.emplace(*beam);
    if (!scene.support_motion.empty()) {
      ground_.assign(beam->model().supports.size(), 0.0);
      for (const double x : scene.output.probes) support_lines_.push_back(beam->support_lines().at(x));
    }
    if (wants.stored && !scene.output.sleepers.empty()) now_.sleepers.emplace(*beam, scene.output.sleepers);
    if (beam->rail() != nullptr) {
      std::vector<double> stations = scene.output.probes;
      stations.insert(stations.end(), scene.output.rail.begin(), scene.output.rail.end());
      rail_recovery_.emplace(*beam, *beam->rail(), std::move(stations), 0.0);
      if (wants.stored) now_.devices.emplace(*beam);
    }
  }
  for (const train::Member& member : system.fleet().members) wheel_count_ += member.type->wheels.size();
  wheel_forces_.resize(wheel_count_);
  if (recovery_) moving_probes_ = {*recovery_, beam->bridge()};
  const double lag = beam != nullptr && scene.model.modes == 0 ? beam->rayleigh().b : 0.0;
  if (recovery_) movement_.emplace(*recovery_);
  if (lag > 0.0) lag_.emplace(*recovery_, *movement_, lag);
  exits_ = ExitStates(scene);
  peaks_ = peaks_for(scene, wheel_count_, lag);
  wheels_ = WheelExtremes(wheel_count_, system.surface_kinks());
  if (wants.stored && !scene.output.passages.empty()) axle_passages_ = {scene, plan.time_step};
  if (wants.stored && scene.output.profile != 0.0) profiles_ = {scene, system.fleet(), plan.end_time};
  if (wants.limits) limit_check_.emplace(scene, system.fleet(), beam);
  set_up_filters(plan, notes);
}

void Evaluation::set_up_filters(const Plan& plan, std::vector<std::string>& notes) {
  const scene::Output& out = scene_.output;
  int rank = 0;
  MPI_Comm_rank(system_.comm(), &rank);
  const auto filters = [&](double cutoff, std::size_t series, double spacing, const char* what, const char* quantity) {
    const std::string obstacle = filter_obstacle(cutoff, plan, series, what, spacing);
    if (!obstacle.empty()) notes.push_back(fmt::format("{} are not low-passed: {}", quantity, obstacle));
    return obstacle.empty();
  };
  filters_deck_ = wants_.deck_cutoff > 0.0 &&
                  filters(wants_.deck_cutoff, out.probes.size(), wants_.deck_spacing, "probes", "deck accelerations");
  if (filters_deck_ && (rank == 0 || wants_.filter_on_all)) deck_.emplace(wants_.deck_cutoff, plan, out.probes);
  if (wants_.wheel_filter && filters_wheels(scene_) &&
      filters(out.wheel_low_pass, wheel_count_, 1.0, "wheels", "wheel forces") && rank == 0)
    filtered_wheels_.emplace(out.wheel_low_pass, out.unloading_level, plan, wheel_count_);
}

void Evaluation::sample(const integrate::Instant& instant) {
  const bool stored = is_stored(instant.purpose);
  const bool all = stored || limit_check_ || exits_.needs_bodies() || scene_.train.drive == train::Drive::free;
  system_.observe(instant.time, instant.y, instant.acceleration, now_.motion, all);
  const structure::NodalMotion& beam = now_.motion.beam;
  time_ = instant.time;
  if (beam_ != nullptr) {
    if (instant.drag != nullptr) drag(instant.drag);
    if (!beam.drag.empty()) drag(beam.drag.data());
    moving_probes_.update(now_.motion.beam.moving);
    recovery_->evaluate(beam.v, beam.w, beam.a, now_.motion.bridge_loads, moving_probes_.now(), now_.probes);
    if (instant.purpose != integrate::Purpose::exit) {  // the same instant follows for peaks
      movement_->advance(instant.time, now_.motion.bridge_loads);
      if (lag_) lag_->apply(now_.probes, moving_probes_.now());
    }
    for (const std::size_t i : moving_probes_.now()) {
      recovery::Response& probe = now_.probes[i];
      if (!lag_) probe.moment_rate = std::numeric_limits<double>::quiet_NaN();
      if (scene_.by_given_modes())  // section forces are unknown
        probe = {probe.deflection, probe.velocity, probe.acceleration, probe.relative_deflection};
    }
    subtract_support_motion();
    for (const std::size_t i : moving_probes_.now())
      if (!drag_response_.empty()) now_.probes[i].acceleration -= drag_response_[i].acceleration;
  }
  exits_.add(instant.time, system_.fleet(), now_.probes);
  if (instant.purpose == integrate::Purpose::exit) return;
  add_wheels(instant.time);  // the first instant is not the end of a step
  record_peaks();
  if (now_.dampers) now_.dampers->evaluate(time_, now_.motion.beam.v, now_.motion.beam.damped_w);
  record_largest_deflection();
  if (beam_ != nullptr && limit_check_ && scene_.limits_quantity("bearing_uplift")) evaluate_supports();
  if (limit_check_) limit_check_->sample(instant.time, beam.v, now_.supports);
  axle_passages_.add(instant.time, system_.fleet());
  profiles_.add(system_.fleet());
  if (beam_ != nullptr && scene_.train.drive == train::Drive::free) paths_.add(instant.time, system_.fleet());
  if (stored) store();
}

void Evaluation::subtract_support_motion() {
  const structure::SupportMotion* moved = system_.structure()->support_motion();
  if (moved == nullptr || support_lines_.empty()) return;
  for (std::size_t i = 0; i < ground_.size(); ++i) ground_[i] = moved->upward()[i].displacement;
  for (const std::size_t p : moving_probes_.now())
    now_.probes[p].relative_deflection -= support_lines_[p].height(ground_);
}

void Evaluation::evaluate_supports() {
  const structure::NodalMotion& beam = now_.motion.beam;
  beam_->reactions(beam.v, beam.damped_w, beam.a, beam.P.data(), now_.supports);
  const structure::SupportMotion* moved = system_.structure()->support_motion();
  if (moved == nullptr) return;
  moved->add_reactions(now_.supports);
  now_.support_motion = {moved->upward(), moved->along()};
}

void Evaluation::store() {
  if (beam_ != nullptr && wants_.stored) {
    const structure::NodalMotion& beam = now_.motion.beam;
    if (rail_recovery_) rail_recovery_->evaluate(beam.v, beam.w, beam.a, now_.motion.loads, now_.rail);
    evaluate_supports();
    now_.ground->evaluate(beam.v, beam.damped_w, beam.a);
    if (now_.sleepers) now_.sleepers->evaluate(beam.v, beam.w);
    if (now_.devices && !now_.devices->x().empty()) now_.devices->evaluate(beam.v);
  }
  record_energy();
}

// Modal damping acts like inertia: its acceleration contributes to all forces, not to accelerations of probes.
void Evaluation::drag(const double* drag) {
  structure::NodalMotion& beam = now_.motion.beam;
  const auto size = static_cast<std::size_t>(beam_->local_unknowns());
  const std::vector<double> zero(size, 0.0);
  recovery_->evaluate(zero.data(), zero.data(), drag, {}, drag_response_);
  with_drag_.assign(beam.a, beam.a + size);
  for (std::size_t i = 0; i < size; ++i) with_drag_[i] += drag[i];
  beam.a = with_drag_.data();
}

void Evaluation::record_peaks() {
  moving_wheels_.clear();
  const train::Fleet& fleet = system_.fleet();
  std::size_t wheel = 0;
  for (const train::Member& member : fleet.members) {
    const std::size_t past = wheel + member.type->wheels.size();
    const int first = fleet.vehicles[member.unit].first_wheel + member.first_wheel;
    for (int i = 0; wheel < past && system_.is_present(member.unit); ++i, ++wheel) {
      wheel_forces_[wheel] = fleet.load(fleet.wheels[first + i]).normal;
      moving_wheels_.push_back(wheel);
    }
    wheel = past;
  }
  peaks_.add(time_, {now_.probes, moving_probes_.now()}, {wheel_forces_, moving_wheels_},
             movement_ ? movement_->passages() : std::span<const recovery::StationPassage>());
  if (deck_) deck_->add(time_, now_.probes);
}

void Evaluation::record_largest_deflection() {
  double deflection = 0.0;
  for (const std::size_t i : moving_probes_.now())
    deflection = std::max(deflection, std::abs(now_.probes[i].relative_deflection));
  if (deflection > largest_deflection_value_) {
    largest_deflection_value_ = deflection;
    largest_deflection_.time = time_;
    system_.complete_motion();
    const structure::NodalMotion& beam = now_.motion.beam;
    const int size = beam_->local_unknowns();
    largest_deflection_.v.assign(beam.v, beam.v + size);
    largest_deflection_.w.assign(beam.w, beam.w + size);
    largest_deflection_.a.assign(beam.a, beam.a + size);
    largest_deflection_.loads = now_.motion.bridge_loads;
    largest_deflection_.ground = ground_;
  }
}

void Evaluation::record_energy() {
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
  const bool separate = scene_.train.drive == train::Drive::constant && scene_.model.step_kinks;
  const double forward = separate ? start.kinetic : 0.0;
  for (double change :
       {e.kinetic - forward, e.strain - start.strain, e.potential - start.potential, e.dissipated, e.work})
    summary_.energy_scale = std::max(summary_.energy_scale, std::abs(change));
}

void Evaluation::step(double t) {
  if (summary_.energy_residual > diverging_imbalance * summary_.energy_scale + rounding * summary_.largest_energy)
    throw StepTooLong(fmt::format(
        "the motion diverges: {:g} J have appeared without a source by t = {:g} s; the step is too long for this "
        "integrator, use a smaller -ts_dt or an implicit -ts_type",
        now_.energy.residual, time_));
  add_wheels(t);
}

void Evaluation::check_balance() const {
  const double allowed = scene_.beam ? max_imbalance : max_imbalance_of_mechanism;
  if (summary_.energy_residual > allowed * summary_.energy_scale + rounding * summary_.largest_energy)
    throw StepTooLong(fmt::format(
        "the energy does not balance: {:g} J are missing where the energies change by {:g} J; the step is "
        "too long for this integrator, use a smaller -ts_dt or an implicit -ts_type, and where contacts are lost "
        "and gained a greater -contact_impact_steps",
        summary_.energy_residual, summary_.energy_scale));
}

void Evaluation::add_wheels(double t) {
  const train::Fleet& fleet = system_.fleet();
  std::size_t wheel = 0;
  const bool due = filtered_wheels_ && filtered_wheels_->is_due(t);
  for (const train::WheelContact& c : fleet.wheels)
    if (!c.is_further) {
      const double force = fleet.load(c).normal;
      if (due) filtered_wheels_->add(force);
      if (system_.is_present(c.vehicle)) wheels_.add(wheel, t, fleet.coordinates(c).x(), force);
      ++wheel;
    }
}

void Evaluation::record_wheels() {
  const train::Fleet& fleet = system_.fleet();
  const WheelExtremes::Extremes of_all = wheels_.of_all();
  summary_.least_wheel_force = wheel_count_ == 0 ? 0.0 : of_all.least.value;
  summary_.greatest_wheel_force = wheel_count_ == 0 ? 0.0 : of_all.greatest.value;
  const Extreme& least = of_all.least;
  if (std::isinf(least.value)) return;
  summary_.least_wheel_force_time = least.time;
  summary_.least_wheel = wheel_name(fleet, least.place);
  const Extreme& largest = of_all.unloading;
  if (largest.value >= 0.0 && scene_.start == scene::Start::equilibrium)
    summary_.unloading = {largest.value, largest.time, wheel_name(fleet, largest.place)};
}

void Evaluation::record_separations(Result& result) {
  const train::Fleet& fleet = system_.fleet();
  for (const train::Separation& s : system_.contacts().separations().list()) {
    const double duration = s.duration >= 0.0 ? s.duration : system_.contacts().separations().time() - s.start;
    result.separations.push_back({std::to_string(fleet.member(s.contact)), fleet.name(s.contact), s.x, s.start,
                                  duration, s.approach_speed, s.impact_force});
    if (s.from_start) continue;
    result.lost_contact = true;
    if (s.contact >= static_cast<int>(fleet.wheels.size())) continue;
    ++summary_.contact_losses;
    summary_.longest_loss = std::max(summary_.longest_loss, duration);
  }
}

void Evaluation::keep(base::Archive& archive) {
  archive.same(peaks_, wheels_, paths_, energy_at_start_, at_first_sample_, time_, now_.probes, moving_probes_,
               largest_deflection_value_);
  if (movement_) archive.same(*movement_);
  if (lag_) archive.same(*lag_);
  if (limit_check_) archive.same(*limit_check_);
  archive.same(axle_passages_, exits_, profiles_);
  if (now_.dampers) archive.same(*now_.dampers);
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

Result Evaluation::finish() {
  Result result;
  peaks_.finish();
  if (deck_) deck_->finish(peaks_);
  wheels_.finish();
  record_wheels();
  record_separations(result);
  if (now_.dampers) summary_.dampers = now_.dampers->largest();
  if (deck_) summary_.low_passed = deck_->peak();
  if (filtered_wheels_) summary_.filtered_unloading = filtered_wheels_->finish(system_.fleet());
  if (wants_.stored || wants_.limits) summarise_peaks();
  if (wants_.stored) record_once(result);
  if (limit_check_) result.verdicts = limit_check_->verdicts(summary_, peaks_);
  result.filter_unsettled = deck_ && deck_->ends_unsettled();
  result.summary = summary_;
  result.peaks = std::move(peaks_);
  return result;
}

void Evaluation::summarise_peaks() {
  const auto extreme = [&](Quantity q) {
    const Extreme& peak = peaks_.largest(q);
    return results::Extreme{peak.value, peak.time, scene_.output.probes[static_cast<std::size_t>(peak.place)]};
  };
  const auto if_known = [&](Quantity q) {
    return peaks_.largest(q).value != 0.0 ? std::optional(extreme(q)) : std::nullopt;
  };
  if (!scene_.output.probes.empty()) {
    summary_.probes = beam_ != nullptr;
    summary_.deflection = extreme(deflection);
    summary_.relative_to_supports = scene_.supports_displaced();
    summary_.acceleration = extreme(acceleration);
    summary_.moments = !scene_.by_given_modes();
    summary_.moment = extreme(moment);
    summary_.shear = if_known(shear_force);
    summary_.axial_displacement = if_known(axial_displacement);
    summary_.axial_force = if_known(axial_force);
  }
  if (!has_largest_deflection()) return;
  if (scene_.analysis == options::Analysis::transient)
    summary_.static_deflection = system_.weights().static_peak(summary_.deflection.place, paths_, time_);
  if (summary_.static_deflection > 0.0)
    summary_.amplification = std::abs(summary_.deflection.value) / summary_.static_deflection;
}

bool Evaluation::has_largest_deflection() const {
  if (beam_ == nullptr) return false;
  int some = largest_deflection_.v.empty() && beam_->local_unknowns() > 0 ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_INT, MPI_MIN, beam_->comm());
  return some != 0;
}

void Evaluation::record_once(Result& result) {
  const auto add = [&](std::vector<results::Recorder::Dataset> sets) {
    std::move(sets.begin(), sets.end(), std::back_inserter(result.datasets));
  };
  if (!axle_passages_.empty()) {
    add(axle_passages_.datasets());
    result.tables.emplace_back("/passages/wheel", axle_passages_.wheels(system_.fleet()));
  }
  add(profiles_.datasets());
  if (!exits_.empty()) {
    add(exits_.datasets());
    result.tables.emplace_back("/exit/body", exits_.bodies(system_.fleet()));
  }
  if (!scene_.vehicles.empty() && (scene_.train.courses.size() > 1 || !scene_.output.series)) {
    add(peaks_of_trains(scene_, system_.fleet(), wheels_));
    result.tables.emplace_back("/trains/name", names_of_trains(scene_));
  }
  if (!scene_.output.series && beam_ != nullptr) add(peaks_of_spans(scene_, peaks_));
  if (deck_ && scene_.output.low_passed_series) add({deck_->stored()});
  if (!has_largest_deflection()) return;
  result.shape = shape_of(*beam_, scene_, largest_deflection_);
  add(envelopes(peaks_, !scene_.by_given_modes()));
  const std::vector<double>& probes = scene_.output.probes;
  const auto size = static_cast<double>(probes.size()) * beam_->mesh().nodes();
  if (summary_.static_deflection <= 0.0 || size > max_static_work) return;
  std::vector<double> deflections;
  for (const double x : probes) deflections.push_back(system_.weights().static_peak(x, paths_, time_));
  add({{"/envelope/static_deflection", {probes.size()}, std::move(deflections), "m"}});
}

}  // namespace traverse::run
