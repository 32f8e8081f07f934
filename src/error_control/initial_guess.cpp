// Initial mesh from the characteristic length (4 EI/k)^(1/4) of a beam on an elastic foundation; initial step from the
// first period, the crossing of a span, waves of the track and the contact frequency of the wheels.
#include "error_control/initial_guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/whole.hpp"
#include "run/deck_acceleration.hpp"
#include "run/plan.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr int first_bay = 2;
constexpr int most_in_a_span = 100000;   // a span, as beam_elements_per_span allows
constexpr double elements_a_wave = 2.0;  // of a bed's characteristic length (4 EI/k)^(1/4)
constexpr double steps_a_crossing = 24.0, trial_steps_a_wave = 20.0;
constexpr double part_of_run = 1e-2;
// Step times frequency of the contacts, rad, at an accuracy of 1e-2 and at the finest; it falls as accuracy^0.22, which
// is what coaches on Hertz wheels were found to need.
constexpr double contact_angle = 1.0, least_contact_angle = 0.15, contact_power = 0.22;
constexpr double coarse = 5e-3;  // from which on the vibration on a track hardly counts
// Steps a sleeper that is passed at that accuracy; they grow as accuracy^-0.4.
constexpr double steps_a_sleeper = 8.0, sleeper_power = 0.4;
constexpr double finest = 64.0;  // times what all the rest needs
// Steps that follow the first period of the beam through a trial run: where it takes more, forces move so slowly that
// they may well do without.
constexpr double most_for_the_period = 5e4;

double contact_angle_of(double accuracy) {
  return contact_angle * std::clamp(std::pow(accuracy / 1e-2, contact_power), least_contact_angle, 1.0);
}

/// Whether nothing stirs the vibration of wheels on their contacts, or not so that it counts: on a layered track the
/// rail goes on over the bridge's ends, and the deflection under the wheels moves with them from the start.
bool unstirred(const Scene& scene) {
  return scene.beam->track && (scene.accuracy >= coarse || std::isinf(shortest_wave(scene)));
}

/// The fastest fading of bending on the beam's beds, 1/m, and the kind of foundation that makes it. Vertical springs at
/// stations count as a bed.
struct Fading {
  double rate = 0.0;
  std::string_view kind = "vertical";
};
Fading fading_of(const beam::BeamModel& beam) {
  const double EI = beam.EI.minimum();
  double springs = 0.0;
  for (const beam::PointFoundation& point : beam.foundation.vertical) springs += point.k / beam.length();
  Fading fastest{fading_of_bending(beam::Direction::vertical, springs, EI)};
  for_beds(beam.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    const bool vertical = kind.direction == beam::Direction::vertical;
    const double rate = fading_of_bending(kind.direction, bed.k.maximum() + (vertical ? springs : 0.0), EI);
    if (rate > fastest.rate) fastest = {rate, vertical ? "vertical" : kind.name};
  });
  return fastest;
}

/// Calls look(vehicle, wheel, N: its share of the vehicle's weight).
template <class Look>
void for_all_wheels(const Scene& scene, Look look) {
  for (const int index : scene.train.vehicles) {
    const Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(index)];
    double mass = 0.0;
    for (const multibody::Body& body : vehicle.mechanism.bodies) mass += body.mass;
    for (const Wheel& wheel : vehicle.wheels)
      look(vehicle, wheel, mass * scene.gravity / static_cast<double>(vehicle.wheels.size()));
  }
}

/// N/m, under its share of the weight.
double contact_stiffness(const Wheel& wheel, double weight) {
  return wheel.law.kind == contact::LawKind::hertz ? 1.5 * std::cbrt(weight * std::pow(wheel.law.stiffness, 2))
                                                   : wheel.law.stiffness;
}

double mass_of(const Vehicle& vehicle, const Wheel& wheel) {
  return vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].mass;
}

}  // namespace

int first_mesh(const Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  if (beam.track) return first_bay;
  const int wanted = scene.accuracy >= 3e-3 ? 8 : scene.accuracy >= 3e-4 ? 16 : 32;
  const auto [fading, kind] = fading_of(beam);
  if (fading == 0.0) return wanted;
  const double longest = *std::max_element(beam.spans.begin(), beam.spans.end());
  if (elements_a_wave * longest * fading > most_in_a_span)
    throw InputError(
        fmt::format("foundation_{}: on its bed the beam bends within {:.3g} m, which {:g} elements in the span "
                    "of {:g} m do not "
                    "resolve; a softer foundation, a stiffer beam_EI or a shorter span is meant, or "
                    "beam_elements_per_span is given",
                    kind, 1.0 / fading, static_cast<double>(most_in_a_span), longest));
  return std::max(wanted, 4 * base::whole(std::ceil(0.25 * elements_a_wave * longest * fading), most_in_a_span / 4));
}

