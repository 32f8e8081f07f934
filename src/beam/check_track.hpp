// Checks whether a layered track can be assembled.
#pragma once

#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// Throws InputError if it cannot; the message names the option or the sleeper, the value and the allowed values.
void check_track(const BeamModel& model);

}  // namespace traverse::beam
