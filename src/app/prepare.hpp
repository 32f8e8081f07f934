// What comes before a scene is run: what it left open is chosen, and what its runs share is made ready.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Fills in what is open of the scene's model, as the accuracy asks.
Accuracy choose_model(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes);

/// Collective. Damps and prepares the beam, and settles how often responses are looked at. Returns the frequency that
/// counts where the deck's accelerations are filtered, Hz, else 0.
double prepare(Scene& scene, const Accuracy& accuracy, SharedBeam& shared, std::vector<std::string>& notes);

}  // namespace traverse::app
