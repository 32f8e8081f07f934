// Initial mesh from the characteristic length (4 EI/k)^(1/4) of a beam on an elastic foundation; initial step from the
// first period, the crossing of a span, waves of the track and the contact frequency of the wheels.
#include "error_control/initial_guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/numbers.hpp"
#include "run/deck_acceleration.hpp"
#include "run/plan.hpp"
#include "traverse/base/error.hpp"

#pragma GCC diagnostic error "-Wswitch"  // each switch over contact::LawKind has a case for every kind

namespace traverse::error_control {
namespace {

constexpr int first_bay = 2;
constexpr int max_in_a_span = 100000;      // limit of beam_elements_per_span
constexpr double elements_per_wave = 2.0;  // elements in a bed's characteristic length (4 EI/k)^(1/4)
constexpr double steps_per_crossing = 24.0, trial_steps_per_wave = 20.0;
constexpr double part_of_run = 1e-2;
// Step times contact frequency, rad, at an accuracy of 1e-2, and its minimum. It decreases as accuracy^0.22, as
// measured for coaches on Hertz wheels.
constexpr double contact_angle = 1.0, least_contact_angle = 0.15, contact_power = 0.22;
constexpr double coarse_accuracy = 5e-3;  // accuracy from which the vibration on a track is negligible
// Steps in one sleeper bay at that accuracy; they increase as accuracy^-0.4.
constexpr double steps_per_sleeper = 8.0, sleeper_power = 0.4;
constexpr double max_step_ratio = 64.0;  // ratio of the longest to the shortest initial step
// The largest number of steps of a trial run by which the first period of the beam is resolved. If more are needed, the
// forces move so slowly that the vibration is probably negligible.
constexpr double max_steps_by_period = 5e4;

double contact_angle_of(double accuracy) {
  return contact_angle * std::clamp(std::pow(accuracy / 1e-2, contact_power), least_contact_angle, 1.0);
}

/// Whether the vibration of wheels on their contacts is not excited or negligible. With a layered track the rail
/// continues over the bridge's ends, and the deflection under the wheels moves with them from the start.
bool contact_unexcited(const scene::Scene& scene) {
  return scene.beam->track && (scene.accuracy >= coarse_accuracy || std::isinf(scene::shortest_wave(scene)));
}

/// The fastest decay of bending on the beam's beds, 1/m, and the option that causes it. Vertical point springs count as
/// a bed whose decay is at most one over their spacing: between the springs the beam is straight or bends freely.
struct Decay {
  double rate = 0.0;
  std::string option;
};
Decay decay_of(const beam::BeamModel& beam) {
  using beam::Direction;
  const double EI = beam.EI.minimum();
  double springs = 0.0;
  for (const beam::PointFoundation& point : beam.foundation.vertical) springs += point.k / beam.length();
  const double spacing = beam.length() / std::max<double>(1.0, static_cast<double>(beam.foundation.vertical.size()));
  springs = std::min(springs, 4.0 * EI / std::pow(spacing, 4));
  Decay fastest{bending_decay_rate(Direction::vertical, springs, EI), {}};
  for_beds(beam.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    const double more = kind.direction == Direction::vertical ? springs : 0.0;
    const double rate = bending_decay_rate(kind.direction, bed.k.maximum() + more, EI);
    if (rate > fastest.rate) fastest = {rate, stiffness_option(kind, bed)};
  });
  return fastest;
}

/// Calls visit(vehicle, wheel, the wheel's share of the vehicle's weight, N).
template <class Visit>
void for_all_wheels(const scene::Scene& scene, Visit visit) {
  for (const int index : scene.train.vehicles) {
    const train::Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(index)];
    double mass = 0.0;
    for (const multibody::Body& body : vehicle.mechanism.bodies) mass += body.mass;
    for (const train::Wheel& wheel : vehicle.wheels)
      visit(vehicle, wheel, mass * scene.gravity / static_cast<double>(vehicle.wheels.size()));
  }
}

/// The contact stiffness under the wheel's share of the weight, N/m.
double contact_stiffness(const train::Wheel& wheel, double weight) {
  switch (wheel.law.kind) {
    case contact::LawKind::hertz:
      return 1.5 * std::cbrt(weight * std::pow(wheel.law.stiffness, 2));
    case contact::LawKind::linear:
    case contact::LawKind::two_sided:
      return wheel.law.stiffness;
    case contact::LawKind::other:
      break;
  }
  return wheel.law.elastic->stiffness(contact::static_penetration(wheel.law, weight));
}

double mass_of(const train::Vehicle& vehicle, const train::Wheel& wheel) {
  return vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].mass;
}

}  // namespace

