// Chooses the step for `accuracy` without a bridge: whole runs with halved steps determine the errors of positions,
// joint forces and contact forces.
#pragma once

#include "error_control/accuracy.hpp"

namespace traverse::error_control {

/// Whether the scene has no bridge and the step is open.
bool chooses_multibody_step(const scene::Scene& scene);

/// The first step of the search, s.
double first_multibody_step(const scene::Scene& scene);

/// Collective. The scene's model with its step, which is appended to `notes`. InputError as from the scene's own run.
Choice choose_multibody_step(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes);

/// Collective. Prints the estimated errors and those against a run with half the step. False if an accepted estimate is
/// exceeded.
bool report_multibody(MPI_Comm comm, const scene::Scene& scene, const Accuracy& accuracy);

}  // namespace traverse::error_control
