// Compares modes and elements in a sweep of moving forces, and estimates the cost by modes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

struct ModesChoice {
  int modes = 0;       // 0: the elements remain
  double error = 0.0;  // largest relative change of the peaks of sample runs by as many modes more
};

/// If the scene leaves the modes open and the errors of mesh and step are within the accuracy (except for unfiltered
/// accelerations, whose convergence with the step is slow): computes sample runs by more and more modes until these are
/// accurate enough, and two by elements. Appends the choice to `notes`.
ModesChoice choose_mode_count(const scene::Scene& scene, const Accuracy& accuracy, std::vector<std::string>& notes);

struct QuickerModes {
  int modes = 0;
  double frequency = 0.0;  // Hz, of the highest mode
  double seconds = 0.0;    // estimated cost of the whole sweep
};

/// The cost of the sweep by the modes that EN 1990, A2.4.4.2.1 requires (up to 30 Hz, up to 1.5 times the first
/// frequency, at least three). Empty if modes are not allowed or the estimate itself would be expensive for the
/// bridge's size.
std::optional<QuickerModes> quicker_modes(const scene::Scene& scene);

}  // namespace traverse::error_control
