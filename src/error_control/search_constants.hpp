// Every number of the search for mesh, step, method and vehicle model that does not follow from theory, in one table:
// what it is, and the benchmark that tells whether another value is better.
//   P  benchmarks/promises.py: promises kept, and what is refused, of scenes on their own
//   S  benchmarks/sweep_promises.py: the same of sweeps
//   W  benchmarks/work_precision.py: what a run costs at an accuracy, with its search
// What the search begins with, and how much of a run trial runs see, has its numbers where it is: initial_guess.cpp,
// trial_window.cpp and trial_runs.cpp.
#pragma once

#include <array>

namespace traverse::app::search {

// Shares of the wanted error.
inline constexpr double share = 0.4;          // P S: of the step, and of the mesh
inline constexpr double small_share = 0.25;   // P: the same at small errors, which fall too slowly to be told well
inline constexpr double small_error = 1e-4;   // P: the wanted error from which on it is small
inline constexpr double share_between = 0.5;  // P: of a step between two that were measured
inline constexpr double share_of_vibration = 0.25;   // P: of the amplitude that long steps damp out at once
inline constexpr double share_of_linear = 0.1;       // P: what linear vehicles may be out of balance by
inline constexpr double share_of_rest = 0.02;        // P: motion far from the train; accelerations lose more than that
inline constexpr double share_of_modes = 0.25;       // S: what modes leave out; other runs may be off by more
inline constexpr double share_of_whole = 0.95;       // S: all of it, on whole passages
inline constexpr double share_of_wholes_mesh = 0.5;  // S: of the mesh there, beyond which it is made finer

// Orders, at which errors fall as steps or elements are halved.
inline constexpr double full_order = 4.0;      // theory: of the default method, and of the elements
inline constexpr double refining_order = 3.0;  // P: the most that is believed of shorter steps and elements
inline constexpr double mesh_order = 2.0;      // P S: the same of meshes at small errors, and of meshes ahead
inline constexpr double track_order = 3.0;     // P: of a track's mesh before it is measured
inline constexpr double slow_order = 0.75;     // P: below which an error hardly falls
inline constexpr double least_order = 0.5;     // P S: below which it does not settle

// How far errors are extrapolated from what was measured, times its step or elements.
inline constexpr double farthest = 2.2;           // P: by a measured order, while more may be measured
inline constexpr double farthest_left = 2.5;      // P: where no more is measured
inline constexpr double farthest_supposed = 1.5;  // P: by a supposed order
inline constexpr double farthest_guess = 8.0;     // W: to guess what the run will need
inline constexpr double elsewhere = 0.93;         // P: a step that ends at other places, times the step
inline constexpr double most_growth = 4.0;        // P: of what trial runs have shown, until the end of the run
inline constexpr double undamped_sum = 2.0;       // P S: times a change, of a moment that is a sum over undamped modes

// Halvings.
inline constexpr int most_halvings = 14;           // P S: rounds of one search
inline constexpr int enough_alike = 2;             // P: in a row that agree, where wheels strike
inline constexpr int most_crawls = 2;              // P: in a row that hardly change an error, after which it stays
inline constexpr double finest_step = 1.0 / 32.0;  // P: times the first one
inline constexpr int most_in_a_bay = 8;            // W: elements
inline constexpr int most_in_a_span = 256;         // W S: the same
inline constexpr int most_in_all = 1200;           // W: the same, of all spans
inline constexpr double least_refusal = 1e-3;      // P: what a refused quantity keeps where that can be had, and
inline constexpr double refusal = 10.0;            //    times the wanted error

// Budgets: s of trial runs as step_cost counts them, and parts of the run.
inline constexpr double most_seconds = 75.0;      // W: of all trial runs
inline constexpr double cheap_seconds = 0.75;     // W: that are always spent
inline constexpr double free_seconds = 0.05;      // W: that are spent to be sure
inline constexpr double part_of_run = 0.7;        // W: that may be spent beyond
inline constexpr double part_of_run_whole = 8.0;  // W: the same with accuracy_whole
inline constexpr double part_that_saves = 0.5;    // W: for methods of fewer solves, of what they save
inline constexpr double usual_trials = 4.0;       // W: runs that a search takes as long as
inline constexpr double surely_taken = 1.5;       // W: the same, at least

// Methods of fewer solves, and batches.
inline constexpr std::array shorter_steps = {1.0, 0.7, 0.5};          // W: times the step of the default method
inline constexpr std::array batch_steps = {2.0, 1.4, 1.0, 0.7, 0.5};  // S: the same
inline constexpr double first_batch_step = 4.0;                       // S: times the first step of a run on its own
inline constexpr double one_solve = 1.5;        // S: times errors of steps of one solve, which depend on where they end
inline constexpr double one_solve_force = 2.0;  // S: times these, of wheel forces
inline constexpr double finer_mesh = 1.2;       // S: times what half the elements' length changes
inline constexpr double surely_within = 0.8, surely_beyond = 1.3;  // S: times what steps may leave

}  // namespace traverse::app::search