double contact_frequency(const Scene& scene, bool with_springs) {
  double highest = 0.0;
  for_all_wheels(scene, [&](const Vehicle& vehicle, const Wheel& wheel, double weight) {
    double stiffness = contact_stiffness(wheel, weight);
    for (const multibody::Spring& spring : vehicle.mechanism.springs)
      if (with_springs && (spring.bodies[0] == wheel.body || spring.bodies[1] == wheel.body))
        stiffness += spring.stiffness;
    highest = std::max(highest, stiffness / mass_of(vehicle, wheel));
  });
  return std::sqrt(highest);
}

bool pushes_along(const Scene& scene) {
  if (!scene.beam || !scene.beam->axial) return false;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    if (drive_of(scene.train, i) != train::Drive::constant || !law_of(scene.train, i).constant()) return true;
  return false;
}

double swing_after_a_push(const Scene& scene) {
  double most = 0.0;
  for_all_wheels(scene, [&](const Vehicle& vehicle, const Wheel& wheel, double weight) {
    const double stiffness = contact_stiffness(wheel, weight);
    most = std::max(most, stiffness * std::sqrt(stiffness / mass_of(vehicle, wheel)) / weight);
  });
  return most;
}

FirstSteps first_steps(const Scene& scene, double omega, double duration) {
  double step = part_of_run * duration;
  std::string why = "a part of the run";
  const auto no_longer_than = [&](double most, double what, const char* text) {
    if (most >= step) return;
    step = most;
    why = fmt::format("{} {:.3g} s", text, what);
  };
  const double period = omega > 0.0 ? 2.0 * std::numbers::pi / omega : 0.0, of_period = period / trial_steps_a_period;
  const bool follows = !scene.train.vehicles.empty() || duration <= most_for_the_period * of_period;
  if (omega > 0.0 && follows) no_longer_than(of_period, period, "the first period of the beam is");
  if (const double speed = greatest_speed(scene); speed > 0.0) {
    const double span = *std::min_element(scene.beam->spans.begin(), scene.beam->spans.end());
    const double wave = shortest_wave(scene);
    no_longer_than(span / speed / steps_a_crossing, span / speed, "the shortest span is crossed in");
    no_longer_than(wave / speed / trial_steps_a_wave, wave / speed,
                   "the shortest wave of track and wheels is passed in");
  }
  if (const double frequency = scene.output.low_pass.value_or(0.0); frequency > 0.0 && filters_deck(scene))
    no_longer_than(longest_spacing_for(frequency), 1.0 / frequency, "accelerations are filtered at the period of");
  if (scene.output.interval) no_longer_than(*scene.output.interval, *scene.output.interval, "output_interval is");
  if (omega > 0.0 && !follows && of_period < step / finest)
    return {step / finest, step, "forces move slowly over the beam", of_period};
  const double contact = contact_frequency(scene);
  if (scene.beam->track && greatest_speed(scene) > 0.0 && (contact == 0.0 || unstirred(scene))) {
    const double steps = steps_a_sleeper * std::pow(std::min(scene.accuracy / coarse, 1.0), -sleeper_power);
    const double sleeper = scene.beam->track->spacing / greatest_speed(scene) / steps;
    if (sleeper >= step) return {step, step, why};
    // Halvings of the longest step, so that this one is among those that are tried.
    return {step * std::exp2(-std::round(std::log2(step / sleeper))), step, "the sleepers are passed so fast"};
  }
  if (contact == 0.0) return {step, step, why};
  const double vibration = std::max(contact_angle_of(scene.accuracy) / contact, step / finest);
  if (vibration >= step) return {step, step, why};
  return {vibration, step,
          fmt::format("wheels vibrate on their contacts at {:.3g} Hz", contact / (2.0 * std::numbers::pi))};
}

bool follows_contacts(const Scene& scene, double step) {
  return unstirred(scene) || step * contact_frequency(scene) <= 2.0 * contact_angle;
}

}  // namespace traverse::app
