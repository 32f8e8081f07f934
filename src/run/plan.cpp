// Derives the time step from the first period, the crossing of a span and the shortest wave of track and wheels,
// rounded to 1, 2 or 5 times a power of ten, and the sampling interval from that. Given steps are bounded by the first
// period, waves of the track, sleepers and contact oscillation, and the element length by 1/lambda = (4 EI/k)^(1/4) of
// a beam on an elastic foundation.
#include "run/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/numbers.hpp"
#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

constexpr double steps_per_period = 100.0;   // in the first period or a span's crossing, at an accuracy of 1e-3
constexpr double steps_per_wave = 20.0;      // in a wave of the track or of a wheel out of round, at that accuracy
constexpr double samples_per_period = 20.0;  // in the first period of a bridge by modes, if the interval is open
constexpr double mechanism_step = 1e-3;      // s, without a beam
constexpr double min_steps_per_span = 10.0;
constexpr double max_steps = 1e10;
constexpr double samples_of_open_interval = 2000.0;  // largest number, if the interval is open
constexpr double end_tolerance =
    1e-3;  // relative to the step: an end so close to a multiple of the interval is moved there

// The largest of 1, 2, 5 times a power of ten that does not exceed x.
double round_down(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  const double digits = x / power * (1.0 + 1e-12);
  return power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0);
}

double end_of(const scene::Scene& scene, const coupling::System& system) {
  if (scene.end_time) return *scene.end_time;
  const double leaving = system.leaving_time();
  if (!std::isfinite(leaving))
    throw InputError(
        "ts_max_time is missing: nothing leaves the beam in this scene, so it has no end of its own; "
        "allowed: a time in s above 0");
  return leaving + scene.tail.value_or(0.0);
}

// A step that does not resolve the scene causes a wrong result without any other sign.
void check_step(const scene::Scene& scene, const Plan& plan) {
  if (!(plan.end_time / plan.time_step < max_steps) && scene.step_open)
    throw InputError(fmt::format(
        "{}: the run ends at {:g} s only, which takes too many of the steps of {:g} s that the scene needs; allowed: "
        "{}, or a longer step (ts_dt)",
        scene.end_time ? fmt::format("ts_max_time = {:g}", *scene.end_time)
                       : fmt::format("at {:g} m/s", scene::greatest_speed(scene)),
        plan.end_time, plan.time_step,
        scene.end_time ? "an earlier end" : "a higher train_speed or load_speed, an earlier end (ts_max_time)"));
  if (!(plan.end_time / plan.time_step < max_steps))
    throw InputError(fmt::format(
        "ts_dt = {:g}: too many steps to the end at {:g} s{}; allowed: above {:g} s", plan.time_step, plan.end_time,
        scene.end_time ? "" : fmt::format(", when all has passed at {:g} m/s", scene::greatest_speed(scene)),
        plan.end_time / max_steps));
  const double speed = scene::greatest_speed(scene);
  if (!scene.beam || speed <= 0.0) return;
  const double crossing = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end()) / speed;
  if (plan.time_step > crossing / min_steps_per_span)
    throw InputError(fmt::format("ts_dt = {:g}: the longest span is crossed in {:g} s; allowed: at most {:g} s",
                                 plan.time_step, crossing, crossing / min_steps_per_span));
}

// s: the shorter of the first period and the crossing of the shortest span, for a scene with a beam.
double shortest_scale(const scene::Scene& scene, double first_period) {
  double scale = first_period > 0.0 ? first_period : 1.0;
  if (const double frequency = highest_load_frequency(scene.load); frequency > 0.0)
    scale = std::min(scale, 1.0 / frequency);
  const double speed = scene::greatest_speed(scene);
  const double span = *std::min_element(scene.beam->spans.begin(), scene.beam->spans.end());
  return speed > 0.0 ? std::min(scale, span / speed) : scale;
}

double chosen_step(const scene::Scene& scene, double first_period, std::vector<std::string>& notes) {
  const double factor = std::pow(scene.accuracy / 1e-3, 0.25);
  const double wave_step =
      round_down(std::min(scene::shortest_wave(scene) / scene.train.speed, 1e6) / steps_per_wave * factor);
  const auto step_by_waves = [&] {
    notes.push_back(
        fmt::format("time step {:g} s: from accuracy {:g} and the shortest wave of track and wheels; -ts_dt changes it",
                    wave_step, scene.accuracy));
    return wave_step;
  };
  if (!scene.beam) {
    if (wave_step < mechanism_step) return step_by_waves();
    notes.push_back(fmt::format("time step {:g} s: no beam to judge by; -ts_dt changes it", mechanism_step));
    return mechanism_step;
  }
  const double step = round_down(shortest_scale(scene, first_period) / steps_per_period * factor);
  if (wave_step < step) return step_by_waves();
  notes.push_back(fmt::format(
      "time step {:g} s: from accuracy {:g}, the first period and the crossing of a span; -ts_dt changes it", step,
      scene.accuracy));
  return step;
}

