// Duration, step and sampling of a transient run.
#pragma once

#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

struct Plan {
  double end_time = 0.0;   // s
  double time_step = 0.0;  // s
  double interval = 0.0;   // s, between samples
  long stored = 1;         // one sample out of this number is stored

  /// Whether the end is a multiple of the interval between stored samples.
  bool ends_at_sample() const;
};

/// The plan of a scene. Open values are chosen, and each choice is appended to `notes`. first_period: first period of
/// the beam, s; 0 if unknown. InputError if the scene has no end.
Plan make_plan(const scene::Scene& scene, const coupling::System& system, double first_period,
               std::vector<std::string>& notes);

/// The plan of a scene that is computed exactly in time and whose end is known.
Plan plan_exact_in_time(const scene::Scene& scene, double end_time, double first_period,
                        std::vector<std::string>& notes);

}  // namespace traverse::run
