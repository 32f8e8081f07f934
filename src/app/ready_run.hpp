// A passage at its start: all is checked and said, and nothing of the motion is computed yet.
#pragma once

#include <optional>

#include "analyses.hpp"
#include "base/archive.hpp"
#include "error_control/accuracy.hpp"
#include "run/passage.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct ReadyRun {
  /// Collective. Of a job that outlives it. InputError where it cannot be run. Prints the notes.
  explicit ReadyRun(Job& given);

  bool goes_on() const { return job.earlier != nullptr; }
  bool moves() const { return scene.analysis != Analysis::static_response; }

  Job& job;
  int rank = 0;
  Scene scene;
  Accuracy accuracy;
  double counting;              // Hz: deck accelerations are low-passed there; 0: they are not
  std::optional<Plan> earlier;  // of the run that it goes on from
  Passage passage;
  bool filters_deck = false, filters_forces = false;  // by low passes
  std::size_t wheels;
  std::optional<base::Archive> archive;  // the rest of what the run knew that it goes on from

 private:
  void record_rounding();
  void choose_filters();
};

}  // namespace traverse::app
