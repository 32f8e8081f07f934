// Increases the number of modes until the peaks of sample runs agree with those by elements. The cost by modes is
// estimated with the modes that EN 1990, A2.4.4.2.1 requires.
#include "error_control/mode_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ensemble/case_runner.hpp"
#include "error_control/peak_errors.hpp"
#include "error_control/search_constants.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t runs_per_sample = 10, max_samples = 9, min_runs = 2 * runs_per_sample;
constexpr double code_frequency = 30.0, code_factor = 1.5;  // Hz; factor of the first frequency
constexpr std::size_t code_modes = 3;
constexpr int max_required = 64, max_nodes = 1000;

/// The largest relative difference of low-passed accelerations with a limit.
double difference_low_passed(const Scene& scene, const CaseResult& modes, const CaseResult& elements) {
  double worst = 0.0;
  for (std::size_t i = 0; i < scene.limits.size(); ++i) {
    const double value = elements.evaluated[i].value;
    if (scene.limits[i].quantity == "deck_acceleration" && value > 0.0)
      worst = std::max(worst, std::abs(modes.evaluated[i].value / value - 1.0));
  }
  return worst;
}

/// The largest difference of all controlled peaks.
double greatest_difference(const Scene& scene, const CaseResult& modes, const CaseResult& elements) {
  const double filtered = is_controlled(scene, low_passed) ? difference_low_passed(scene, modes, elements) : 0.0;
  return std::max(filtered, greatest(difference(scene, modes, elements)));
}

/// Whether modes are allowed for the scene. read_modal has the same conditions.
bool modes_allowed(const Scene& scene) {
  return scene.vehicles.empty() && !scene.load.forces.empty() && scene.load.courses.empty() && !scene.beam->track &&
         !scene.beam->foundation.nonlinear() && !scene.beam->strained() &&
         options::in_force().find("ts_type") == nullptr;
}

bool is_worth_trying(const Scene& scene, const Accuracy& accuracy) {
  if (!scene.modes_open || !accuracy.measured || !modes_allowed(scene)) return false;
  for (const Quantity q : {deflection, acceleration, moment, low_passed})
    if (is_controlled(scene, q) && !accuracy.estimates[q].accepted) return false;
  return scene.sweep->speeds.size() * std::max<std::size_t>(1, scene.sweep->loads.size()) >= min_runs;
}

struct Sample {
  std::size_t train;
  double speed;
  CaseResult result;
};

/// Runs by elements at speeds from the slowest to the fastest, over all trains in turn.
std::vector<Sample> sample_runs(CaseRunner& elements) {
  const std::vector<double>& speeds = elements.speeds();
  const std::size_t count = std::min(max_samples, speeds.size() * elements.trains() / runs_per_sample);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double speed = speeds[i * (speeds.size() - 1) / (count - 1)];
    samples.push_back({i % elements.trains(), speed, elements.run(i % elements.trains(), {speed, {}})});
  }
  return samples;
}

/// The modes that EN 1990, A2.4.4.2.1 requires.
QuickerModes required_modes(const beam::Beam& beam) {
  std::vector<double> frequencies;  // Hz, bending modes
  const modes::Modes found = modes::natural_modes(beam, max_required, false);
  for (std::size_t i = 0; i < found.omega.size(); ++i)
    if (found.axial[i] == 0 && found.omega[i] > 0.0) frequencies.push_back(found.omega[i] / (2.0 * std::numbers::pi));
  if (frequencies.empty()) throw SolverError("the bridge has no mode of bending");
  const double wanted = std::max(code_frequency, code_factor * frequencies.front());
  const auto count_below = std::upper_bound(frequencies.begin(), frequencies.end(), wanted) - frequencies.begin();
  const auto count =
      std::min(std::max<std::size_t>(static_cast<std::size_t>(count_below), code_modes), frequencies.size());
  return {static_cast<int>(count), frequencies[count - 1], 0.0};
}

}  // namespace

ModesChoice choose_mode_count(const Scene& scene, const Accuracy& accuracy, std::vector<std::string>& notes) {
  if (!is_worth_trying(scene, accuracy)) return {};
  const options::WithoutMonitors without_monitors;
  const results::Stage stage("trial runs by modes and by elements");
  try {
    std::vector<std::string> ignored;
    CaseRunner elements(scene, ignored);
    const std::vector<Sample> samples = sample_runs(elements);
    Scene by_modes = scene;
    for (const int number : {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
      by_modes.model.modes = number;
      CaseRunner modes(by_modes, ignored);
      if (modes.cost() > elements.cost()) return {};
      double worst = 0.0;
      for (const Sample& s : samples)
        worst = std::max(worst, greatest_difference(scene, modes.run(s.train, {s.speed, {}}), s.result));
      if (worst > search::share_of_truncation * scene.accuracy) continue;
      notes.push_back(fmt::format(
          "{} modes instead of the elements: the omitted modes change the peaks of {} runs by at most {:.1g}; "
          "-model_modes 0 selects the elements",
          number, samples.size(), worst));
      return {number, worst};
    }
  } catch (const Error&) {
    // A floating bridge, too few modes, or a failing run: the sweep itself reports the error.
  }
  return {};
}

std::optional<QuickerModes> quicker_modes(const Scene& scene) {
  if (!modes_allowed(scene) || scene.model.modes > 0) return std::nullopt;
  try {
    std::vector<std::string> ignored;
    const SharedBeam shared(PETSC_COMM_SELF, scene, ignored);
    if (shared.beam->mesh().nodes() > max_nodes) return std::nullopt;
    const QuickerModes required = required_modes(*shared.beam);
    Scene by_modes = scene;
    by_modes.model.modes = required.modes;
    const CaseRunner runner(by_modes, ignored);
    return QuickerModes{required.modes, required.frequency, runner.cost_of_all()};
  } catch (const Error&) {
    return std::nullopt;  // for example a floating bridge
  }
}

}  // namespace traverse::app
