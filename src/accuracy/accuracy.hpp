// `accuracy`: mesh and step that keep the errors of peaks below what the user wants, where the user left them open.
//
// Chosen by measuring: the beginning of the scene, until its first vehicle has crossed the first spans, is run with a
// few meshes and steps, each halved until what that changes tells the errors of deflection, acceleration, moment and
// wheel force and how fast they fall. A quantity that does not settle is named and not promised.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "run/peaks.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What is said of one quantity's peak.
struct Promise {
  bool present = false;   // in this scene
  bool kept = false;      // promised: the expected error is not above the wanted one
  double expected = 0.0;  // relative to the peak
  std::string why_not;    // where it is not promised
};

struct Accuracy {
  bool measured = false;  // false: nothing was open, or there is nothing to measure
  std::array<Promise, quantities> promises;
  /// Name in the results file and expected error of each quantity that is promised.
  std::vector<std::pair<std::string, double>> expected() const;
  double seconds = 0.0;  // wall time that choosing took
};

/// Collective. Fills in the scene's mesh, step and tolerances as far as they are open and says so in `notes`.
/// InputError as the scene's own run would throw it.
Accuracy choose(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes);

/// The scene with twice the elements in every span (or sleeper bay) and half the step; where modes were chosen for it,
/// by its elements and mechanisms.
Scene refined(const Scene& scene);

}  // namespace traverse::app
