// The error of a vehicle's linear model: the residual of the mechanism's equations, which is proportional to the
// squares of its coordinates from the state of linearisation.
#pragma once

#include <vector>

#include "train/linear_dynamics.hpp"

namespace traverse::train {

/// The largest residual over the vehicle's weight with its coordinates at x from the start (m, rad). The vehicle is
/// moved to this state.
double linearisation_residual_at(MovingVehicle& vehicle, const double* x);

/// The square root of that residual per unit of each coordinate alone, 1/m or 1/rad.
std::vector<double> residual_roots(MovingVehicle vehicle);

}  // namespace traverse::train
