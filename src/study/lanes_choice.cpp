#include "study/lanes_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "accuracy/accuracy.hpp"
#include "accuracy/first_guess.hpp"
#include "accuracy/trials.hpp"
#include "lanes/speed_class.hpp"
#include "results/stage.hpp"
#include "study/lane_chooser.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t fewest_runs = 4, trial_lanes = 4;
constexpr std::size_t most_spans_alone = 8;  // each wants some sixteen modes
// Accuracies below which a single run goes by elements, as the kernel's own errors count: on level tracks, on others.
constexpr double finest_alone = 1e-4, finest_on_slopes = 3e-4;
// Times its speed: the trials of a single run, whose peaks may agree by chance; as many as go side by side.
constexpr std::array beside = {1.0, 1.01, 1.02, 1.03, 0.99, 0.98, 0.97};

bool open(const Scene& scene) {
  return !scene.vehicles.empty() && scene.train.courses.empty() && !scene.time_step && scene.modes_open &&
         scene.vehicle_model != VehicleModel::full && scene.beam && options::in_force().find("ts_type") == nullptr;
}

/// Whether a single run is left open, and of a kind that the lanes' kernel takes: what is fixed is judged by the search
/// by elements.
bool open_alone(const Scene& scene) {
  return open(scene) && scene.mesh_open && scene.step_lanes && scene.analysis == Analysis::transient &&
         !scene.beam->track && scene.train.steady() &&
         scene.accuracy >= (scene.profile.level() ? finest_alone : finest_on_slopes) &&
         scene.beam->spans.size() <= most_spans_alone && own_measure() == nullptr;
}

/// Neighbouring speeds of one class around each of the given places among all.
std::vector<std::vector<double>> some_speeds(const std::vector<double>& speeds, std::initializer_list<double> places,
                                             std::size_t most) {
  std::vector<std::vector<double>> groups;
  for (const double place : places) {
    const auto at = static_cast<std::size_t>(place * static_cast<double>(speeds.size() - 1));
    const int number = lanes::speed_class(speeds[at]);
    std::vector<double> group;
    for (std::size_t i = at; i < speeds.size() && group.size() < most; ++i)
      if (lanes::speed_class(speeds[i]) == number) group.push_back(speeds[i]);
    for (std::size_t i = at; i > 0 && group.size() < most; --i)
      if (lanes::speed_class(speeds[i - 1]) == number) group.push_back(speeds[i - 1]);
    std::sort(group.begin(), group.end());
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  return groups;
}

std::string words_of(const Scene& scene, const std::array<Promise, quantities>& promises) {
  LaneErrors errors{};
  for (std::size_t q = 0; q < quantities; ++q) errors[q] = promises[q].expected;
  return words_of(scene, errors);
}

/// What a single run is asked for and can be judged by.
std::vector<std::string> judged_alone(const Scene& scene) {
  std::vector<std::string> judged;
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene, q) && (q != acceleration || damps_high_modes(scene))) judged.emplace_back(stored_names[q]);
  return judged;
}

}  // namespace

