// Model of the computing time of steps, used by -describe, for the cost limit of trial runs, for the order of runs and
// for the number of ranks. It counts operations, so that no decision depends on the clock. The times were measured on
// the processor of doc/performance.md; benchmarks/check_estimates.py compares them with measurements.
#pragma once

#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Number of steps with the cost of a factorisation for a new step length.
inline constexpr double steps_per_factorisation = 30.0;

/// Unknowns of the bridge with this number of elements in its longest span (of the rail in a sleeper bay); elements =
/// 0: the present number, or about the number that will be chosen. 0 without a bridge.
double unknowns_of(const scene::Scene& scene, int elements = 0);
/// Computing time of one unknown in a stage, s.
double unknown_seconds(const scene::Scene& scene);
/// Computing time of a step of one run, s, by a method of -ts_type; by the default one if it is empty or one of
/// PETSc's. Vehicles whose model is open are assumed linear if their speed is constant. moving: the active part of the
/// unknowns.
double step_seconds(const scene::Scene& scene, const std::string& method = {}, int elements = 0, double moving = 1.0);
/// Computing time of a run's stage in a batch, s.
double batch_stage_seconds(const scene::Scene& scene, double elements);
/// Computing time of an instant of an exact solution by modes, s; coupled: dampers couple the modes.
double modal_instant_seconds(const scene::Scene& scene, double modes, bool coupled);
/// Computing time of such an instant of a single run, with nodal vectors and energies, s.
double modal_sample_seconds(double modes, double unknowns, bool coupled);

}  // namespace traverse::run
