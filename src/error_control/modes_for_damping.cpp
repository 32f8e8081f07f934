// Counts the modes up to a frequency and chooses a mesh for them.
#include "error_control/modes_for_damping.hpp"

#include <fmt/format.h>

#include <numbers>

#include "error_control/initial_guess.hpp"
#include "error_control/mode_mesh.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "run/shared_beam.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {
namespace {

constexpr double above_cutoff = 1.5;  // the filter leaves 4 % of the accelerations above this multiple of its cut-off
constexpr int first_count = 16;
constexpr std::size_t most_modes = 256;

/// The number of modes of bending up to a limit in Hz; not exact above `most_modes`.
std::size_t count_up_to(const beam::Beam& beam, double limit) {
  const double largest = 2.0 * std::numbers::pi * limit;
  for (int wanted = first_count;; wanted *= 2) {
    const modes::Modes found = modes::natural_modes(beam, wanted, false);
    std::size_t count = 0;
    for (std::size_t i = 0; i < found.omega.size(); ++i)
      if (found.motion[i] != modes::Motion::along && found.omega[i] <= largest) ++count;
    const bool complete = found.omega.size() < static_cast<std::size_t>(wanted) || found.omega.back() > largest;
    if (complete || count > most_modes) return count;
  }
}

}  // namespace

bool takes_modes_for_damping(const scene::Scene& scene) {
  if (scene.damping_of_modes.empty() || !scene.modes_open || scene.analysis != options::Analysis::transient)
    return false;
  if (!scene.beam || scene.beam->given || scene.beam->track || pushes_along(scene)) return false;
  const bool forces_alone = scene.vehicles.empty();
  if (forces_alone && (scene.load.forces.empty() || !scene.load.courses.empty())) return false;
  return !forces_alone || scene.find_option("ts_type") == nullptr;
}

Choice modes_for_damping(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes) {
  const results::Stage stage("choice of the bridge's modes");
  Choice choice{scene.model, {}, {}, {}};
  const auto keep_elements = [&] {
    notes.push_back(fmt::format("the bridge keeps its elements: it has more than {} modes", most_modes));
    return choice;
  };
  if (scene.beam->spans.size() > most_modes) return keep_elements();
  scene::Scene first = scene;
  if (first.mesh_open) set_mesh(first, mesh_for(comm, first, first_count));
  std::vector<std::string> ignored;
  const run::SharedBeam shared(comm, first, ignored);
  const double limit = above_cutoff * run::cutoff_of(run::first_frequencies(shared));
  const std::size_t modes = count_up_to(*shared.beam, limit);
  if (modes > most_modes) return keep_elements();
  choice.model.elements = first.model.elements;
  choice.model.modes = static_cast<int>(modes);
  if (first.mesh_open && choice.model.modes > first_count)
    choice.model.elements = mesh_for(comm, scene, choice.model.modes);
  notes.push_back(fmt::format(
      "{} modes represent the bridge, all up to {:.4g} Hz, 1.5 times the cut-off frequency of EN 1990 A2.4.4.2.1: "
      "elements cannot have the damping ratio of the norm in each mode; -model_modes chooses another number, 0 the "
      "elements",
      modes, limit));
  return choice;
}

}  // namespace traverse::error_control