int first_mesh(const scene::Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  if (beam.track) return first_bay;
  const int wanted = scene.accuracy >= 3e-3 ? 8 : scene.accuracy >= 3e-4 ? 16 : 32;
  const auto [decay, option] = decay_of(beam);
  if (decay == 0.0) return wanted;
  const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
  if (elements_per_wave * longest * decay > max_in_a_span)
    throw InputError(fmt::format(
        "{}: it bends the beam within {:.3g} m, which {:g} elements in the span of {:g} m do not resolve; allowed: a "
        "smaller value, a stiffer beam_EI, a shorter span, or a given beam_elements_per_span",
        option, 1.0 / decay, static_cast<double>(max_in_a_span), longest));
  return std::max(wanted, 4 * base::whole(std::ceil(0.25 * elements_per_wave * longest * decay), max_in_a_span / 4));
}

double contact_frequency(const scene::Scene& scene, bool with_springs) {
  double highest = 0.0;
  for_all_wheels(scene, [&](const train::Vehicle& vehicle, const train::Wheel& wheel, double weight) {
    double stiffness = contact_stiffness(wheel, weight);
    for (const multibody::Spring& spring : vehicle.mechanism.springs)
      if (with_springs && (spring.bodies[0] == wheel.body || spring.bodies[1] == wheel.body))
        stiffness += spring.stiffness;
    highest = std::max(highest, stiffness / mass_of(vehicle, wheel));
  });
  return std::sqrt(highest);
}

bool pushes_along(const scene::Scene& scene) {
  if (!scene.beam || !scene.beam->axial) return false;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    if (drive_of(scene.train, i) != train::Drive::constant || !law_of(scene.train, i).constant()) return true;
  return false;
}

double force_rate_after_load(const scene::Scene& scene) {
  double largest = 0.0;
  for_all_wheels(scene, [&](const train::Vehicle& vehicle, const train::Wheel& wheel, double weight) {
    const double stiffness = contact_stiffness(wheel, weight);
    largest = std::max(largest, stiffness * std::sqrt(stiffness / mass_of(vehicle, wheel)) / weight);
  });
  return largest;
}

FirstSteps first_steps(const scene::Scene& scene, double omega, double duration) {
  double step = part_of_run * duration;
  std::string why = "a part of the run";
  const auto limit_step = [&](double largest, double what, const char* text) {
    if (largest >= step) return;
    step = largest;
    why = fmt::format("{} {:.3g} s", text, what);
  };
  const double period = omega > 0.0 ? 2.0 * std::numbers::pi / omega : 0.0, of_period = period / trial_steps_per_period;
  const bool resolves_period = !scene.train.vehicles.empty() || duration <= max_steps_by_period * of_period;
  if (omega > 0.0 && resolves_period) limit_step(of_period, period, "the first period of the beam is");
  if (const double speed = scene::greatest_speed(scene); speed > 0.0) {
    const double span = *std::min_element(scene.beam->spans.begin(), scene.beam->spans.end());
    const double wave = scene::shortest_wave(scene);
    limit_step(span / speed / steps_per_crossing, span / speed, "the shortest span is crossed in");
    limit_step(wave / speed / trial_steps_per_wave, wave / speed, "the shortest wave of track and wheels is passed in");
  }
  if (const double frequency = scene.output.low_pass.value_or(0.0); frequency > 0.0 && run::filters_deck(scene))
    limit_step(run::longest_spacing_for(frequency), 1.0 / frequency, "accelerations are filtered at the period of");
  if (const double frequency = highest_load_frequency(scene.load); frequency > 0.0)
    limit_step(1.0 / frequency / trial_steps_per_period, 1.0 / frequency, "the loads vary with the period of");
  if (scene.output.interval) limit_step(*scene.output.interval, *scene.output.interval, "output_interval is");
  if (omega > 0.0 && !resolves_period && of_period < step / max_step_ratio)
    return {step / max_step_ratio, step, "forces move slowly over the beam", of_period};
  const double contact = contact_frequency(scene);
  if (scene.beam->track && scene::greatest_speed(scene) > 0.0 && (contact == 0.0 || contact_unexcited(scene))) {
    const double steps = steps_per_sleeper * std::pow(std::min(scene.accuracy / coarse_accuracy, 1.0), -sleeper_power);
    const double sleeper = scene.beam->track->spacing / scene::greatest_speed(scene) / steps;
    if (sleeper >= step) return {step, step, why};
    // A halving of the longest step, because these are the steps that the search tries.
    return {step * std::exp2(-std::round(std::log2(step / sleeper))), step, "the sleepers are passed quickly"};
  }
  if (contact == 0.0) return {step, step, why};
  const double vibration = std::max(contact_angle_of(scene.accuracy) / contact, step / max_step_ratio);
  if (vibration >= step) return {step, step, why};
  return {vibration, step,
          fmt::format("wheels vibrate on their contacts at {:.3g} Hz", contact / (2.0 * std::numbers::pi))};
}

bool resolves_contacts(const scene::Scene& scene, double step) {
  return contact_unexcited(scene) || step * contact_frequency(scene) <= 2.0 * contact_angle;
}

}  // namespace traverse::error_control
