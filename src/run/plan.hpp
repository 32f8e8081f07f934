// What a transient run does in time: how long, with which step, stored how often.
#pragma once

#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct Plan {
  double end_time = 0.0;   // s
  double time_step = 0.0;  // s
  double interval = 0.0;   // s between samples
  long stored = 1;         // one sample in so many is stored

  /// Whether the end is a multiple of the interval between stored samples.
  bool ends_at_sample() const;
};

/// The plan of a scene: what the user left open is chosen, and each choice is a line in `notes`. first_period: of the
/// beam, s; 0 where it is not known. InputError when the scene has no end.
Plan make_plan(const Scene& scene, const coupling::System& system, double first_period,
               std::vector<std::string>& notes);

/// The same of a scene that is exact in time, whose end is known.
Plan plan_exact_in_time(const Scene& scene, double end_time, double first_period, std::vector<std::string>& notes);

}  // namespace traverse::app
