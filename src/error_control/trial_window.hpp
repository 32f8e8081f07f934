// The duration of trial runs: the initial window and the later events that extend it.
#pragma once

#include <string>
#include <vector>

#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// The time at which the first vehicle, or the first forces, have crossed the first span (a bridge of up to three spans
/// completely), s; at most `end`.
double initial_window(const scene::Scene& scene, double end);

/// `until`, s; if the first vehicle has left the bridge by then, extended until its bounce presses the wheels most.
double extend_by_bounce(const scene::Scene& scene, double until);

/// Whether a vehicle has no damping at all, so that errors of its vibration accumulate until the end.
bool has_undamped_vehicle(const scene::Scene& scene);

/// An event that differs from all earlier ones.
struct LaterEvent {
  double until = 0.0;  // s, time at which the first vehicle, or the vehicle of this event, has passed the event
  std::string what;    // in words
};

/// The events between the times `covered` and `end`, s, ascending: spans and vehicles that differ from all earlier
/// ones, a bump, the sharpest position of a profile's table, the last change of a force over time.
std::vector<LaterEvent> later_events(const scene::Scene& scene, double covered, double end);

}  // namespace traverse::error_control
