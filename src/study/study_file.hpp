// The results file of a study: written as runs end, gone on with after a kill.
#pragma once

#include <mpi.h>

#include <chrono>
#include <string>
#include <vector>

#include "results/study_table.hpp"
#include "results/sweep.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Collective. With study_resume: puts the finished runs of the results file at the scene's place into the table of
/// rank 0; returns for every run, on every rank, whether it was there. InputError where the file is of another scene,
/// or was computed by another model.
std::vector<char> runs_known(MPI_Comm comm, const Scene& scene, const results::Sweep::Model& model,
                             results::StudyTable& table);

/// How the study went.
struct StudyCourse {
  long known = 0, left_group = 0;  // runs that were in the file; that had to leave those beside them
  double wall_seconds = 0.0;
  std::string ended;  // "reached its end", or why it stopped
};

class StudyFile {
 public:
  /// Collective. Begins the file, with the coordinates of all runs and what is known of them.
  StudyFile(MPI_Comm comm, results::Place place, const Scene& scene, const results::Sweep::Model& model,
            const results::StudyTable& table);
  /// Writes what is new in the table, the first run at once, later ones every few seconds. On rank 0, which leaves with
  /// all others where the disk is full.
  void update();
  /// Writes all, with summary and statistics. FileError.
  void finish(const StudyCourse& course);

 private:
  void write();

  MPI_Comm comm_;
  const results::StudyTable& table_;
  results::Sweep::Model model_;
  results::Recorder recorder_;
  std::chrono::steady_clock::time_point written_;
  double cost_ = 0.0;  // s, of the last writing; 0: there was none
};

/// What the terminal shows at the end.
void print_study_course(const results::StudyTable& table, const results::Sweep::Model& model, const StudyCourse& course,
                        const std::string& file);

}  // namespace traverse::app
