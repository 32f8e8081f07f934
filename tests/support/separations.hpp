// The list of contacts lost and met again that a results file holds.
#pragma once

#include "support/scene_run.hpp"

namespace traverse::test {

/// A row of /separations.
struct Separated {
  std::string vehicle, contact;
  double x, start, duration, approach_speed, impact_force;
  double end() const { return start + duration; }
};

/// All rows; none where the file has no such list.
std::vector<Separated> separations(Results& run);

}  // namespace traverse::test
