// What a vehicle's linear model leaves out: the mechanism's residual out of balance, which grows with the squares of
// its coordinates from where it was linearised.
#pragma once

#include <vector>

#include "train/linear_dynamics.hpp"

namespace traverse::train {

/// The largest residual over the vehicle's weight with its coordinates at x from the start (m, rad). The vehicle is
/// moved there.
double linearisation_residual_at(MovingVehicle& vehicle, const double* x);

/// Of every coordinate alone: the root of what its square adds to that residual, 1/m or 1/rad.
std::vector<double> residual_roots(MovingVehicle vehicle);

}  // namespace traverse::train
