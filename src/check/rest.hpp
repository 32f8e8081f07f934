// What stands on the wheels and what the supports bear, at rest.
#pragma once

#include <string>
#include <vector>

#include "look.hpp"

namespace traverse::app {

/// A wheel or a force that passes.
struct Axle {
  std::string name;         // "coach, front_wheel" or "force 3"
  double x = 0.0;           // m, at t = 0
  double force = 0.0;       // N
  int type = -1;            // of its vehicle; -1: a force, or a unit of several vehicles
  std::size_t vehicle = 0;  // its number in the train
};
std::vector<Axle> axles_of(const Look& look);

/// What a support or a vertical spring bears, N, upward on the bridge.
struct Borne {
  double x = 0.0;  // m
  bool spring = false;
  double own = 0.0;                    // of the bridge's own weight
  double least = 0.0, greatest = 0.0;  // of the train or forces, wherever they stand
};

/// A step of the running surface: the greatest that settlements and the loads make, wherever these stand.
struct SurfaceStep {
  double x = 0.0, height = 0.0;  // m
};

struct Rest {
  std::vector<Borne> supports;
  std::vector<SurfaceStep> steps;
  double deflection = 0.0, at = 0.0;  // m, the greatest in the middle of a span under the train; where
  double span = 0.0;                  // m, of that
  std::string why_not;                // where there is none of this, in words
};
Rest rest_of(const Look& look);

}  // namespace traverse::app
