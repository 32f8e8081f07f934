// Increases the number of modes until twice as many hardly change the peaks of sample runs, and compares two of these
// with runs by elements. Runs by modes are exact in time, so that their only error is that of the omitted modes. The
// cost by modes is estimated with the modes that EN 1990, A2.4.4.2.1 requires.
#include "error_control/mode_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "ensemble/case_runner.hpp"
#include "error_control/peak_errors.hpp"
#include "error_control/search_constants.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {

using ensemble::CaseResult;
using scene::Scene;

namespace {

constexpr std::size_t runs_per_sample = 10, max_samples = 9, min_runs = 2 * runs_per_sample;
constexpr std::size_t samples_by_elements = 2;
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

/// The largest relative difference of the controlled peaks: of all, or of those whose error by elements is within the
/// accuracy.
double greatest_difference(const Scene& scene, const CaseResult& one, const CaseResult& other,
                           const Accuracy* accuracy = nullptr) {
  PeakErrors errors = difference(scene, one, other);
  if (is_controlled(scene, run::low_passed)) errors[run::low_passed] = difference_low_passed(scene, one, other);
  for (std::size_t q = 0; q < run::quantities; ++q)
    if (accuracy != nullptr && !accuracy->estimates[q].accepted) errors[q] = 0.0;
  return greatest(errors);
}

/// Whether modes are allowed for the scene. read_modal has the same conditions.
bool modes_allowed(const Scene& scene) {
  return scene.vehicles.empty() && !scene.load.forces.empty() && scene.load.courses.empty() && !scene.beam->track &&
         !scene.beam->foundation.nonlinear() && !scene.beam->strained() && scene.find_option("ts_type") == nullptr;
}

bool is_worth_trying(const Scene& scene, const Accuracy& accuracy) {
  if (!scene.modes_open || !accuracy.measured || !modes_allowed(scene)) return false;
  for (const run::Quantity q : {run::deflection, run::moment, run::low_passed})
    if (is_controlled(scene, q) && !accuracy.estimates[q].accepted) return false;
  return scene.sweep->speeds.size() * std::max<std::size_t>(1, scene.sweep->loads.size()) >= min_runs;
}

/// A passage of the sweep.
struct Sample {
  std::size_t train;
  double speed;
};

/// Passages from the slowest to the fastest speed, over all trains in turn.
std::vector<Sample> samples_of(const ensemble::CaseRunner& runner, std::size_t most) {
  const std::vector<double>& speeds = runner.speeds();
  const std::size_t count = std::min(most, speeds.size() * runner.trains() / runs_per_sample);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back({i % runner.trains(), speeds[i * (speeds.size() - 1) / (count - 1)]});
  return samples;
}

std::vector<CaseResult> run_all(ensemble::CaseRunner& runner, const std::vector<Sample>& samples) {
  std::vector<CaseResult> results;
  for (const Sample& s : samples) results.push_back(runner.run(s.train, {s.speed, {}}));
  return results;
}

/// Passages by numbers of modes, each computed once.
class ModalSamples {
 public:
  explicit ModalSamples(Scene scene) : scene_(std::move(scene)) {}

  ensemble::CaseRunner& runner(int modes) {
    std::unique_ptr<ensemble::CaseRunner>& runner = runners_[modes];
    scene_.model.modes = modes;
    if (!runner) runner = std::make_unique<ensemble::CaseRunner>(scene_, ignored_);
    return *runner;
  }
  const std::vector<CaseResult>& results(int modes) {
    std::vector<CaseResult>& results = results_[modes];
    if (results.empty()) results = run_all(runner(modes), samples_of(runner(modes), max_samples));
    return results;
  }

 private:
  Scene scene_;
  std::vector<std::string> ignored_;
  std::map<int, std::unique_ptr<ensemble::CaseRunner>> runners_;
  std::map<int, std::vector<CaseResult>> results_;
};

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
    ensemble::CaseRunner elements(scene, ignored);
    ModalSamples by_modes(scene);
    for (const int number : {2, 3, 4, 6, 8, 12, 16, 24, 32}) {
      if (by_modes.runner(2 * number).cost() > elements.cost()) return {};
      const std::vector<CaseResult>&some = by_modes.results(number), &more = by_modes.results(2 * number);
      double worst = 0.0;
      for (std::size_t i = 0; i < some.size(); ++i)
        worst = std::max(worst, greatest_difference(scene, some[i], more[i]));
      if (worst > search::share_of_truncation * scene.accuracy) continue;
      for (const Sample& s : samples_of(elements, samples_by_elements)) {
        const CaseResult one = by_modes.runner(number).run(s.train, {s.speed, {}});
        if (greatest_difference(scene, one, elements.run(s.train, {s.speed, {}}), &accuracy) > scene.accuracy)
          return {};
      }
      notes.push_back(fmt::format(
          "{} modes instead of the elements: the omitted modes change the peaks of {} runs by at most {:.1g}; "
          "-model_modes 0 selects the elements",
          number, some.size(), worst));
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
    const run::SharedBeam shared(PETSC_COMM_SELF, scene, ignored);
    if (shared.beam->mesh().nodes() > max_nodes) return std::nullopt;
    const QuickerModes required = required_modes(*shared.beam);
    Scene by_modes = scene;
    by_modes.model.modes = required.modes;
    const ensemble::CaseRunner runner(by_modes, ignored);
    return QuickerModes{required.modes, required.frequency, runner.cost_of_all()};
  } catch (const Error&) {
    return std::nullopt;  // for example a floating bridge
  }
}

}  // namespace traverse::error_control
