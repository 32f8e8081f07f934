// `accuracy` where there is no bridge: the step by which positions, joint forces and contact forces are right, found by
// runs of the whole scene with steps that are halved until what that changes tells the errors.
#pragma once

#include "error_control/accuracy.hpp"

namespace traverse::app {

/// Whether there is no bridge and the step is open.
bool chooses_step_alone(const Scene& scene);

/// The step that this begins with, s.
double longest_step_alone(const Scene& scene);

/// Collective. The scene's model with its step, which `notes` names. InputError as the scene's own run would throw it.
Choice choose_step_alone(MPI_Comm comm, const Scene& scene, std::vector<std::string>& notes);

/// Collective. Prints promised errors and those against a run with half the step. False where a promise is broken.
bool report_alone(MPI_Comm comm, const Scene& scene, const Accuracy& accuracy);

}  // namespace traverse::app
