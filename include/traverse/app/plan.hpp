// What a transient run does in time: how long, with which step, stored how often.
#pragma once

#include <string>
#include <vector>

#include "traverse/app/scene.hpp"
#include "traverse/coupling/system.hpp"

namespace traverse::app {

struct Plan {
  double end_time = 0.0;   // s
  double time_step = 0.0;  // s
  double interval = 0.0;   // s between samples
  long stored = 1;         // one sample in so many is stored

  /// Whether the end is a multiple of the interval between stored samples.
  bool ends_at_sample() const;
};

/// The greater of the train's and the forces' speed, m/s; 0 where there are neither.
double greatest_speed(const Scene& scene);

/// The shortest wave of the track or of a wheel out of round, m; infinite where all is smooth.
double shortest_wave(const Scene& scene);

/// The plan of a scene: what the user left open is chosen, and each choice is a line in `notes`. first_period: of the
/// beam, s; 0 where it is not known. InputError when the scene has no end.
Plan make_plan(const Scene& scene, const coupling::System& system, double first_period,
               std::vector<std::string>& notes);

}  // namespace traverse::app
