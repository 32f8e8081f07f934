// Whether modes do as well as the elements in a sweep of moving forces, and whether they would be quicker.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct ModesChoice {
  int modes = 0;       // 0: the elements stay
  double error = 0.0;  // relative: the most that these modes change the peaks of the runs tried
};

/// Where the scene leaves the modes open and the accuracy that its mesh and step promise lets it: runs at some speeds
/// of some trains by elements, then by more and more modes until these are as good. `notes` says so.
ModesChoice choose_mode_count(const Scene& scene, const Accuracy& accuracy, std::vector<std::string>& notes);

struct QuickerModes {
  int modes = 0;
  double frequency = 0.0;  // Hz, of the highest one
  double seconds = 0.0;    // of the whole sweep, about
};

/// What the sweep would take by the modes that EN 1990, A2.4.4.2.1 counts (up to 30 Hz, up to 1.5 times the first
/// frequency, three at least), where modes are allowed and the bridge is so small that asking takes no time.
std::optional<QuickerModes> quicker_modes(const Scene& scene);

}  // namespace traverse::app
