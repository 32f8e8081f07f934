// Preparation of a run: selection of the numerical model, and computation of the data that all runs of a scene share.
#pragma once

#include <mpi.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "error_control/accuracy.hpp"
#include "error_control/choice_cache.hpp"
#include "error_control/model_search.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

inline constexpr int most_halvings = 4;  // of a selected time step that was too long

/// A choice whose errors are known after its run only: the run is the last one of the search.
class OpenChoice {
 public:
  OpenChoice(std::shared_ptr<error_control::ModelSearch> search, error_control::ChoiceCache cache,
             error_control::Choice choice, std::vector<std::string> notes)
      : search_(std::move(search)), cache_(std::move(cache)), choice_(std::move(choice)), notes_(std::move(notes)) {}

  /// Adds the complete run with its model. True if its errors are known then, which it stores for the same scene.
  bool add(const scene::NumericalModel& model, error_control::RunPeaks run);
  /// The choice with its errors, or a finer model to run.
  const error_control::Choice& choice() const { return choice_; }

 private:
  std::shared_ptr<error_control::ModelSearch> search_;
  error_control::ChoiceCache cache_;
  error_control::Choice choice_;
  std::vector<std::string> notes_;
};

/// Collective. Selects the parts of the numerical model that the scene does not prescribe, for the wanted accuracy.
/// open: if it is given, the run may be the last one of the search.
error_control::Accuracy choose_model(MPI_Comm comm, scene::Scene& scene, std::vector<std::string>& notes,
                                     std::optional<OpenChoice>* open = nullptr);

/// Collective. Computes the beam's damping and factorisation, and sets the sampling interval of the responses. Returns
/// the cut-off frequency of the filter for deck accelerations, Hz; 0 without a filter.
double prepare(scene::Scene& scene, const error_control::Accuracy& accuracy, run::SharedBeam& shared,
               std::vector<std::string>& notes);

}  // namespace traverse::app
