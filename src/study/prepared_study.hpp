// A study with its numerical model, ready to be computed: with a results file (study.hpp), or in memory.
#pragma once

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ensemble/parallel_cases.hpp"
#include "error_control/model_choice.hpp"
#include "results/study_table.hpp"
#include "study/study_scenes.hpp"

namespace traverse::study {

class PreparedStudy {
 public:
  /// Collective. Reads the scenes with extreme values, chooses the model and checks the first runs. Throws InputError,
  /// SolverError. The scene must outlive the object. read: as for StudyScenes.
  PreparedStudy(MPI_Comm comm, const scene::Scene& given, StudyScenes::Read read = {});

  /// Collective. Computes all runs without a file. `stored` is called on rank 0 after each row of results. The results
  /// are in the table of every rank.
  ensemble::RunFailure compute(MPI_Comm comm, const std::function<void()>& stored);
  /// The table of `compute`.
  const results::StudyTable& table() const { return *table_; }

  StudyScenes scenes;
  std::vector<std::string> notes;  // on the choice and the model
  error_control::Choice choice;
  scene::Scene scene;                           // of the first run, with the model
  results::RunModel model;                      // for the results
  std::shared_ptr<ensemble::CaseRunner> first;  // computes the runs of the first scene

 private:
  error_control::Choice chosen(MPI_Comm comm, const scene::Scene& given);

  std::optional<results::StudyTable> table_;
};

/// Whether a run of the scene has wheels.
bool has_wheels(const scene::Scene& scene);

}  // namespace traverse::study
