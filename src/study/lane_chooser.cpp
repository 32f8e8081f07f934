#include "study/lane_chooser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/accuracy.hpp"
#include "accuracy/first_guess.hpp"
#include "accuracy/horizon.hpp"
#include "accuracy/trials.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::app {

using lanes::CrossingResult;
using Errors = LaneErrors;

namespace {

constexpr double part_of_all = 0.95, part_of_corners = 0.5;  // of the wanted error
constexpr int most_tries = 6;
constexpr double modes_over_wholes = 0.5;  // of the wanted error
constexpr int most_modes = 84;             // with more, elements take less
constexpr double shorter = 0.7;            // a quarter of an error of fourth order
// What is left in the peaks, as measured, of the swing that a wheel's force would have after a corner if the kernel did
// not make up for when the wheel passes it.
constexpr std::array<double, quantities> part_of_swing = {0.02, 0.4, 0.02, 0.1, 0.02};

}  // namespace

std::string words_of(const Scene& scene, const Errors& errors) {
  std::string words;
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene, q))
      words += fmt::format("{}{} {:.1g}", words.empty() ? "" : ", ", quantity_names[q], errors[q]);
  return words;
}

LaneChooser::LaneChooser(const Scene& scene, const TrialSpeeds& speeds) : scene_(scene), fastest_(scene) {
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

LanesChoice LaneChooser::choose() {
  LaneSearch search(*beginnings_, mixed_ ? *mixed_ : *beginnings_, scene_.accuracy, most_modes);
  const LaneModel first = search.first(whole_ / fastest_.train.speed);
  if (greatest(left_by_corners(beginnings_->run(first))) > part_of_corners * scene_.accuracy)
    throw NotChosen{"wheels pass the corners of the surface at other times"};
  take(search.run(first));
  if (lose_contact(beginnings_->run(model_))) throw NotChosen{"wheels lose contact"};
  const double defect = beginnings_->defect(model_);
  if (scene_.vehicle_model == VehicleModel::automatic && defect > most_defect(scene_))
    throw NotChosen{fmt::format("linear vehicles are out of balance by {:.1g} of their weights", defect)};
  Errors errors = check_wholes(search);
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene_, q)) errors[q] += defect;
  LanesChoice choice;
  choice.scene = with(scene_, model_);
  for (std::size_t q = 0; q < quantities; ++q) {
    const bool kept = asks_for(scene_, q);
    const bool present = !by_elements_alone(q) || q == shear_force;
    choice.promises[q] = {present, kept, errors[q], kept ? "" : why_not_asked(scene_, q)};
  }
  if (scene_.vehicle_model == VehicleModel::automatic) choice.scene.most_defect = most_defect(scene_);
  choice.scene.step_probes = true;
  choice.scene.contact_seats = true;
  return choice;
}

LaneErrors LaneChooser::left_by_corners(const std::vector<CrossingResult>& runs) const {
  double edge = 0.0;
  for (const CrossingResult& run : runs) edge = std::max(edge, run.edge);
  const double swing = swing_after_a_push(scene_) * 0.5 * edge / scene_.sweep->speeds.front();
  Errors errors{};
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene_, q)) errors[q] = part_of_swing[q] * swing;
  return errors;
}

void LaneChooser::take(const std::optional<LaneModel>& found) {
  if (!found) throw NotChosen{"the peaks do not settle to the accuracy by modes"};
  model_ = *found;
}

LaneErrors LaneChooser::check_wholes(LaneSearch& search) {
  Errors errors{};
  for (int i = 0; i <= most_tries; ++i) {
    LaneModel other = search.with_more_modes(model_);
    other.method = structure::find_method("esdirk4");
    other.step *= 0.5;
    wholes_->run_at_once(std::array{other, model_});
    errors = difference(scene_, wholes_->run(model_), wholes_->run(other));
    if (asks_for_forces_alone(scene_)) errors[wheel_force] *= of_the_change;
    const Errors corners = left_by_corners(wholes_->run(model_));
    for (std::size_t q = 0; q < quantities; ++q)
      errors[q] = std::max(errors[q], search.error_of_model(q) + search.error_of_steps(q)) + corners[q];
    if (greatest(errors) <= part_of_all * scene_.accuracy) {
      if (lose_contact(wholes_->run(model_))) throw NotChosen{"wheels lose contact"};
      return errors;
    }
    refine(search, other);
  }
  throw NotChosen{fmt::format("over whole passages errors add up to {}", words_of(scene_, errors))};
}

void LaneChooser::refine(LaneSearch& search, const LaneModel& other) {
  LaneModel same_modes = other;
  same_modes.modes = model_.modes;
  same_modes.elements = model_.elements;
  const Errors by_modes = difference(scene_, wholes_->run(same_modes), wholes_->run(other));
  if (greatest(by_modes) <= modes_over_wholes * scene_.accuracy) {
    model_.step *= shorter;
    return;
  }
  model_.modes = other.modes;
  model_.elements = other.elements;
  model_.method = structure::find_method("esdirk4");
  take(search.with_steps(model_));
}

LaneErrors LaneChooser::off_the_elements(double speed) {
  const CrossingResult& lane = beginnings_->run(model_).back();
  Scene scene = with(beginnings_->scene(), model_);
  scene.sweep.reset();
  scene.model_modes = 0;
  scene.vehicle_model = VehicleModel::full;
  scene.train.speed = speed;
  scene.end_time = distance_ / speed;
  scene.output.interval = 32.0 * model_.step;
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
  return difference(scene_, {lane}, {by_elements});
}

}  // namespace traverse::app
