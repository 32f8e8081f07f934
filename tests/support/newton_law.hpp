// Newton's law for every body of a mechanism, from what the results file of its run says.
#pragma once

#include "support/scene_run.hpp"

namespace traverse::test {

/// The largest difference between the forces on a body and its mass times its acceleration over all bodies and
/// instants, over the largest force; moments about the centres of mass likewise. Vehicle 0 of the scene that has just
/// been run, which has no wheels and drivers: gravity, joints, springs, actuators.
struct Imbalance {
  double force = 0.0, moment = 0.0;
};
Imbalance newton_imbalance(Results& run);

}  // namespace traverse::test
