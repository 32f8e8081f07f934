// What users choose of the loads of UIC 774-3: a train that stands on the track, brakes or pulls.
#pragma once

#include <vector>

namespace traverse::options {

enum class Runs { to_the_right, to_the_left, both_ways };

struct RailLoads {
  double length = 300.0;                         // m, of the train
  double weight = 8e4;                           // N/m
  double braking = 2e4, most_braking = 6e6;      // N/m, N of the whole train
  double traction = 3.3e4, most_traction = 1e6;  // the same
  std::vector<double> fronts;                    // m beyond the end of the bridge where the train comes from
  Runs runs = Runs::to_the_right;
  double rail_area = 0.0;  // m2, of both rails
};

}  // namespace traverse::options
