// Mesh and step of the first trial run, from the periods, waves and contacts of the scene.
#pragma once

#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Elements in the longest span; with a layered track rail elements in one sleeper bay.
int first_mesh(const scene::Scene& scene);

/// The highest frequency of a wheel on its contact under its share of the vehicle's weight, rad/s; 0 without wheels.
/// with_springs: with the stiffness of the wheel's linear springs.
double contact_frequency(const scene::Scene& scene, bool with_springs = false);

/// Whether trains exert forces on the beam along x because they brake or are driven.
bool pushes_along(const scene::Scene& scene);

/// The amplitude of a wheel's contact force after a short impulse, relative to the static force, 1/(m s); the largest
/// of all wheels.
double force_rate_after_load(const scene::Scene& scene);

inline constexpr double trial_steps_per_period = 12.0;  // initial steps in the beam's first period

/// Initial steps, s.
struct FirstSteps {
  double first = 0.0;      // resolves the contacts' vibration as far as the accuracy requires
  double longest = 0.0;    // resolves all other motion, and includes every stored sample
  std::string why;         // the reason for the length of the first time step, in words
  double of_period = 0.0;  // step that resolves the beam's first period, if the first step does not; otherwise 0
};
/// omega: the first frequency of the beam, rad/s; 0: unknown. duration: duration of a trial run, s.
FirstSteps first_steps(const scene::Scene& scene, double omega, double duration);

/// Whether a step (s) resolves the contacts' vibration well enough for the contact forces.
bool resolves_contacts(const scene::Scene& scene, double step);

}  // namespace traverse::error_control
