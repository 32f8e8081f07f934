// Selects the speeds of trial passages, and repeats the search with half the accuracy if the errors of the first search
// were too large.
#include "error_control/batch_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/processor.hpp"
#include "engine/speed_class.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/batch_choice.hpp"
#include "error_control/trial_runs.hpp"
#include "results/stage.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {
namespace {

constexpr std::size_t min_runs = 4, trial_lanes = 4;
// Share of the accuracy in the first and the second search.
constexpr std::array shares = {1.0, 0.5};

bool open(const scene::Scene& scene) {
  return !scene.vehicles.empty() && scene.train.courses.empty() && !scene.model.step && scene.model.modes == 0 &&
         scene.mesh_open && scene.model.vehicles != scene::VehicleModel::full && scene.beam &&
         scene.find_option("ts_type") == nullptr;
}

/// Groups of at most `most` neighbouring speeds of one step group, around each of the given relative positions in
/// `speeds`.
std::vector<std::vector<double>> speeds_around(const std::vector<double>& speeds, std::initializer_list<double> places,
                                               std::size_t most) {
  std::vector<std::vector<double>> groups;
  for (const double place : places) {
    const auto at = static_cast<std::size_t>(place * static_cast<double>(speeds.size() - 1));
    const int number = engine::speed_class(speeds[at]);
    std::vector<double> group;
    for (std::size_t i = at; i < speeds.size() && group.size() < most; ++i)
      if (engine::speed_class(speeds[i]) == number) group.push_back(speeds[i]);
    for (std::size_t i = at; i > 0 && group.size() < most; --i)
      if (engine::speed_class(speeds[i - 1]) == number) group.push_back(speeds[i - 1]);
    std::sort(group.begin(), group.end());
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  return groups;
}

std::string text_of(const scene::Scene& scene, const std::array<ErrorEstimate, run::quantities>& estimates) {
  PeakErrors errors{};
  for (std::size_t q = 0; q < run::quantities; ++q) errors[q] = estimates[q].expected;
  return error_control::text_of(scene, errors);
}

TrialSpeeds trial_speeds(const std::vector<double>& speeds) {
  const std::size_t n = speeds.size() - 1;
  TrialSpeeds trials = {
      speeds_around(speeds, {0.0, 1.0}, trial_lanes), {}, speeds_around(speeds, {0.5}, engine::widest)};
  if (n > 0) trials.mixed = {{speeds[0], speeds[n / 3], speeds[2 * n / 3], speeds[n]}};
  return trials;
}

}  // namespace

std::optional<Choice> choose_batch_model(const scene::Scene& given, std::vector<std::string>& notes) {
  const std::vector<double>& speeds = given.sweep->speeds;
  if (!open(given) || given.sweep->lanes == 0 || std::max(given.sweep->runs, speeds.size()) < min_runs)
    return std::nullopt;
  const results::Stage stage("batched trial runs");
  const options::WithoutMonitors without_monitors;
  const auto reject = [&](const std::string& why) {
    notes.push_back("batched trial runs found no common mesh and step: " + why);
  };
  scene::Scene scene = given;
  for (const double share : shares) {
    scene.accuracy = share * given.accuracy;
    if (share < 1.0) notes.push_back(fmt::format("second search, with an accuracy of {:g}:", scene.accuracy));
    try {
      BatchChoice chooser(scene, trial_speeds(speeds));
      Choice choice = chooser.choose();
      notes.push_back(fmt::format("batched runs: {} elements a span, linear vehicles, {} with steps of {:g} s or less",
                                  choice.model.elements, choice.model.method, *choice.model.step));
      notes.push_back("estimated errors of the peaks: " + text_of(given, choice.accuracy.estimates));
      return choice;
    } catch (const BatchChoice::NotChosen& none) {
      reject(none.why);
      if (!none.not_converged) return std::nullopt;
    } catch (const BatchTrialRuns::Refused& refused) {
      reject(refused.why);
      return std::nullopt;
    } catch (const Error& failed) {
      reject(failed.what());  // the single runs will report this error too, if it is their own
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace traverse::error_control
