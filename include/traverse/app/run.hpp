// Runs a scene: -describe, one analysis (in time, static, or natural modes), a sweep or a study.
#pragma once

#include <mpi.h>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. Carries out the scene's analysis and writes the results file and the summary. Throws Error; results
/// written before remain readable. Returns the exit status: 0, or 128 + signal if a signal ended the run.
int run(MPI_Comm comm, const scene::Scene& scene);

// Names that were in this namespace before their folder had one, for programs that use them.
using scene::Analysis;
using scene::Coupler;
using scene::Damping;
using scene::Drive;
using scene::greatest_speed;
using scene::has_own_contact_law;
using scene::moving_speed;
using scene::MovingLoad;
using scene::NumericalModel;
using scene::Output;
using scene::read_scene;
using scene::read_scene_of_fit;
using scene::read_scene_of_study;
using scene::Roughness;
using scene::Scene;
using scene::set_speed;
using scene::shortest_wave;
using scene::Start;
using scene::Study;
using scene::StudyDimension;
using scene::Sweep;
using scene::Train;
using scene::values_of_run;
using scene::Vehicle;
using scene::VehicleModel;
using scene::Wheel;
using scene::wheels_at_start;

}  // namespace traverse::app
