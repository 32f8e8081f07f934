// Chooses the mesh for natural modes if it is open.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Whether the scene computes natural modes by elements whose number is open.
bool chooses_mode_mesh(const scene::Scene& scene);

/// Collective. Halves elements until three meshes show that every frequency is within the scene's accuracy. Appends the
/// mesh to `notes`, or the reason why the accuracy is not reached.
Choice choose_mode_mesh(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes);

/// Collective. A mesh for the frequencies of this number of modes.
int mesh_for(MPI_Comm comm, const scene::Scene& scene, int modes);

}  // namespace traverse::error_control
