// How much of a crossing trial runs see: its beginning, and what comes later and is unlike all before.
#pragma once

#include <string>
#include <vector>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// When the first vehicle, or the first forces, have crossed the first span (a bridge of up to three spans in full), s;
/// at most `end`.
double initial_window(const Scene& scene, double end);

/// `until`, s; where the first vehicle is seen to leave the bridge, so much longer as its swing there takes until it
/// presses its wheels most.
double with_swing_behind(const Scene& scene, double until);

/// Whether nothing damps one of the vehicles: what its vibration is off by adds up until the end.
bool vibrates_on(const Scene& scene);

/// Something of a kind that was not there before.
struct LaterEvent {
  double until = 0.0;  // s, when the first vehicle, or the one that it is about, has it behind it
  std::string what;    // in words
};

/// What is met between `seen` and `end`, in s: spans and vehicles unlike all before, a bump, the sharpest place of a
/// profile's table, the last change of a force over time. Ascending.
std::vector<LaterEvent> later_events(const Scene& scene, double seen, double end);

}  // namespace traverse::app
