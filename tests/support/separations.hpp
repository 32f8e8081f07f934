// The list of contact losses with the following impacts in a results file.
#pragma once

#include "support/scene_run.hpp"

namespace traverse::test {

/// A row of /separations.
struct Separated {
  std::string vehicle, contact;
  double x, start, duration, approach_speed, impact_force;
  double end() const { return start + duration; }
};

/// All rows; empty if the file has no such list.
std::vector<Separated> separations(Results& run);

}  // namespace traverse::test
