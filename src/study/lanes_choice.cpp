#include "study/lanes_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>

#include "accuracy/accuracy.hpp"
#include "accuracy/first_guess.hpp"
#include "accuracy/horizon.hpp"
#include "accuracy/trials.hpp"
#include "lanes/speed_class.hpp"
#include "results/stage.hpp"
#include "run/deck_acceleration.hpp"
#include "study/lane_search.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

using lanes::CrossingResult;
using Errors = LaneErrors;

constexpr std::size_t fewest_runs = 4, trial_lanes = 4;
constexpr std::size_t most_spans_alone = 8;  // each wants some sixteen modes
constexpr double finest_alone = 3e-4;        // accuracy: errors of the kernel itself have been 3e-4 of a moment
// Times its speed: the trials of a single run, whose peaks may agree by chance.
constexpr std::array beside = {1.0, 1.01, 1.02, 1.03};
constexpr double part_of_all = 0.95;  // of the wanted error
constexpr int most_tries = 6;
constexpr double modes_over_wholes = 0.5;  // of the wanted error
constexpr int most_modes_alone = 84;       // elements take less
constexpr int modes_of_a_check = 30;       // at least: few modes may agree on what they all leave out
constexpr double shorter = 0.7;            // a quarter of an error of fourth order
constexpr double longer = 1.4;
constexpr double part_for_forces = 0.5;  // of steps that follow the contacts: forces of longer ones agree by chance
// Of the swing of a wheel's force that passes a corner too late: what peaks have of it, as measured.
constexpr std::array<double, quantities> part_of_swing = {0.1, 2.0, 0.1, 0.4, 0.1};

bool open(const Scene& scene) {
  return !scene.vehicles.empty() && scene.train.courses.empty() && !scene.time_step && scene.modes_open &&
         scene.vehicle_model != VehicleModel::full && scene.beam && options::in_force().find("ts_type") == nullptr;
}

/// Whether a single run is left open, and of a kind that the lanes' kernel takes: what is fixed is judged by the search
/// by elements.
bool open_alone(const Scene& scene) {
  return open(scene) && scene.mesh_open && scene.step_lanes && scene.analysis == Analysis::transient &&
         !scene.beam->track && scene.train.steady() && scene.accuracy >= finest_alone &&
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

/// How far the chosen model is from the elements and the mechanisms themselves, at one speed.
Errors off_the_elements(const LaneTrials& trials, const LaneModel& model, const CrossingResult& lane, double speed,
                        double distance) {
  Scene scene = with(trials.scene(), model);
  scene.sweep.reset();
  scene.model_modes = 0;
  scene.vehicle_model = VehicleModel::full;
  scene.train.speed = speed;
  scene.end_time = distance / speed;
  scene.output.interval = 32.0 * model.step;
  const Peaks peaks = peaks_of(PETSC_COMM_SELF, scene).peaks;
  CrossingResult by_elements = lane;
  const auto take = [&](std::vector<lanes::CrossingPeak>& to, Quantity q) {
    for (std::size_t p = 0; p < to.size(); ++p) to[p].value = std::abs(peaks.largest_of_each(q)[p].value);
  };
  take(by_elements.deflection, deflection);
  take(by_elements.acceleration, acceleration);
  take(by_elements.moment, moment);
  take(by_elements.low_passed, low_passed);
  by_elements.greatest_force = std::abs(peaks.largest(wheel_force).value);
  return difference(trials.scene(), {lane}, {by_elements});
}

std::string words_of(const Scene& scene, const Errors& errors) {
  std::string words;
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene, q))
      words += fmt::format("{}{} {:.1g}", words.empty() ? "" : ", ", quantity_names[q], errors[q]);
  return words;
}

std::string words_of(const Scene& scene, const std::array<Promise, quantities>& promises) {
  Errors errors{};
  for (std::size_t q = 0; q < quantities; ++q) errors[q] = promises[q].expected;
  return words_of(scene, errors);
}

/// Where wheels of a train have their trials: groups of speeds, m/s.
struct TrialSpeeds {
  std::vector<std::vector<double>> beginnings, mixed, wholes;  // mixed: none where the beginnings serve for them
};

/// A choice on the way, or why there is none.
struct NotChosen {
  std::string why;
};

