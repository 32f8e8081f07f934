// Mesh and step that trial runs begin with: from the periods, waves and contacts of the scene.
#pragma once

#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Elements of the longest span; with a layered track elements of the rail a sleeper bay.
int first_mesh(const Scene& scene);

/// The highest frequency at which a wheel vibrates on its contact under its share of the vehicle's weight, rad/s; 0
/// without wheels. with_springs: between that and its linear springs.
double contact_frequency(const Scene& scene, bool with_springs = false);

/// Whether trains push the beam along as they brake or are driven.
bool pushes_along(const Scene& scene);

/// By how much, over what it carries, the force of a wheel swings after it has been pressed down for a moment: 1/(m s)
/// of that; the most of all wheels.
double swing_after_a_push(const Scene& scene);

inline constexpr double trial_steps_a_period = 12.0;  // of the beam's first period

/// s.
struct FirstSteps {
  double first = 0.0;      // where the contacts' vibration is resolved as far as the accuracy wants
  double longest = 0.0;    // where all the rest is, and no stored sample is stepped over
  std::string why;         // what asks for the first one, in words
  double of_period = 0.0;  // that follows the first period of the beam, where the first one does not; else 0
};
/// omega: the first frequency of the beam, rad/s; 0: not known. duration: of a trial run, s.
FirstSteps first_steps(const Scene& scene, double omega, double duration);

/// Whether a step (s) follows the contacts' vibration so far that its forces are told.
bool follows_contacts(const Scene& scene, double step);

}  // namespace traverse::app
