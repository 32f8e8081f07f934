// The options of the loads of UIC 774-3: the weight, the braking force and the traction of a train.
#pragma once

#include <vector>

namespace traverse::options {

enum class Runs { to_the_right, to_the_left, both_ways };

struct RailLoads {
  double length = 300.0;                         // length of the train, m
  double weight = 8e4;                           // N/m
  double braking = 2e4, most_braking = 6e6;      // N/m, and the greatest force of the train in N
  double traction = 3.3e4, most_traction = 1e6;  // N/m, and the greatest force of the train in N
  std::vector<double> fronts;  // positions of the train's front, m, from the bridge end at which the train enters
  Runs runs = Runs::to_the_right;
  double rail_area = 0.0;  // area of both rails, m2
};

}  // namespace traverse::options