/// Chooses by trial runs of a scene with a sweep.
class Chooser {
 public:
  /// alone: of a single passage, not of a sweep.
  Chooser(const Scene& scene, const TrialSpeeds& speeds, bool alone) : scene_(scene), fastest_(scene), alone_(alone) {
    fastest_.train.speed = scene.sweep->speeds.back();
    for (const double x : wheels_at_start(fastest_)) whole_ = std::max(whole_, scene.beam->length() - x);
    whole_ += scene.tail.value_or(0.0) * fastest_.train.speed;
    if (scene.end_time) whole_ = *scene.end_time * fastest_.train.speed;
    distance_ = beginning(fastest_, whole_ / fastest_.train.speed) * fastest_.train.speed;
    if (asks_for(scene, low_passed))
      distance_ = std::min(whole_, distance_ + unsettled_end(*scene.output.low_pass) * fastest_.train.speed);
    const Scene part = shortened(fastest_, distance_ / fastest_.train.speed);
    beginnings_.emplace(part, speeds.beginnings, distance_);
    if (!speeds.mixed.empty()) mixed_.emplace(part, speeds.mixed, distance_);
    wholes_.emplace(scene, speeds.wholes, whole_, &*beginnings_);
  }

  LanesChoice choose() {
    LaneSearch search(*beginnings_, mixed_ ? *mixed_ : *beginnings_, scene_.accuracy);
    // The peaks of one passage may agree by chance where steps do not follow the contacts. Elements, which serve then,
    // take shorter steps for accelerations.
    const bool forces_alone = asks_for_forces_alone(scene_),
               follows = alone_ && (asks_for(scene_, low_passed) || forces_alone);
    const double part = forces_alone ? part_for_forces : 1.0;
    const double longest =
        follows ? part * longest_following_contacts(scene_) : std::numeric_limits<double>::infinity();
    const LaneModel first = search.first(whole_ / fastest_.train.speed, longest);
    check_corners(beginnings_->run(first), {});
    take(search.run(first));
    if (lose_contact(beginnings_->run(model_))) throw NotChosen{"wheels lose contact"};
    const double defect = beginnings_->defect(model_);
    if (scene_.vehicle_model == VehicleModel::automatic && defect > most_defect(scene_))
      throw NotChosen{fmt::format("linear vehicles are out of balance by {:.1g} of their weights", defect)};
    Errors errors = check_wholes(search);
    for (std::size_t q = 0; q < quantities; ++q)
      if (asks_for(scene_, q)) errors[q] += defect;
    errors = check_corners(wholes_->run(model_), errors);
    LanesChoice choice;
    choice.scene = with(scene_, model_);
    for (std::size_t q = 0; q < quantities; ++q) {
      const bool kept = asks_for(scene_, q);
      choice.promises[q] = {true, kept, errors[q], kept ? "" : not_asked_for};
    }
    if (scene_.vehicle_model == VehicleModel::automatic) choice.scene.most_defect = most_defect(scene_);
    choice.scene.step_probes = true;
    return choice;
  }

  /// How far the model is from the elements and the mechanisms themselves in the last trial.
  Errors off_the_elements(double speed) {
    return app::off_the_elements(*beginnings_, model_, beginnings_->run(model_).back(), speed, distance_);
  }
  const LaneModel& model() const { return model_; }
  std::size_t trials() const { return beginnings_->trials() + wholes_->trials(); }
  double horizon() const { return distance_ / fastest_.train.speed; }  // s: of the beginnings

 private:
  /// Errors with those of corners of the surface, at the bridge's ends, joints and hinges: the kernel has wheels pass
  /// them when they would if they had not moved along the track by d, and in a time of d/v they are pressed down by the
  /// corner's angle times d/2. Throws NotChosen where that is too much.
  Errors check_corners(const std::vector<CrossingResult>& runs, Errors errors) const {
    double edge = 0.0;
    for (const CrossingResult& run : runs) edge = std::max(edge, run.edge);
    const beam::BeamModel& beam = *scene_.beam;
    const bool plain = beam.hinges.empty() && beam.cracks.empty() &&
                       std::ranges::all_of(beam.joints, [](auto j) { return j == beam::Joint::continuous; });
    const double angles = plain ? 1.0 : 2.0;  // of the slopes on both sides
    const double swing = swing_after_a_push(scene_) * 0.5 * angles * edge / scene_.sweep->speeds.front();
    for (std::size_t q = 0; q < quantities; ++q)
      if (asks_for(scene_, q)) errors[q] += part_of_swing[q] * swing;
    if (greatest(errors) > scene_.accuracy) throw NotChosen{"wheels pass the corners of the surface at other times"};
    return errors;
  }

  void take(const std::optional<LaneModel>& found) {
    if (!found) throw NotChosen{"the peaks do not settle to the accuracy by modes"};
    model_ = *found;
  }

