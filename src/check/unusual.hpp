// Finds input that is valid but probably not intended: values that are usual in another unit, trains that do not reach
// the bridge. The scene's reader finds further cases (scene/scene_plausibility.cpp). Static wheel loads, support
// reactions and deflections show others.
#pragma once

#include <string>
#include <vector>

#include "scene_at_rest.hpp"

namespace traverse::check {

/// A wheel or a moving force.
struct Axle {
  std::string name;         // "coach, front_wheel" or "force 3"
  double x = 0.0;           // m, at t = 0
  double force = 0.0;       // N
  int type = -1;            // type of its vehicle; -1: a force, or a unit of several vehicles
  std::size_t vehicle = 0;  // its number in the train
};
std::vector<Axle> axles_of(const SceneAtRest& rest);

/// The force of a support or a vertical spring on the bridge, N, upward.
struct SupportForce {
  double x = 0.0;  // m
  bool spring = false;
  double dead_load = 0.0;              // force by the bridge's own weight
  double least = 0.0, greatest = 0.0;  // force by the train or moving forces, over all their positions
};

/// The largest jump in height of the running surface by settlements and loads, over all positions of the loads.
struct SurfaceStep {
  double x = 0.0, height = 0.0;  // m
};

struct StaticResponse {
  std::vector<SupportForce> supports;
  std::vector<SurfaceStep> steps;
  double deflection = 0.0, at = 0.0;  // m, the largest at mid-span under the train, and its position
  double span = 0.0;                  // m, length of this span
  std::string why_not;                // the reason if nothing was computed, in words
};
/// with_reactions: also the forces of supports and springs.
StaticResponse static_response(const SceneAtRest& rest, bool with_reactions);

/// One line for each finding for the first run of a scene.
std::vector<std::string> unusual_in(const scene::Scene& given, const SceneAtRest& rest, const std::vector<Axle>& axles,
                                    const StaticResponse& response);

/// Not collective; the same on every rank. No findings if the first run has no state of rest, of which the run itself
/// gives the reason.
std::vector<std::string> unusual_in(const scene::Scene& given);

}  // namespace traverse::check
