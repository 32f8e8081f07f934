// The results file of a study or a sweep: written as runs end, gone on with after a kill.
#pragma once

#include <mpi.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "results/refined.hpp"
#include "results/run_model.hpp"
#include "results/study_reader.hpp"
#include "results/study_table.hpp"
#include "study/sweep_findings.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. With study_resume: what the results file at the scene's place holds of this study, on rank 0; else
/// nothing. InputError where the file is of another scene, or was computed by another model.
results::StoredStudy stored_of(MPI_Comm comm, const Scene& scene, const results::RunModel& model);

/// Collective. Puts the finished runs that are known into the table of rank 0; returns for every run, on every rank,
/// whether it is finished.
std::vector<char> take_known(MPI_Comm comm, const results::StoredStudy& stored, results::StudyTable& table);

/// The runs of a table as a file holds them.
results::StoredStudy stored_of(const results::StudyTable& table);

/// How the study went.
struct StudyCourse {
  long known = 0, left_group = 0;  // runs that were in the file; that had to leave those beside them
  double wall_seconds = 0.0;
  std::string ended;                          // "reached its end", or why it stopped
  std::optional<results::Refined> refined{};  // where speeds were to be added
};

class StudyFile {
 public:
  /// Collective. Begins the file, with the coordinates of all runs and what is known of them.
  StudyFile(MPI_Comm comm, results::Place place, const Scene& scene, const results::RunModel& model,
            const results::StudyTable& table, const std::vector<std::string>& notes);
  /// Writes what is new in the table, the first run at once, later ones every few seconds. On rank 0, which leaves with
  /// all others where the disk is full.
  void update();
  /// Writes all, with summary, statistics and verdicts, and what a sweep has found. FileError.
  void finish(const StudyCourse& course, const std::vector<results::Verdict>& verdicts, const SweepFindings* findings);

 private:
  void write();
  /// The table's, that of finished runs last.
  std::vector<results::Recorder::Dataset> results() const;

  MPI_Comm comm_;
  const results::StudyTable& table_;
  results::RunModel model_;
  results::Recorder recorder_;
  std::chrono::steady_clock::time_point written_;
  double cost_ = 0.0;  // s, of the last writing; 0: there was none
};

/// What the terminal shows at the end.
void print_study_course(const results::StudyTable& table, const results::RunModel& model, const StudyCourse& course,
                        const std::vector<results::Verdict>& verdicts, const SweepFindings* findings,
                        const Scene& scene);

}  // namespace traverse::app