  /// Whole passages: errors add up while the train crosses, and what stirs higher modes may come late. Against more
  /// modes, by esdirk4: genalpha takes all vibration out of wheels in time, and two of its steps may agree on that. Of
  /// a sweep with half the step; of a single passage, which should not cost several, a longer step tells the rest,
  /// whose change is more than the error where that falls with the second power or faster.
  Errors check_wholes(LaneSearch& search) {
    Errors errors{};
    for (int i = 0; i <= most_tries; ++i) {
      LaneModel other = search.with_more_modes(model_);
      while (alone_ && other.modes < modes_of_a_check) other = search.with_more_modes(other);
      other.method = structure::find_method("esdirk4");
      if (!alone_) other.step *= 0.5;
      const LaneModel& same_method = model_.method == other.method ? model_ : other;
      LaneModel slower = same_method;
      if (alone_) slower.step *= longer;  // else the same, which is known
      wholes_->run_at_once(std::array{other, model_, slower});
      errors = difference(scene_, wholes_->run(model_), wholes_->run(other));
      const Errors by_steps = difference(scene_, wholes_->run(same_method), wholes_->run(slower));
      for (std::size_t q = 0; q < quantities; ++q) errors[q] += by_steps[q];
      if (asks_for_forces_alone(scene_)) errors[wheel_force] *= of_the_change;
      for (std::size_t q = 0; q < quantities; ++q)
        errors[q] = std::max(errors[q], search.error_of_model(q) + search.error_of_steps(q));
      if (greatest(errors) <= part_of_all * scene_.accuracy) {
        if (lose_contact(wholes_->run(model_))) throw NotChosen{"wheels lose contact"};
        return errors;
      }
      refine(search, other);
    }
    throw NotChosen{fmt::format("over whole passages errors add up to {}", words_of(scene_, errors))};
  }

  /// By more modes where it is these that the other one differs by, else by shorter steps.
  void refine(LaneSearch& search, const LaneModel& other) {
    LaneModel same_modes = other;
    same_modes.modes = model_.modes;
    same_modes.elements = model_.elements;
    const Errors by_modes = difference(scene_, wholes_->run(same_modes), wholes_->run(other));
    if (greatest(by_modes) <= modes_over_wholes * scene_.accuracy) {
      model_.step *= shorter;
      return;
    }
    if (alone_ && other.modes > most_modes_alone) throw NotChosen{"whole passages ask for too many modes"};
    model_.modes = other.modes;
    model_.elements = other.elements;
    model_.method = structure::find_method("esdirk4");
    take(search.with_steps(model_));
  }

  const Scene& scene_;
  Scene fastest_;
  bool alone_;
  double whole_ = 0.0, distance_ = 0.0;  // m: of a passage, of its beginning
  std::optional<LaneTrials> beginnings_, mixed_, wholes_;
  LaneModel model_;
};

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
  TrialSpeeds trials = {some_speeds(speeds, {0.0, 1.0}, trial_lanes), {}, some_speeds(speeds, {0.5}, lanes::widest)};
  if (n > 0) trials.mixed = {{speeds[0], speeds[n / 3], speeds[2 * n / 3], speeds[n]}};
  try {
    Chooser chooser(given, trials, false);
    LanesChoice choice = chooser.choose();
    const Errors off = chooser.off_the_elements(some_speeds(speeds, {1.0}, trial_lanes).back().back());
    if (greatest(off) > given.accuracy)
      return refuse(fmt::format("a run by elements with the mechanisms differs by {}", words_of(given, off)));
    notes.push_back(
        fmt::format("{}: {} modes from {} elements a span, linear vehicles, {} with steps of {:g} s or less ({})",
                    given.limits.empty() ? "runs go side by side" : "by modes", chooser.model().modes,
                    mesh_of(choice.scene), chooser.model().method->name, chooser.model().step, lanes::instructions()));
    notes.push_back("expected errors of the peaks: " + words_of(given, choice.promises));
    notes.push_back(fmt::format("a run by elements with the mechanisms differs by {}", words_of(given, off)));
    return choice;
  } catch (const NotChosen& none) {
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
  scene.sweep.emplace();
  for (const double part : beside) scene.sweep->speeds.push_back(part * given.train.speed);
  const std::vector<std::vector<double>> speeds = some_speeds(scene.sweep->speeds, {0.0}, trial_lanes);
  try {
    Chooser chooser(scene, {speeds, {}, {{given.train.speed}}}, true);
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
    if (asks_for(given, acceleration) && !choice.promises[acceleration].kept) {
      choice.promises[acceleration].why_not = no_sum;
      notes.push_back(not_promised(acceleration, choice.promises[acceleration]));
    }
    return choice;
  } catch (const NotChosen&) {
  } catch (const LaneTrials::Refused&) {
  } catch (const Error&) {  // which the run itself will meet
  }
  return std::nullopt;
}

}  // namespace traverse::app
