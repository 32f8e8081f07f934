// Searches mesh and step on the beginnings of passages, compares whole passages with a finer mesh and half the step,
// and refines the mesh where that causes the difference, else the step.
#include "error_control/batch_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "error_control/trial_window.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::app {

using Errors = PeakErrors;

namespace {

constexpr int most_tries = 6;
constexpr double shorter = 0.7;  // a quarter of an error of fourth order

}  // namespace

std::string words_of(const Scene& scene, const Errors& errors) {
  std::string words;
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene, q))
      words += fmt::format("{}{} {:.1g}", words.empty() ? "" : ", ", quantity_names[q], errors[q]);
  return words;
}

BatchChoice::BatchChoice(const Scene& scene, const TrialSpeeds& speeds) : scene_(scene), fastest_(scene) {
  fastest_.train.speed = scene.sweep->speeds.back();
  for (const double x : wheels_at_start(fastest_)) whole_ = std::max(whole_, scene.beam->length() - x);
  whole_ += scene.tail.value_or(0.0) * fastest_.train.speed;
  if (scene.end_time) whole_ = *scene.end_time * fastest_.train.speed;
  distance_ = initial_window(fastest_, whole_ / fastest_.train.speed) * fastest_.train.speed;
  if (asks_for(scene, low_passed))
    distance_ = std::min(whole_, distance_ + unsettled_end(*scene.output.low_pass) * fastest_.train.speed);
  const Scene part = restrict_to_window(fastest_, distance_ / fastest_.train.speed);
  beginnings_.emplace(part, speeds.beginnings, distance_);
  if (!speeds.mixed.empty()) mixed_.emplace(part, speeds.mixed, distance_);
  wholes_.emplace(scene, speeds.wholes, whole_, &*beginnings_);
}

Choice BatchChoice::choose() {
  BatchSearch search(*beginnings_, mixed_ ? *mixed_ : *beginnings_, scene_.accuracy);
  take(search.run(search.first(whole_ / fastest_.train.speed)));
  if (lose_contact(beginnings_->run(model_))) throw NotChosen{"wheels lose contact"};
  const double defect = beginnings_->defect(model_);
  double most = most_residual(scene_);
  if (scene_.model.vehicles == VehicleModel::automatic && may_exceed(defect, scene_))
    most = tolerable_defect(PETSC_COMM_SELF, tried());
  if (scene_.model.vehicles == VehicleModel::automatic && defect > most)
    throw NotChosen{fmt::format("the residual of linearised vehicles is {:.1g} of their weights", defect)};
  Errors errors = check_wholes(search);
  for (std::size_t q = 0; q < quantities; ++q)
    if (asks_for(scene_, q)) errors[q] += std::min(defect, most_residual(scene_));
  Choice choice{model_, {}, {}};
  choice.accuracy.measured = true;
  for (std::size_t q = 0; q < quantities; ++q) {
    const bool kept = asks_for(scene_, q);
    const bool present = !by_elements_alone(q) || q == shear_force;
    choice.accuracy.estimates[q] = {present, kept, errors[q], kept ? "" : why_not_asked(scene_, q)};
  }
  if (scene_.model.vehicles == VehicleModel::automatic) choice.model.most_residual = most;
  choice.model.step_probes = true;
  choice.model.local_compliance = true;
  return choice;
}

/// A beginning by the model, as a run by itself.
Scene BatchChoice::tried() const {
  Scene scene = restrict_to_window(fastest_, distance_ / fastest_.train.speed);
  scene.sweep.reset();
  scene.model.step = model_.step;
  set_mesh(scene, model_.elements);
  return scene;
}

void BatchChoice::take(const std::optional<NumericalModel>& found) {
  if (!found) throw NotChosen{"their peaks do not settle to the accuracy", true};
  model_ = *found;
}

PeakErrors BatchChoice::check_wholes(BatchSearch& search) {
  Errors errors{};
  for (int i = 0; i <= most_tries; ++i) {
    NumericalModel other = search.on_finer_mesh(model_);
    other.method = "esdirk4";
    *other.step *= 0.5;
    wholes_->run_at_once(std::array{other, model_});
    errors = difference(scene_, wholes_->run(model_), wholes_->run(other));
    for (std::size_t q = 0; q < quantities; ++q)
      errors[q] = std::max(errors[q], search.error_of_mesh(q) + search.error_of_steps(q));
    if (greatest(errors) <= search::share_of_whole * scene_.accuracy) {
      if (lose_contact(wholes_->run(model_))) throw NotChosen{"wheels lose contact"};
      return errors;
    }
    refine(other);
  }
  throw NotChosen{fmt::format("over whole passages errors add up to {}", words_of(scene_, errors)), true};
}

void BatchChoice::refine(const NumericalModel& other) {
  NumericalModel same_mesh = other;
  same_mesh.elements = model_.elements;
  const Errors by_mesh = difference(scene_, wholes_->run(same_mesh), wholes_->run(other));
  if (greatest(by_mesh) <= search::share_of_wholes_mesh * scene_.accuracy)
    *model_.step *= shorter;
  else
    model_.elements = other.elements;
}

}  // namespace traverse::app
