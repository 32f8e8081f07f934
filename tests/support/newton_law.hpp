// Newton's law for every body of a mechanism, from what the results file of its run says.
#pragma once

#include "support/scene_run.hpp"

namespace traverse::test {

/// The largest difference between the forces on a body and its mass times its acceleration over all bodies and
/// instants, over the largest force; moments about the centres of mass likewise. A vehicle of the scene that has just
/// been run: gravity, joints, springs, actuators, and one wheel a body, whose force is compared in magnitude (not on a
/// body that is held along x). Nothing
/// is said of coordinates that a driver holds.
struct Imbalance {
  double force = 0.0, moment = 0.0;
};
Imbalance newton_imbalance(Results& run, int vehicle = 0);

/// Records both as properties of the running test and expects them below 1e-9.
void expect_newton(Results& run);

}  // namespace traverse::test
