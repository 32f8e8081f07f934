// Answers the question of a search (find_option) from the table of its study: the values of the option for which no run
// exceeds the limits, or a given value of a quantity.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "results/study_table.hpp"
#include "study/interval_search.hpp"

namespace traverse::study {

/// The answer for one combination of the axes of Find::for_each, or for all runs.
struct FoundAnswer {
  std::string name;           // "load_hslm_a 3"; "all"
  std::vector<double> ratio;  // at each searched value: the greatest ratio of a run to its bound; NaN: unknown
  std::vector<std::size_t> run, limit;  // the run and the limit of each ratio
  std::vector<WithinInterval> intervals;
};

/// The answers of a table whose study has a search, that of all runs last.
std::vector<FoundAnswer> answers_of(const results::StudyTable& table);

/// The values of the option that have to be added. Empty: the intervals are known to the accuracy of the search.
std::vector<double> values_to_add(const results::StudyTable& table);

/// The message that the runs of a table determine no quantity of the search; empty if they do.
std::string undetermined(const results::StudyTable& table);

/// Collective. SolverError if the table of rank 0 does not have the answers: no run determines a quantity, or the ends
/// of the intervals are not known to the accuracy of the search.
void check_answers(MPI_Comm comm, const results::StudyTable& table);

void print_answers(const results::StudyTable& table, const std::vector<FoundAnswer>& answers);
/// Writes /find of the results file.
void record_answers(const results::StudyTable& table, const std::vector<FoundAnswer>& answers,
                    results::Recorder& recorder);

}  // namespace traverse::study