// The number of equally spaced samples among `steps` steps: at most `longest` s apart, each at the end of a step.
long samples_among(long steps, double step, double longest) {
  const double fit = std::min(static_cast<double>(steps), longest / step * (1.0 + 1e-9));
  for (long each = static_cast<long>(fit); each > 1; --each)
    if (steps % each == 0) return steps / each;
  return steps;
}

// The motion between samples is exact: their distance follows from the shape of the curves only.
void plan_modal(const scene::Scene& scene, double first_period, Plan& plan, std::vector<std::string>& notes) {
  plan.interval = plan.time_step =
      std::min(plan.end_time, scene.output.interval.value_or(round_down(first_period / samples_per_period)));
  if (!scene.output.interval)
    notes.push_back(
        fmt::format("samples every {:g} s: from the first period; output_interval changes it, which "
                    "changes nothing in the motion",
                    plan.interval));
  plan.stored = static_cast<long>(std::max(1.0, std::ceil(plan.interval / scene.sampling_interval * (1.0 - 1e-9))));
  plan.interval /= static_cast<double>(plan.stored);
}

double sample_next_to_end(const Plan& plan) {
  const double interval = plan.interval * static_cast<double>(plan.stored);
  return std::round(plan.end_time / interval) * interval;
}

// Leaving times have rounding errors, and a step to an end just behind the last sample would be far too short.
void move_end_to_sample(Plan& plan) {
  const double tolerance = end_tolerance * std::min({plan.time_step, plan.interval, plan.end_time});
  if (std::abs(sample_next_to_end(plan) - plan.end_time) < tolerance) plan.end_time = sample_next_to_end(plan);
}

// Element length times lambda, lambda = (k/4EI)^(1/4). The error of the deflection under a force on a bed is 2 % at 1,
// a fifth at 2, a factor of three at 4.
constexpr double warning_on_bed = 1.0, limit_on_bed = 2.0;

// Errors of peaks of a bridge of three spans under a moving force (R6): esdirk4 3e-3 with 12 steps in the first period,
// 5e-3 with 7, 3 % with 5 and 5 % with 4; the second-order genalpha 1 % with 36 and 5 % with 12. For one span under a
// sprung mass (R3) 2e-4 with 5.
constexpr double min_steps_per_period = 4.0, good_steps_per_period = 8.0, second_order_steps_per_period = 40.0;
// If the crossing of a bridge lasts this number of first periods, the deflection is static within 1 %, for any step.
constexpr double slow_crossing_periods = 50.0;

// Errors of wheel forces over a bump of 2 m: 1 % with 20 steps per wave, 10 % with 8, nearly 50 % with 4.
constexpr double min_steps_per_wave = 8.0, good_steps_per_wave = 20.0;
// Sleepers and contact oscillations excite wheel forces less: a part of the variation is lost.
constexpr double steps_per_sleeper = 4.0, steps_per_oscillation = 10.0;

constexpr double max_stored_samples = 1e10;
constexpr double shortest_run = 1e-12;  // s

bool has_loads(const scene::Scene& scene) { return !scene.train.vehicles.empty() || !scene.load.forces.empty(); }

void check_waves(const scene::Scene& scene, double step, std::vector<std::string>& notes) {
  double wave = scene.profile.shortest_wave();
  for (const train::Course& course : scene.train.courses)
    if (course.profile) wave = std::min(wave, course.profile->shortest_wave());
  if (scene.train.vehicles.empty() || scene.train.speed <= 0.0 || !std::isfinite(wave)) return;
  const double passage = wave / scene.train.speed;
  if (step > passage / min_steps_per_wave)
    throw InputError(
        fmt::format("ts_dt = {:g}: the track's shortest wave, {:g} m, is passed in {:g} s; allowed: at most {:g} s, or "
                    "leave ts_dt out",
                    step, wave, passage, passage / min_steps_per_wave));
  if (step > passage / good_steps_per_wave)
    notes.push_back(fmt::format(
        "steps of {:g} s are long for the track's shortest wave, {:g} m, passed in {:g} s: wheel forces are rough; "
        "-ts_dt {:.2g} resolves it",
        step, wave, passage, passage / good_steps_per_wave));
}

