// Checks Newton's law for every body of a mechanism with the results file of its run.
#pragma once

#include "support/scene_run.hpp"

namespace traverse::test {

/// The largest difference, over all bodies and instants, between the forces on a body and its mass times its
/// acceleration, relative to the largest force; and the same for moments about the centres of mass. The vehicle is from
/// the scene that was run last. Included are gravity, joints, springs, actuators, and one wheel per body, whose force
/// is compared in magnitude (not on a body that is held along x). Coordinates that a driver prescribes are not checked.
struct Imbalance {
  double force = 0.0, moment = 0.0;
};
Imbalance newton_imbalance(Results& run, int vehicle = 0);

/// Records both differences as properties of the running test and expects them below 1e-9.
void expect_newton(Results& run);

}  // namespace traverse::test
