// Searches the number of modes for a sweep of moving forces, and estimates the cost by modes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// If the scene leaves the modes open and modes are allowed: the number of modes, and their mesh, with which the peaks
/// are accurate enough, by runs with more and more modes, which are exact in time. Empty if no affordable number is
/// sufficient for deflections, moments and low-passed accelerations. Appends the choice to `notes`.
std::optional<Choice> choose_modes(const scene::Scene& scene, std::vector<std::string>& notes);

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
