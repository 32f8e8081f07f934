// Table of all numbers of the search for mesh, step, method and vehicle model that do not follow from theory. Each
// entry has its meaning and the benchmark by which another value can be compared:
//   P  benchmarks/promises.py: accepted and rejected error estimates of single scenes
//   S  benchmarks/sweep_promises.py: accepted and rejected error estimates of sweeps
//   W  benchmarks/work_precision.py: cost of a run with its search over the accuracy
// The numbers of the initial model and of the trial runs' duration are in initial_guess.cpp, trial_window.cpp and
// trial_runs.cpp.
#pragma once

#include <array>

namespace traverse::error_control::search {

// Companion runs (companion_search.cpp).
inline constexpr double order = 2.0;            // P: order by which an error is told from a change; most fall faster
inline constexpr double safety = 1.5;           // P: factor of that error
inline constexpr double aim = 0.8;              // P: share of the accuracy that the next run aims at
inline constexpr double small_part = 0.3;       // P: share of step or mesh in the error, below which it is not refined
inline constexpr double min_refinement = 1.25;  // P
inline constexpr double max_refinement = 2.0;   // P: by one run
inline constexpr double least_ratio = 1.9;      // P: of a run to its companion
inline constexpr double first_ratio = 5.6;      // P: of the first companion's step to the step of initial_guess.hpp
inline constexpr double weight_of_impacts = 3.0;       // P: factor of errors if wheels lose contact
inline constexpr double weight_of_undamped_sum = 4.0;  // P: factor of errors of moments of undamped bridges
inline constexpr double max_price = 64.0;              // W: cost of a run over the cost of the second one
inline constexpr double energy_step_factor = 0.25;     // P: reduction of a step that dissipates too much energy
inline constexpr double rejected_factor = 10.0;  // P: a rejected error is at most this factor times the accuracy, or
inline constexpr double rejected_limit = 1e-3;   // P: this value, if it can be reached

// Shares of the wanted error that one cause of errors may use.
inline constexpr double share = 0.4;  // P S: share of the step, and share of the mesh
inline constexpr double small_share =
    0.25;  // P: this share for small errors, which decrease too slowly for a reliable estimate
inline constexpr double small_error = 1e-4;   // P: wanted error that is small
inline constexpr double share_between = 0.5;  // P: share of a step between two measured steps
inline constexpr double share_of_vibration =
    0.25;                                       // P: share of the vibration's amplitude that long steps damp at once
inline constexpr double share_of_linear = 0.1;  // P: share of the linearisation residual
inline constexpr double share_of_active_window =
    0.02;  // P: share of motion outside the active window; accelerations have a larger error than that
inline constexpr double share_of_truncation =
    0.25;  // S: share of the truncation error of modes; other runs may have a larger one
inline constexpr double share_of_whole = 0.95;  // S: share of the total error, on whole passages of a train
inline constexpr double share_of_wholes_mesh =
    0.5;  // S: share of the mesh on whole passages; if exceeded, the mesh is refined

// Orders of the errors when steps or elements are halved.
inline constexpr double full_order = 4.0;      // theory: order of the default method, and of the elements
inline constexpr double refining_order = 3.0;  // P: limit for shorter steps and elements
inline constexpr double mesh_order = 2.0;      // P S: limit for meshes at small errors, and for predicted meshes
inline constexpr double track_order = 3.0;     // P: order of a track's mesh before it is measured
inline constexpr double stall_order = 0.75;    // P: below it an error hardly decreases
inline constexpr double least_order = 0.5;     // P S: below it an error does not converge

// Limits of extrapolation, as ratios of step or elements.
inline constexpr double max_extrapolation = 2.2;  // P: with a measured order, while further measurements are possible
inline constexpr double max_extrapolation_at_end = 2.5;    // P: after the last measurement
inline constexpr double max_extrapolation_supposed = 1.5;  // P: with an assumed order
inline constexpr double max_prediction = 8.0;              // W: to predict the final model
inline constexpr double shifted_step = 0.93;  // P: ratio of the step with which steps end at other positions
inline constexpr double max_growth = 4.0;     // P: growth of errors from the trial runs to the end of the run
inline constexpr double undamped_sum = 2.0;   // P S: factor of a change, for a moment that is a sum over undamped modes

// Halvings.
inline constexpr int max_halvings = 14;        // P S: rounds of one search
inline constexpr int required_agreements = 2;  // P: successive agreements that impacting wheels require
inline constexpr int max_stalls = 3;  // P: successive halvings with little change, after which an error is rejected
inline constexpr double finest_step = 1.0 / 32.0;  // P: ratio to the first step
inline constexpr int max_in_a_bay = 8;             // W: elements
inline constexpr int max_in_a_span = 256;          // W S: elements
inline constexpr int max_in_all = 1200;            // W: elements of all spans
inline constexpr double min_coarsening_limit =
    1e-3;  // P: limit of a rejected quantity's error after coarsening, if it can be reached;
inline constexpr double coarsening_factor =
    10.0;  // the larger one of this and of coarsening_factor times the wanted error

// Cost limits: s of trial runs as estimated by step_cost, and shares of the run.
inline constexpr double max_seconds = 75.0;       // W: limit for all trial runs
inline constexpr double cheap_seconds = 0.75;     // W: cost that is always allowed
inline constexpr double free_seconds = 0.05;      // W: cost that is allowed for additional checks
inline constexpr double part_of_run = 0.7;        // W: share of the run that is allowed in addition
inline constexpr double part_of_run_whole = 8.0;  // W: this share with accuracy_whole
inline constexpr double trial_share_of_saving =
    0.5;  // W: share of the saving of methods with fewer solves that their trial may cost
inline constexpr double typical_runs = 4.0;  // W: cost of a typical search, in runs
inline constexpr double min_runs = 1.5;      // W: smallest cost of a search, in runs

// Methods with fewer solves, and batches.
inline constexpr std::array shorter_steps = {1.0, 0.7, 0.5};          // W: ratio to the step of the default method
inline constexpr std::array batch_steps = {2.0, 1.4, 1.0, 0.7, 0.5};  // S: ratio to the step of the default method
inline constexpr double first_batch_step = 4.0;                       // S: ratio to the first step of a single run
inline constexpr double one_solve =
    1.5;  // S: factor for errors of methods with one solve, which depend on where steps end
inline constexpr double one_solve_force = 2.0;  // S: additional factor for wheel forces
inline constexpr double finer_mesh = 1.2;       // S: factor for the change by half the elements' length
inline constexpr double surely_within = 0.8,
                        surely_above = 1.3;  // S: error ratios that are certainly within or above the limit

}  // namespace traverse::error_control::search
