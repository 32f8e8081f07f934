// The results file of a study or a sweep. It is written as runs end; an interrupted study can be continued.
#pragma once

#include <mpi.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "results/study_reader.hpp"
#include "results/study_table.hpp"
#include "results/sweep.hpp"
#include "study/sweep_findings.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::study {

/// Collective. With study_resume: on rank 0 the content of the scene's results file that belongs to this study;
/// otherwise empty. InputError if the file belongs to another scene or was computed by another model.
results::StoredStudy stored_of(MPI_Comm comm, const scene::Scene& scene, const results::RunModel& model);

/// Collective. Copies known finished runs into the table of rank 0. Returns on each rank a flag for each run: 1 if it
/// is finished.
std::vector<char> copy_known(MPI_Comm comm, const results::StoredStudy& stored, results::StudyTable& table);

/// The runs of a table in the form of a file.
results::StoredStudy stored_of(const results::StudyTable& table);

/// The progress of the study and the reason of its end.
struct StudyCourse {
  long known = 0, separate_runs = 0;  // runs read from the file; runs computed outside their batch
  double wall_seconds = 0.0;
  std::string ended;                          // "reached its end", or why it stopped
  std::optional<results::Refined> refined{};  // empty: speeds were not to be added
};

class StudyFile {
 public:
  /// Collective. Creates the file with the coordinates of all runs and the known results.
  StudyFile(MPI_Comm comm, results::Place place, const scene::Scene& scene, const results::RunModel& model,
            const results::StudyTable& table, const std::vector<std::string>& notes);
  /// Writes new rows of the table: the first run at once, later ones every few seconds. Only on rank 0. If the disk is
  /// full, all ranks end with FileError.
  void update();
  /// Writes the complete table, summary, statistics, verdicts and the findings of a sweep. FileError.
  void finish(const StudyCourse& course, const std::vector<results::Verdict>& verdicts, const SweepFindings* findings);

 private:
  void write();
  /// The result datasets of the table; the flags of finished runs are the last one.
  std::vector<results::Recorder::Dataset> results() const;

  MPI_Comm comm_;
  const results::StudyTable& table_;
  results::RunModel model_;
  results::Recorder recorder_;
  std::chrono::steady_clock::time_point written_;
  double cost_ = 0.0;  // s, duration of the last write; 0: none yet
};

/// Prints the results at the end of the study.
void print_study_course(const results::StudyTable& table, const results::RunModel& model, const StudyCourse& course,
                        const std::vector<results::Verdict>& verdicts, const SweepFindings* findings,
                        const scene::Scene& scene);

}  // namespace traverse::study
