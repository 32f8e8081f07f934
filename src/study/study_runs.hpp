// The runs of a study or a sweep, shared among the ranks; their numbers go into its table as they come.
#pragma once

#include <mpi.h>

#include <vector>

#include "ensemble/parallel_cases.hpp"
#include "results/study_table.hpp"
#include "study/study_file.hpp"
#include "study/study_scenes.hpp"

namespace traverse::app {

/// Collective. Computes the runs that are not `known`, as far as nothing fails, and stores their numbers in the table
/// of rank 0. The failure of the earliest one.
RunFailure compute_runs(MPI_Comm comm, StudyScenes& scenes, const std::vector<char>& known, results::StudyTable& table,
                        StudyFile& file);

}  // namespace traverse::app
