// Runs of a sweep, shared among the ranks: all trains at some speeds.
#pragma once

#include <mpi.h>

#include <vector>

#include "results/sweep.hpp"
#include "study/case_runner.hpp"
#include "study/share_runs.hpp"

namespace traverse::app {

struct SweepRuns {
  results::Sweep sweep;  // without its model
  long ended = 0;        // runs that got to their end, of all ranks
  RunFailure failure;    // the earliest one
};

/// Collective. Every train of the scene at these speeds (m/s, ascending, within the runner's); the same on every rank.
SweepRuns run_all_trains(MPI_Comm comm, const Scene& scene, CaseRunner& runner, const std::vector<double>& speeds);

}  // namespace traverse::app