// Single sleepers affect the wheels, not the bridge.
void check_sleepers(const scene::Scene& scene, double step, std::vector<std::string>& notes) {
  if (!scene.beam || !scene.beam->track || scene::greatest_speed(scene) <= 0.0) return;
  const double passage = scene.beam->track->spacing / scene::greatest_speed(scene);
  if (step > passage / steps_per_sleeper)
    notes.push_back(
        fmt::format("steps of {:g} s are long for the sleepers, each passed in {:g} s: forces of wheels and rail are "
                    "rough; -ts_dt {:.2g} resolves them",
                    step, passage, passage / steps_per_oscillation));
}

void check_periods(const scene::Scene& scene, double step, double period, bool high_order,
                   std::vector<std::string>& notes) {
  const double speed = scene::greatest_speed(scene);
  if (!scene.beam || period <= 0.0 || speed <= 0.0) return;
  const double span = *std::min_element(scene.beam->spans.begin(), scene.beam->spans.end());
  if (span / speed > slow_crossing_periods * period) return;
  if (step > period / min_steps_per_period)
    throw InputError(fmt::format(
        "ts_dt = {:g}: the first period of the beam is {:g} s, which the load excites; allowed: at most {:g} s, or "
        "leave ts_dt out",
        step, period, period / min_steps_per_period));
  const double good = period / (high_order ? good_steps_per_period : second_order_steps_per_period);
  if (step <= good) return;
  notes.push_back(
      fmt::format("steps of {:g} s are long for the first period of {:g} s{}: deflections may be some per cent off; "
                  "take -ts_dt {:.2g}{}",
                  step, period, high_order ? "" : " and order 2", good, high_order ? "" : " or -ts_type esdirk4"));
}

void check_harmonics(const scene::Scene& scene, double step, std::vector<std::string>& notes) {
  const double frequency = highest_load_frequency(scene.load);
  if (frequency == 0.0) return;
  const double period = 1.0 / frequency;
  if (step > period / min_steps_per_period)
    throw InputError(
        fmt::format("ts_dt = {:g}: the loads vary with {:g} Hz; allowed: at most {:g} s, or leave ts_dt out", step,
                    frequency, period / min_steps_per_period));
  if (step > period / good_steps_per_period)
    notes.push_back(
        fmt::format("steps of {:g} s are long for loads that vary with {:g} Hz; -ts_dt {:.2g} resolves them", step,
                    frequency, period / good_steps_per_period));
}

/// The greatest lambda in a span, 1/m.
double largest_lambda(const beam::BeamModel& beam, double start, double length, int elements) {
  double lambda = 0.0;
  for (int i = 0; i < elements; ++i) {
    const double x = start + (i + 0.5) * length / elements;
    for_beds(beam.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
      lambda = std::max(lambda, bending_decay_rate(kind.direction, bed.k.at(x, x), beam.EI.at(x, x)));
    });
  }
  return lambda;
}

void check_beds(const beam::BeamModel& beam, std::vector<std::string>& notes) {
  double start = 0.0;
  for (std::size_t i = 0; i < beam.spans.size(); start += beam.spans[i++]) {
    const double span = beam.spans[i], lambda = largest_lambda(beam, start, span, beam.elements[i]);
    const auto elements = [&](double length) { return base::whole(std::ceil(lambda * span / length)); };
    if (beam.elements[i] < elements(limit_on_bed))
      throw InputError(
          fmt::format("beam_elements_per_span = {}: the beam bends within 1/lambda = {:.3g} m of a wheel on "
                      "its bed; allowed: at least {} in the span of {:g} m, or a softer bed",
                      beam.elements[i], 1.0 / lambda, elements(limit_on_bed), span));
    if (beam.elements[i] >= elements(warning_on_bed)) continue;
    notes.push_back(
        fmt::format("the beam bends within 1/lambda = {:.3g} m of a wheel on its bed: deflections there are "
                    "some per cent off; -beam_elements_per_span {} resolves them",
                    1.0 / lambda, elements(warning_on_bed)));
    return;
  }
}

}  // namespace

bool Plan::ends_at_sample() const { return end_time == sample_next_to_end(*this); }

Plan plan_exact_in_time(const scene::Scene& scene, double end_time, double first_period,
                        std::vector<std::string>& notes) {
  Plan plan;
  plan.end_time = end_time;
  plan_modal(scene, first_period, plan, notes);
  move_end_to_sample(plan);
  return plan;
}

