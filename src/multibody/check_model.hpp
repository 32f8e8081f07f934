// Checks of a mechanism as the user describes it.
#pragma once

#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

/// Throws InputError that names the vehicle, the part and the invalid value.
void check_model(const MechanismModel& model);

}  // namespace traverse::multibody
