// The error of linear vehicles, measured by comparison with the mechanisms.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// The allowed linearisation residual without a measurement, relative to the vehicles' weights
/// (train::linearisation_residual): a tenth of the accuracy.
double default_residual_limit(const scene::Scene& scene);

/// Whether the residual of the run may exceed this limit, from the residual of a trial run.
bool may_exceed(double residual, const scene::Scene& scene);

/// Collective. The allowed linearisation residual, so that linear vehicles change no controlled peak by more than a
/// tenth of the accuracy. It is at least default_residual_limit, and larger if the scene, whose mesh and step are set,
/// has the same peaks with linear vehicles and with the mechanisms. Residual and error of the peaks grow with the
/// square of the motion.
double measured_residual_limit(MPI_Comm comm, scene::Scene scene);

}  // namespace traverse::error_control
