// Table of all numbers of the search for mesh, step, method and vehicle model that do not follow from theory. Each
// entry has its meaning and the benchmark by which another value can be compared:
//   P  benchmarks/promises.py: accepted and rejected error estimates of single scenes
//   S  benchmarks/sweep_promises.py: accepted and rejected error estimates of sweeps
//   W  benchmarks/work_precision.py: cost of a run with its search over the accuracy
// The numbers of the first step and mesh are in initial_guess.cpp.
#pragma once

#include <array>

namespace traverse::error_control::search {

// Errors from the changes between a run and its companion (companion_search.cpp).
inline constexpr double order = 2.0;              // P S: the assumed order; most errors decrease faster
inline constexpr double safety = 1.5;             // P S: factor of the error
inline constexpr double weight_of_impacts = 3.0;  // P: factor of errors if wheels lose contact
inline constexpr double weight_of_jumps = 8.0;    // P: the same if dampers act in contact only
inline constexpr double weight_of_sum = 4.0;      // P S: factor of errors of moments of undamped bridges, and by modes
inline constexpr double weight_of_forces = 2.0;   // P: factor of errors of accelerations under moving forces
inline constexpr double one_solve = 1.5;          // S: factor of changes by methods with one solve a step
inline constexpr double one_solve_force = 2.0;    // S: additional factor for wheel forces

// The first runs, and the next one.
inline constexpr double first_ratio = 5.6;      // W: of the first run's step to the step of initial_guess.cpp
inline constexpr double aim = 0.8;              // W: share of the accuracy that the next run aims at
inline constexpr double small_part = 0.3;       // W: share of step or mesh in the error, below which it is not refined
inline constexpr double min_refinement = 1.25;  // W
inline constexpr double max_refinement = 2.0;   // P
inline constexpr double least_ratio = 1.9;      // P: of a run to its companion
inline constexpr double share_of_vibration = 0.2;   // P: share of the vibration that long steps may damp at once
inline constexpr double energy_step_factor = 0.25;  // W: reduction of a step that dissipates too much energy
inline constexpr double at_rest = 1e-6;  // P: largest deflection over the static one, below which the bridge is at rest

// Limits.
inline constexpr int max_halvings = 14;           // P S: of a step that fails
inline constexpr double stall_order = 0.75;       // P: below this order an error hardly decreases
inline constexpr int max_stalls = 3;              // P: refinements with little change, after which an error is rejected
inline constexpr double rejected_factor = 10.0;   // P: a rejected error is at most this factor times the accuracy, or
inline constexpr double rejected_limit = 1e-3;    // P: this value, if it can be reached
inline constexpr int max_in_a_bay = 8;            // W: elements
inline constexpr int max_in_a_span = 256;         // W S: elements
inline constexpr int max_in_all = 1200;           // W: elements of all spans
inline constexpr int first_modes = 2;             // W: modes of each span in the first run by modes
inline constexpr int max_modes = 128;             // W
inline constexpr std::size_t mode_samples = 128;  // S: runs of a sweep that are computed in its search
inline constexpr double max_seconds = 75.0;       // W: s, estimated cost of the first run
inline constexpr double cheap_seconds = 0.75;     // W: s, cost that is always allowed
inline constexpr double max_price = 64.0;         // W: cost of a run over the cost of the second one

// Other causes of errors.
inline constexpr double share_of_linear = 0.1;  // P: share of the linearisation residual
inline constexpr double max_growth = 4.0;       // P: growth of that residual from the trial runs to the run
inline constexpr double share_of_active_window =
    0.02;  // P: share of motion outside the active window; accelerations have a larger error than that

// Orders of natural frequencies as elements are halved (mode_mesh.cpp).
inline constexpr double full_order = 4.0;  // theory
inline constexpr double mesh_order = 2.0;  // before it is measured

// Steps of methods with fewer solves, over the step of the default method.
inline constexpr std::array batch_steps = {2.0, 1.4, 1.0, 0.7, 0.5};  // S

}  // namespace traverse::error_control::search
