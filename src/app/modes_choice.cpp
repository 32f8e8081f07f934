#include "modes_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "case_runner.hpp"
#include "traverse/options/input.hpp"
#include "traverse/results/stage.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t runs_a_sample = 10, most_samples = 9, least_runs = 2 * runs_a_sample;
constexpr double share = 0.25;  // of the wanted error: other runs may be off by more

/// The largest difference of a peak at any probe, relative to the largest peak of its kind.
double difference(const CaseResult& modes, const CaseResult& elements) {
  double worst = 0.0;
  for (const auto quantity :
       {&integrate::ProbePeaks::deflection, &integrate::ProbePeaks::acceleration, &integrate::ProbePeaks::moment}) {
    double apart = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < elements.peaks.size(); ++p) {
      const double value = (elements.peaks[p].*quantity).value;
      apart = std::max(apart, std::abs((modes.peaks[p].*quantity).value - value));
      largest = std::max(largest, value);
    }
    if (largest > 0.0) worst = std::max(worst, apart / largest);
  }
  return worst;
}

bool worth_trying(const Scene& scene, const Accuracy& accuracy) {
  if (!scene.modes_open || !accuracy.measured || !scene.vehicles.empty() || scene.load.forces.empty()) return false;
  if (scene.beam->track || scene.beam->foundation.nonlinear() || options::in_force().find("ts_type") != nullptr)
    return false;
  for (const Quantity q : {deflection, acceleration, moment})
    if (!accuracy.promises[q].kept) return false;
  return scene.sweep->speeds.size() * std::max<std::size_t>(1, scene.sweep->loads.size()) >= least_runs;
}

struct Sample {
  std::size_t train;
  double speed;
  CaseResult result;
};

/// Runs by elements of all trains in turn, from the slowest to the fastest.
std::vector<Sample> some_runs(CaseRunner& elements) {
  const std::vector<double>& speeds = elements.speeds();
  const std::size_t count = std::min(most_samples, speeds.size() * elements.trains() / runs_a_sample);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double speed = speeds[i * (speeds.size() - 1) / (count - 1)];
    samples.push_back({i % elements.trains(), speed, elements.run(i % elements.trains(), speed)});
  }
  return samples;
}

}  // namespace

int modes_that_do(const Scene& scene, const Accuracy& accuracy, std::vector<std::string>& notes) {
  if (!worth_trying(scene, accuracy)) return 0;
  const options::WithoutMonitors without_monitors;
  const results::Stage stage("trial runs by modes and by elements");
  try {
    std::vector<std::string> ignored;
    CaseRunner elements(scene, ignored);
    const std::vector<Sample> samples = some_runs(elements);
    Scene by_modes = scene;
    for (const int number : {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
      by_modes.model_modes = number;
      CaseRunner modes(by_modes, ignored);
      if (modes.cost() > elements.cost()) return 0;
      double worst = 0.0;
      for (const Sample& s : samples) worst = std::max(worst, difference(modes.run(s.train, s.speed), s.result));
      if (worst > share * scene.accuracy) continue;
      notes.push_back(fmt::format(
          "{} modes instead of the elements: what is left out changes the peaks of {} runs by at most {:.1g}; "
          "-model_modes 0 keeps the elements",
          number, samples.size(), worst));
      return number;
    }
  } catch (const Error&) {
    // Dampers or springs that couple modes, not so many modes, or a run that fails: the sweep itself will say so.
  }
  return 0;
}

}  // namespace traverse::app
