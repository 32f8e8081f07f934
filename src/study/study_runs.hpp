// Computes the runs of a study or a sweep on all ranks, stores their results in its table as they arrive, arranges them
// as curves over the speed, and adds speeds near their peaks.
#pragma once

#include <mpi.h>

#include <functional>
#include <vector>

#include "ensemble/parallel_cases.hpp"
#include "results/study_table.hpp"
#include "study/interval_search.hpp"
#include "study/study_scenes.hpp"

namespace traverse::study {

/// Computes one run on this rank and stores its results in the table.
void compute_run(StudyScenes& scenes, std::size_t run, results::StudyTable& table);

/// Collective. Computes the runs that are not `known` until the end or a failure, and stores their results in the table
/// of rank 0, where `stored` is called after each row. Returns the failure of the earliest run.
ensemble::RunFailure compute_runs(MPI_Comm comm, StudyScenes& scenes, const std::vector<char>& known,
                                  results::StudyTable& table, const std::function<void()>& stored);

/// The curves of the peaks at the governing probe, of the greatest wheel force and of the limited quantities, over the
/// speeds in ascending order, for a study whose speeds are refined. Statistics are computed over some of the other
/// options. There is one curve for each combination of the options without statistics; its values are the greatest over
/// the options with statistics.
std::vector<SpeedCurve> curves_of(const results::StudyTable& table);

/// The curves of the limited quantities that are below their limits at all speeds so far, each with its limit.
std::vector<LimitedCurve> curves_below_limits(const results::StudyTable& table);

/// The next speeds of a table's study. Speeds are added until the peaks over the speed are known to `refine`, relative
/// to their values, or, if `refine` is below 0, until no limit can be exceeded between two speeds. width: width of a
/// resonance, see refine_for_limits.
Refinement next_speeds(const results::StudyTable& table, double width);

/// The study with these values of a dimension added, in ascending order. The dimension has an axis of its own.
options::Study with_values(options::Study study, std::size_t dimension, const std::vector<double>& added);

/// The values of a dimension, ascending.
std::vector<double> ascending(const options::Study& study, std::size_t dimension);

}  // namespace traverse::study
