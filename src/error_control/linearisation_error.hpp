// What linear vehicles neglect of the peaks, as far as a run with the mechanisms shows it.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What linear vehicles that the scene leaves open may be out of balance by in any case, over their weights
/// (train::linearisation_residual): a tenth of the accuracy.
double most_residual(const Scene& scene);

/// Whether a run of which a trial run has shown so much may be out of balance by more.
bool may_exceed(double defect, const Scene& scene);

/// Collective. What they may be out of balance by, so that they change no peak that the scene asks for by more than a
/// tenth of the accuracy: at least most_residual, and more where the scene, whose mesh and step are set, has the same
/// peaks with linear vehicles and with the mechanisms. What is out of balance grows with the square of the motion, and
/// the peaks' error with that.
double tolerable_defect(MPI_Comm comm, Scene scene);

}  // namespace traverse::app
