// The checks of a mechanism as described by the user.
#pragma once

#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

/// Throws InputError naming the vehicle, the part and the value that cannot be.
void check_model(const MechanismModel& model);

}  // namespace traverse::multibody
