// Vehicles are described as running to the right. A vehicle that runs to the left is the mirror image.
#pragma once

#include "traverse/train/vehicle.hpp"

namespace traverse::train {

/// Reverses the signs of x, angles and moments, also in tables. The name remains.
Vehicle mirrored(Vehicle vehicle);
Coupler mirrored(Coupler coupler);

}  // namespace traverse::train
