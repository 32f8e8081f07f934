// A run at its start: the input is checked, the notes are printed, and no motion is computed yet.
#pragma once

#include <optional>

#include "analyses.hpp"
#include "base/archive.hpp"
#include "error_control/accuracy.hpp"
#include "run/passage.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct ReadyRun {
  /// Collective. The job must outlive this object. Throws InputError if the job cannot be run. Prints the notes.
  explicit ReadyRun(Job& given);

  bool goes_on() const { return job.earlier != nullptr; }
  bool moves() const { return scene.analysis != Analysis::static_response; }

  Job& job;
  int rank = 0;
  Scene scene;
  Accuracy accuracy;
  double counting;              // Hz, cut-off frequency of deck accelerations; 0: no filter
  std::optional<Plan> earlier;  // plan of the run that this run continues
  Passage passage;
  bool filters_deck = false, filters_forces = false;  // whether low-pass filters are applied
  std::size_t wheels;
  std::optional<base::Archive> archive;  // remaining state of the run that this run continues

 private:
  void record_rounding();
  void choose_filters();
};

}  // namespace traverse::app