Plan make_plan(const scene::Scene& scene, const coupling::System& system, double first_period,
               std::vector<std::string>& notes) {
  Plan plan;
  plan.end_time = end_of(scene, system);
  if (!scene.exact_in_time())
    plan.time_step = scene.model.step ? *scene.model.step : chosen_step(scene, first_period, notes);
  if (plan.end_time <= 0.0)
    throw InputError(
        "scene_tail is missing: every wheel and force has left the beam at the start; give scene_tail "
        "or ts_max_time in s above 0");
  if (scene.exact_in_time()) return plan_exact_in_time(scene, plan.end_time, first_period, notes);
  check_step(scene, plan);
  if (scene.output.interval && *scene.output.interval > plan.end_time)
    notes.push_back(fmt::format("output_interval {:g} s is longer than the run: of its series only the start is stored",
                                *scene.output.interval));
  if (scene.output.interval) {
    plan.interval = std::min(*scene.output.interval, max_steps * plan.time_step);  // long enough for any run
    const long steps = static_cast<long>(std::max(1.0, std::ceil(plan.interval / plan.time_step * (1.0 - 1e-9))));
    plan.stored = scene.model.step_probes
                      ? steps
                      : samples_among(steps, plan.interval / static_cast<double>(steps), scene.sampling_interval);
    plan.interval /= static_cast<double>(plan.stored);
    if (plan.interval * static_cast<double>(plan.stored) < plan.time_step * (1.0 - 1e-9))
      notes.push_back(
          fmt::format("steps end at every stored sample: output_interval {:g} s limits the step", plan.interval));
  } else {
    const long steps =
        static_cast<long>(std::max(1.0, std::ceil(plan.end_time / plan.time_step / samples_of_open_interval)));
    plan.stored = scene.model.step_probes ? steps : samples_among(steps, plan.time_step, scene.sampling_interval);
    plan.interval = plan.time_step * static_cast<double>(steps) / static_cast<double>(plan.stored);
  }
  move_end_to_sample(plan);
  return plan;
}

void check_mesh(const scene::Scene& scene, std::vector<std::string>& notes) {
  if (!scene.beam || scene.beam->track || !has_loads(scene)) return;
  const beam::BeamModel& beam = *scene.beam;
  const bool moves = scene.analysis == options::Analysis::transient && scene::greatest_speed(scene) > 0.0;
  if (moves && scene.model.modes == 0 && *std::min_element(beam.elements.begin(), beam.elements.end()) == 1)
    notes.emplace_back(
        "one element a span: its first frequency is up to a tenth too high, and so may the response be wrong; "
        "-beam_elements_per_span 4 keeps a thousandth");
  check_beds(beam, notes);
}

void check_times(const Plan& plan) {
  if (plan.end_time < shortest_run)
    throw InputError(fmt::format("ts_max_time = {:g}: too short a run for rounding; allowed: at least {:g} s",
                                 plan.end_time, shortest_run));
  if (!(plan.end_time / plan.interval < max_stored_samples))
    throw InputError(fmt::format("output_interval = {:g}: too many samples to the end at {:g} s; allowed: above {:g} s",
                                 plan.interval, plan.end_time, plan.end_time / max_stored_samples));
}

void check_steps(const scene::Scene& scene, const Plan& plan, double first_period, bool high_order,
                 std::vector<std::string>& notes) {
  if (!scene.model.step) return;
  const double step = std::min(plan.time_step, plan.interval);
  check_waves(scene, step, notes);
  check_sleepers(scene, step, notes);
  check_periods(scene, step, first_period, high_order, notes);
  check_harmonics(scene, step, notes);
}

void check_contacts(const scene::Scene& scene, const Plan& plan, const train::Fleet& fleet,
                    std::vector<std::string>& notes) {
  double period = std::numeric_limits<double>::infinity();
  for (const train::WheelContact& c : fleet.wheels) {
    const train::Wheel& wheel = fleet.wheel(c);
    const bool round = wheel.shape.flat_length <= 0.0 && wheel.shape.polygon_amplitude <= 0.0;
    if (scene.profile.level() && round) continue;
    const double stiffness = contact::force(c.law, c.kinematics, 0.0).normal_by_penetration;
    const double mass = fleet.vehicles[c.vehicle].mechanism.model().bodies[c.body].mass;
    if (stiffness > 0.0) period = std::min(period, 2.0 * std::numbers::pi * std::sqrt(mass / stiffness));
  }
  const double step = std::min(plan.time_step, plan.interval);
  if (step > period / steps_per_oscillation)
    notes.push_back(
        fmt::format("steps of {:g} s pass over the wheels' oscillation on their contacts, {:.3g} s a period: where the "
                    "track stirs it, wheel forces are rough; -ts_dt {:.2g} resolves it",
                    step, period, period / (2.0 * steps_per_oscillation)));
}

}  // namespace traverse::run
