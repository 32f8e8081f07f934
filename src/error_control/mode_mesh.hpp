// The mesh of natural modes, where it is left open.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Whether the scene asks for modes of elements whose number it leaves open.
bool chooses_mode_mesh(const Scene& scene);

/// Collective. Halves elements until three meshes tell that every frequency asked for is right to the scene's accuracy,
/// and says so in `notes`, or that it is not.
Choice choose_mode_mesh(MPI_Comm comm, const Scene& scene, std::vector<std::string>& notes);

}  // namespace traverse::app
