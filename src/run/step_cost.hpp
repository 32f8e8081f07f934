// What steps cost: one model for -check, for budgets of trial runs, for the order of runs and for the number of ranks.
// By counting, so that no decision depends on the clock; the rates are those of the processor of doc/performance.md,
// and benchmarks/check_estimates.py tells how near they come.
#pragma once

#include <string>

#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Unknowns of the bridge with so many elements in its longest span (of the rail in a sleeper bay); 0: as many as it
/// has, or about as many as it may get where that is open. 0 without a bridge.
double unknowns_of(const Scene& scene, int elements = 0);
/// s, that one of them takes in a stage.
double unknown_seconds(const Scene& scene);
/// s, of a step of one run by a method of -ts_type; by the default one where it is empty or PETSc's own. Vehicles that
/// the scene leaves open count as linear where their speed is constant. moving: the part of the unknowns that is
/// stepped.
double step_seconds(const Scene& scene, const std::string& method = {}, int elements = 0, double moving = 1.0);
/// s, of a run's stage side by side with others.
double batch_stage_seconds(const Scene& scene, double elements);
/// s, of an instant that so many modes tell exactly in time; coupled: dampers couple them.
double modal_instant_seconds(const Scene& scene, double modes, bool coupled);

}  // namespace traverse::app
