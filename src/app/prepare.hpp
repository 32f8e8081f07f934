// Preparation of a run: selection of the numerical model, and computation of the data that all runs of a scene share.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

inline constexpr int most_halvings = 4;  // of a selected time step that was too long

/// Collective. Selects the parts of the numerical model that the scene does not prescribe, for the wanted accuracy.
error_control::Accuracy choose_model(MPI_Comm comm, scene::Scene& scene, std::vector<std::string>& notes);

/// Collective. Computes the beam's damping and factorisation, and sets the sampling interval of the responses. Returns
/// the cut-off frequency of the filter for deck accelerations, Hz; 0 without a filter.
double prepare(scene::Scene& scene, const error_control::Accuracy& accuracy, run::SharedBeam& shared,
               std::vector<std::string>& notes);

}  // namespace traverse::app
