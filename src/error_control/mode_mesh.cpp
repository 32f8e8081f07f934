// Doubles the number of elements until Richardson extrapolation of the natural frequencies estimates an error within
// the accuracy.
#include "mode_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/shared_beam.hpp"

namespace traverse::error_control {
namespace {

constexpr int first_in_span = 16, first_in_bay = 4, max_in_bay = 16;
constexpr double max_in_all =
    5e4;  // elements: with more of them eigenvalues take minutes, and rounding errors dominate
constexpr int max_in_span = 1024;
constexpr double min_order = 1.0;

class Frequencies {
 public:
  Frequencies(MPI_Comm comm, const scene::Scene& scene) : comm_(comm), scene_(scene) {}

  /// The frequencies of a mesh with this number of elements in a span (or sleeper bay), rad/s.
  const std::vector<double>& of(int elements) {
    const auto known = frequencies_.find(elements);
    if (known != frequencies_.end()) return known->second;
    scene::Scene scene = scene_;
    set_mesh(scene, elements);
    std::vector<std::string> ignored;
    const run::SharedBeam shared(comm_, scene, ignored);
    return frequencies_[elements] = modes::natural_modes(*shared.beam, scene.mode_count, false).omega;
  }

  /// The largest relative error of a mesh, from the changes by its last two halvings.
  double error(int elements) {
    const std::vector<double>&fine = of(elements), &middle = of(elements / 2), &first = of(elements / 4);
    double largest = 0.0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (fine[i] == 0.0) continue;
      if (i >= middle.size()) return 1.0;
      const double change = std::abs(middle[i] / fine[i] - 1.0);
      double order = search::mesh_order;
      if (i < first.size() && change > 0.0)
        order = std::clamp(std::log2(std::abs(first[i] / fine[i] - 1.0) / change - 1.0), min_order, search::full_order);
      largest = std::max(largest, change / (std::exp2(std::isnan(order) ? min_order : order) - 1.0));
    }
    return largest;
  }

 private:
  MPI_Comm comm_;
  const scene::Scene& scene_;
  std::map<int, std::vector<double>> frequencies_;
};

bool too_many(const scene::Scene& scene, int elements) {
  if (scene.beam->track) return elements > max_in_bay;
  return elements > max_in_span || elements * static_cast<double>(scene.beam->spans.size()) > max_in_all;
}

}  // namespace

bool chooses_mode_mesh(const scene::Scene& scene) {
  return scene.analysis == options::Analysis::modes && scene.mesh_open && scene.beam && !scene.by_given_modes();
}

Choice choose_mode_mesh(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes) {
  const results::Stage stage("search for the mesh of the modes");
  const auto begin = std::chrono::steady_clock::now();
  Choice choice{scene.model, {}, {}, {}};
  Accuracy& accuracy = choice.accuracy;
  Frequencies frequencies(comm, scene);
  int elements = scene.beam->track ? first_in_bay : first_in_span;
  while (!too_many(scene, 2 * elements) && frequencies.error(elements) > scene.accuracy) elements *= 2;
  accuracy.measured = true;
  ErrorEstimate& estimate = accuracy.frequencies;
  estimate = {true, true, frequencies.error(elements), {}};
  estimate.accepted = estimate.expected <= scene.accuracy;
  accuracy.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const char* of = scene.beam->track ? "sleeper bay" : "span";
  choice.model.elements = elements;
  if (estimate.accepted)
    notes.push_back(fmt::format("accuracy {:g}: {} elements a {}; expected error of the frequencies {:.1g}",
                                scene.accuracy, elements, of, estimate.expected));
  else
    notes.push_back(fmt::format("error not estimated: frequencies: the error with {} elements a {} is {:.1g}", elements,
                                of, estimate.expected));
  return choice;
}

int mesh_for(MPI_Comm comm, const scene::Scene& scene, int modes) {
  scene::Scene of_modes = scene;
  of_modes.analysis = options::Analysis::modes;
  of_modes.mode_count = modes;
  std::vector<std::string> ignored;
  return choose_mode_mesh(comm, of_modes, ignored).model.elements;
}

}  // namespace traverse::error_control
