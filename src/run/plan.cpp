// Derives the time step from the first period, the crossing of a span and the shortest wave of track and wheels,
// rounded to 1, 2 or 5 times a power of ten, and the sampling interval from that.
#include "run/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace traverse::run
