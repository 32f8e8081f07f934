// Searches mesh and step on the first part of passages, compares whole passages with a finer mesh and half the step,
// and refines the mesh if it causes the difference, otherwise the step.
#include "error_control/batch_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/one_step_methods.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "error_control/trial_window.hpp"
#include "run/deck_acceleration.hpp"

namespace traverse::error_control {

using Errors = PeakErrors;

namespace {

constexpr int max_refinements = 6;
constexpr double step_factor = 0.7;  // reduces an error of fourth order to a quarter

}  // namespace

std::string text_of(const scene::Scene& scene, const Errors& errors) {
  std::string words;
  for (std::size_t q = 0; q < run::quantities; ++q)
    if (is_controlled(scene, q))
      words += fmt::format("{}{} {:.1g}", words.empty() ? "" : ", ", run::quantity_names[q], errors[q]);
  return words;
}

BatchChoice::BatchChoice(const scene::Scene& scene, const TrialSpeeds& speeds) : scene_(scene), fastest_(scene) {
  fastest_.train.speed = scene.sweep->speeds.back();
  for (const double x : scene::wheels_at_start(fastest_))
    passage_length_ = std::max(passage_length_, scene.beam->length() - x);
  passage_length_ += scene.tail.value_or(0.0) * fastest_.train.speed;
  if (scene.end_time) passage_length_ = *scene.end_time * fastest_.train.speed;
  distance_ = initial_window(fastest_, passage_length_ / fastest_.train.speed) * fastest_.train.speed;
  if (is_controlled(scene, run::low_passed))
    distance_ =
        std::min(passage_length_, distance_ + run::unsettled_end(*scene.output.low_pass) * fastest_.train.speed);
  const scene::Scene part = restrict_to_window(fastest_, distance_ / fastest_.train.speed);
  first_parts_.emplace(part, speeds.first_parts, distance_);
  if (!speeds.mixed.empty()) mixed_.emplace(part, speeds.mixed, distance_);
  whole_passages_.emplace(scene, speeds.whole_passages, passage_length_, &*first_parts_);
}

Choice BatchChoice::choose() {
  BatchSearch search(*first_parts_, mixed_ ? *mixed_ : *first_parts_, scene_.accuracy);
  accept(search.run(search.first(passage_length_ / fastest_.train.speed)));
  if (any_contact_loss(first_parts_->run(model_))) throw NotChosen{"wheels lose contact"};
  const double residual = first_parts_->residual(model_);
  double residual_limit = default_residual_limit(scene_);
  if (scene_.model.vehicles == scene::VehicleModel::automatic && may_exceed(residual, scene_))
    residual_limit = measured_residual_limit(PETSC_COMM_SELF, trial_scene());
  if (scene_.model.vehicles == scene::VehicleModel::automatic && residual > residual_limit)
    throw NotChosen{fmt::format("the residual of linearised vehicles is {:.1g} of their weights", residual)};
  Errors errors = check_wholes(search);
  for (std::size_t q = 0; q < run::quantities; ++q)
    if (is_controlled(scene_, q)) errors[q] += std::min(residual, default_residual_limit(scene_));
  Choice choice{model_, {}, {}};
  choice.accuracy.measured = true;
  for (std::size_t q = 0; q < run::quantities; ++q) {
    const bool accepted = is_controlled(scene_, q);
    const bool present = !run::by_elements_only(q) || q == run::shear_force;
    choice.accuracy.estimates[q] = {present, accepted, errors[q], accepted ? "" : why_not_controlled(scene_, q)};
  }
  if (scene_.model.vehicles == scene::VehicleModel::automatic) choice.model.residual_limit = residual_limit;
  choice.model.step_probes = true;
  choice.model.local_compliance = true;
  return choice;
}

/// The first part of a passage with the chosen model, as a single run.
scene::Scene BatchChoice::trial_scene() const {
  scene::Scene scene = restrict_to_window(fastest_, distance_ / fastest_.train.speed);
  scene.sweep.reset();
  scene.model.step = model_.step;
  set_mesh(scene, model_.elements);
  return scene;
}

void BatchChoice::accept(const std::optional<scene::NumericalModel>& model) {
  if (!model) throw NotChosen{"the peaks do not converge to the accuracy", true};
  model_ = *model;
}

PeakErrors BatchChoice::check_wholes(BatchSearch& search) {
  Errors errors{};
  for (int i = 0; i <= max_refinements; ++i) {
    scene::NumericalModel other = search.on_finer_mesh(model_);
    other.method = base::methods().front().name;
    *other.step *= 0.5;
    whole_passages_->run_at_once(std::array{other, model_});
    errors = difference(scene_, whole_passages_->run(model_), whole_passages_->run(other));
    for (std::size_t q = 0; q < run::quantities; ++q)
      errors[q] = std::max(errors[q], search.error_of_mesh(q) + search.error_of_steps(q));
    if (greatest(errors) <= search::share_of_whole * scene_.accuracy) {
      if (any_contact_loss(whole_passages_->run(model_))) throw NotChosen{"wheels lose contact"};
      return errors;
    }
    refine(other);
  }
  throw NotChosen{fmt::format("the errors over whole passages are {}", text_of(scene_, errors)), true};
}

void BatchChoice::refine(const scene::NumericalModel& other) {
  scene::NumericalModel same_mesh = other;
  same_mesh.elements = model_.elements;
  const Errors by_mesh = difference(scene_, whole_passages_->run(same_mesh), whole_passages_->run(other));
  if (greatest(by_mesh) <= search::share_of_wholes_mesh * scene_.accuracy)
    *model_.step *= step_factor;
  else
    model_.elements = other.elements;
}

}  // namespace traverse::error_control
