// Computes the runs of a study or a sweep on all ranks and stores their results in its table as they arrive.
#pragma once

#include <mpi.h>

#include <functional>
#include <vector>

#include "ensemble/parallel_cases.hpp"
#include "results/study_table.hpp"
#include "study/study_scenes.hpp"

namespace traverse::study {

/// Computes one run on this rank and stores its results in the table.
void compute_run(StudyScenes& scenes, std::size_t run, results::StudyTable& table);

/// Collective. Computes the runs that are not `known` until the end or a failure, and stores their results in the table
/// of rank 0, where `stored` is called after each row. Returns the failure of the earliest run.
ensemble::RunFailure compute_runs(MPI_Comm comm, StudyScenes& scenes, const std::vector<char>& known,
                                  results::StudyTable& table, const std::function<void()>& stored);

}  // namespace traverse::study