std::optional<LanesChoice> lanes_that_do(const Scene& given, std::vector<std::string>& notes) {
  const std::vector<double>& speeds = given.sweep->speeds;
  if (!open(given) || given.sweep->lanes == 0 || std::max(given.sweep->runs, speeds.size()) < fewest_runs)
    return std::nullopt;
  const results::Stage stage("trial runs side by side");
  const options::WithoutMonitors without_monitors;
  const auto refuse = [&](const std::string& why) {
    notes.push_back("runs go one by one, not side by side by modes: " + why);
    return std::nullopt;
  };
  const std::size_t n = speeds.size() - 1;
  TrialSpeeds trials = {some_speeds(speeds, {0.0, 1.0}, trial_lanes), {}, some_speeds(speeds, {0.5}, engine::widest)};
  if (n > 0) trials.mixed = {{speeds[0], speeds[n / 3], speeds[2 * n / 3], speeds[n]}};
  try {
    LaneChooser chooser(given, trials, false);
    LanesChoice choice = chooser.choose();
    const LaneErrors off = chooser.off_the_elements(some_speeds(speeds, {1.0}, trial_lanes).back().back());
    if (greatest(off) > given.accuracy)
      return refuse(fmt::format("a run by elements with the mechanisms differs by {}", words_of(given, off)));
    notes.push_back(
        fmt::format("{}: {} modes from {} elements a span, linear vehicles, {} with steps of {:g} s or less ({})",
                    given.limits.empty() ? "runs go side by side" : "by modes", chooser.model().modes,
                    mesh_of(choice.scene), chooser.model().method->name, chooser.model().step, engine::instructions()));
    notes.push_back("expected errors of the peaks: " + words_of(given, choice.promises));
    notes.push_back(fmt::format("a run by elements with the mechanisms differs by {}", words_of(given, off)));
    return choice;
  } catch (const LaneChooser::NotChosen& none) {
    return refuse(none.why);
  } catch (const LaneTrials::Refused& refused) {
    return refuse(refused.why);
  } catch (const Error& failed) {
    return refuse(failed.what());  // the runs one by one will say so too, if it is theirs
  }
}

std::optional<LanesChoice> lanes_for_one(const Scene& given, std::vector<std::string>& notes) {
  if (!open_alone(given)) return std::nullopt;
  const results::Stage stage("trial runs");
  const options::WithoutMonitors without_monitors;
  const auto begin = std::chrono::steady_clock::now();
  Scene scene = given;
  scene.accuracy_of = judged_alone(given);
  if (scene.accuracy_of.empty()) return std::nullopt;
  for (std::size_t q = 0; q < quantities; ++q)
    if (by_elements_alone(q) && asks_for(given, q)) return std::nullopt;
  scene.sweep.emplace();
  std::vector<double>& speeds = scene.sweep->speeds;
  for (const double part : beside)
    if (speeds.size() < trial_lanes &&
        lanes::speed_class(part * given.train.speed) == lanes::speed_class(given.train.speed))
      speeds.push_back(part * given.train.speed);
  std::sort(speeds.begin(), speeds.end());
  try {
    LaneChooser chooser(scene, {{speeds}, {}, {{given.train.speed}}}, true);
    LanesChoice choice = chooser.choose();
    if (!follows_contacts(given, chooser.model().step)) return std::nullopt;  // peaks may agree by chance
    choice.scene.sweep.reset();
    choice.scene.accuracy_of = given.accuracy_of;
    choice.scene.integrator = chooser.model().method->name;
    const double speed = given.train.speed;
    choice.scene.time_step =
        chooser.model().step * lanes::speed_of_class(lanes::speed_class(speed)) / speed;  // as tried
    notes.push_back(fmt::format(
        "accuracy {:g}: {} elements a span, of these {} modes, linear vehicles, {} with steps of {:g} s; {} trial runs "
        "of {:.3g} s took {:.2g} s",
        given.accuracy, mesh_of(choice.scene), chooser.model().modes, chooser.model().method->name,
        *choice.scene.time_step, chooser.trials(), chooser.horizon(),
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
    notes.push_back("expected errors of the peaks: " + words_of(scene, choice.promises));
    choice.promises[shear_force].why_not = not_by_modes;
    if (is_welcome(given, shear_force)) notes.push_back(not_promised(shear_force, choice.promises[shear_force]));
    if (asks_for(given, acceleration) && !choice.promises[acceleration].kept) {
      choice.promises[acceleration].why_not = no_sum;
      notes.push_back(not_promised(acceleration, choice.promises[acceleration]));
    }
    return choice;
  } catch (const LaneChooser::NotChosen&) {
  } catch (const LaneTrials::Refused&) {
  } catch (const Error&) {  // which the run itself will meet
  }
  return std::nullopt;
}

}  // namespace traverse::app
