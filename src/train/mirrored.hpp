// A vehicle is described as it runs to the right. One that runs to the left is its mirror image.
#pragma once

#include "traverse/train/vehicle.hpp"

namespace traverse::train {

/// x, angles and moments, of tables too, with the other sign. The name stays.
Vehicle mirrored(Vehicle vehicle);
Coupler mirrored(Coupler coupler);

}  // namespace traverse::train
