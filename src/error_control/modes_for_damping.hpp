// Represents a bridge by its modes where each mode has the damping ratio of a norm, which elements cannot give to all.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Whether the scene has a damping ratio for each mode, leaves the modes open, and can be computed by them.
bool takes_modes_for_damping(const scene::Scene& scene);

/// Collective. All bending modes up to 1.5 times the cut-off frequency of EN 1990, A2.4.4.2.1, and if the mesh is open
/// one on which their frequencies are within the accuracy. The elements remain if there are too many of these modes.
Choice modes_for_damping(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes);

}  // namespace traverse::error_control
