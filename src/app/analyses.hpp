// The table of functions that compute the analyses. A new analysis needs a function in a separate file, its line in
// this table, and its row in options/analyses.hpp.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "error_control/accuracy.hpp"
#include "prepare.hpp"
#include "results/checkpoint_file.hpp"
#include "results/place.hpp"
#include "run/rank_choice.hpp"
#include "run/shared_beam.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// A scene with all data for its computation.
struct Job {
  MPI_Comm comm;
  const scene::Scene& scene;  // with all selected values
  results::Place place;
  const error_control::Accuracy& accuracy;
  OpenChoice* open = nullptr;  // the choice of mesh and step, if the run is its last one
  run::SharedBeam& beam;
  std::vector<std::string> notes;
  const results::Checkpoint* earlier = nullptr;  // checkpoint that the run continues; null: none
  run::WaitingRanks* waiting = nullptr;          // ranks that can share the trains; null: none
};

// Collective. Each function writes the results file and the summary, and returns the exit status like `run`.
int run_in_time(Job job);  // the motion in time, or the static equilibrium at t = 0
int run_modes(Job job);
int run_rail(Job job);      // forces between rail and bridge along the track
int run_envelope(Job job);  // the largest static effects of the loads over all their positions
int run_screen(Job job);    // every formation of a fleet over every bridge of a stock
int check_screen(MPI_Comm comm,
                 const scene::Scene& scene);  // -describe of a screen: reads everything, and describes it

struct AnalysisRun {
  options::Analysis analysis;
  int (*run)(Job job);
};

inline constexpr AnalysisRun analysis_runs[] = {
    {options::Analysis::transient, run_in_time},       {options::Analysis::modes, run_modes},
    {options::Analysis::static_response, run_in_time}, {options::Analysis::static_envelope, run_envelope},
    {options::Analysis::rail_forces, run_rail},        {options::Analysis::screen, run_screen},
};

constexpr const AnalysisRun* run_of(options::Analysis analysis) {
  for (const AnalysisRun& row : analysis_runs)
    if (row.analysis == analysis) return &row;
  return nullptr;
}

static_assert(std::all_of(std::begin(options::analyses), std::end(options::analyses),
                          [](const options::AnalysisRow& row) {
                            return std::any_of(std::begin(analysis_runs), std::end(analysis_runs),
                                               [&](const AnalysisRun& run) { return run.analysis == row.analysis; });
                          }),
              "every analysis that may be asked for has its line in analysis_runs");

}  // namespace traverse::app
