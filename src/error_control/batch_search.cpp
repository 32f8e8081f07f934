// Halves steps and elements until the changes are within the accuracy, then searches cheaper models.
#include "error_control/batch_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/one_step_methods.hpp"
#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"

namespace traverse::error_control {

using scene::NumericalModel;

namespace {

constexpr double min_refinement = 1.25, max_refinement = 2.0;  // limits of the ratio of elements of successive meshes

PeakErrors change(BatchTrialRuns& trials, const NumericalModel& from, const NumericalModel& to, double factor = 1.0) {
  trials.run_at_once(std::array{to, from});
  PeakErrors errors = difference(trials.scene(), trials.run(from), trials.run(to));
  for (double& error : errors) error *= factor;
  return errors;
}

/// The error of half the step from the changes of the last two halvings, which determine the order. most: largest
/// order.
double remaining_error(double change, double before, double most) {
  const double order = std::clamp(before > change ? std::log2(before / change) : 0.0, search::least_order, most);
  return change / (std::exp2(order) - 1.0);
}

NumericalModel with_step(const NumericalModel& model, double factor, const char* method = nullptr) {
  NumericalModel other = model;
  *other.step *= factor;
  if (method != nullptr) other.method = method;
  return other;
}

/// Whether even the shortest step of a method cannot reach the accuracy if the error is `error_ratio` times the allowed
/// one at this step.
bool unreachable(double error_ratio, const base::MethodRow& method, double factor) {
  return error_ratio > std::pow(factor / search::batch_steps.back(), method.order);
}

/// The row of a model's method, and its number of stage solves in one second of motion.
const base::MethodRow& row_of(const NumericalModel& model) { return *base::find_method(model.method); }
double solves(const NumericalModel& model) { return row_of(model).solves() / *model.step; }

}  // namespace

NumericalModel BatchSearch::first(double duration) {
  const scene::Scene& scene = trials_.scene();
  NumericalModel model = scene.model;
  model.elements = scene.mesh_open ? aligned_mesh(scene, first_mesh(scene)) : mesh_of(scene);
  model.modes = 0;
  model.method = base::methods().front().name;
  model.vehicles = scene::VehicleModel::linear;
  model.step = 1.0;  // placeholder, until the first frequency is known
  const FirstSteps steps = first_steps(trials_.scene(), trials_.first_omega(model), duration);
  longest_ = steps.longest;
  model.step = std::min(search::first_batch_step * steps.first, longest_);
  return model;
}

// The time step is estimated first, because the contacts cause most of the difference between meshes. The step is
// halved again if the finer mesh requires it.
std::optional<NumericalModel> BatchSearch::run(NumericalModel model) {
  if (!predict_step(model) || !refine_mesh(model) || !halve_step(model)) return std::nullopt;
  return find_cheaper(model);
}

NumericalModel BatchSearch::on_finer_mesh(NumericalModel model) const {
  if (trials_.scene().mesh_open) model.elements = aligned_mesh(trials_.scene(), 2 * model.elements);
  return model;
}

/// Determines the step with the first mesh, to be confirmed on the final mesh, and which methods with fewer solves in
/// each step are worth a trial.
bool BatchSearch::predict_step(NumericalModel& model) {
  for (int i = 0; i < search::max_halvings; ++i, *model.step *= 0.5) {
    measure_steps(model);
    const bool accurate = error_ratio(steps_) <= 1.0;
    if (!accurate && error_ratio(halved_) > search::surely_within) continue;
    cheaper_methods_.clear();
    for (const base::MethodRow& method : base::methods().subspan(1)) {
      if (method.solves() >= base::methods().front().solves()) continue;
      const NumericalModel other =
          with_step(model, accurate ? search::batch_steps.front() : 0.5 * search::batch_steps.front(), method.name);
      // With one solve in each step wheel forces have errors where the step length changes.
      if (method.solves() == 1.0 && controls_forces_only(trials_.scene())) continue;
      if (!unreachable(error_ratio(errors_of(other, model)), method, search::batch_steps.front()))
        cheaper_methods_.push_back(method.name);
    }
    if (!accurate) *model.step *= 0.5;
    return true;
  }
  return false;
}

bool BatchSearch::halve_step(NumericalModel& model) {
  for (int i = 0; i < search::max_halvings; ++i) {
    measure_steps(model);
    if (error_ratio(steps_) <= 1.0) return true;
    *model.step *= 0.5;
  }
  return false;
}

void BatchSearch::measure_steps(const NumericalModel& model) {
  trials_.run_at_once(std::array{with_step(model, 0.5), model, with_step(model, 2.0)});
  const PeakErrors before = change(trials_, with_step(model, 2.0), model);
  const PeakErrors now = change(trials_, model, with_step(model, 0.5));
  for (std::size_t q = 0; q < run::quantities; ++q) {
    // Without damping a moment is a sum of 1/n^2 over all modes, of which a step resolves those below a frequency.
    const bool resolved = q != run::moment || damps_high_modes(trials_.scene());
    halved_[q] = remaining_error(now[q], before[q], resolved ? search::full_order : 1.0);
    steps_[q] = now[q] + halved_[q];
  }
}

/// Refines the mesh until the change by twice the elements is within the accuracy.
bool BatchSearch::refine_mesh(NumericalModel& model) {
  const scene::Scene& scene = trials_.scene();
  if (!scene.mesh_open) return true;
  for (int i = 0; i < search::max_halvings && model.elements <= search::max_in_a_span; ++i) {
    mesh_ = change(mixed_, model, on_finer_mesh(model), search::finer_mesh);
    if (!damps_high_modes(scene)) mesh_[run::moment] *= search::undamped_sum / search::finer_mesh;
    const double ratio = greatest(mesh_) / (search::share * accuracy_);
    if (ratio <= 1.0) return true;
    const double finer = std::clamp(std::pow(ratio, 1.0 / search::mesh_order), min_refinement, max_refinement);
    model.elements = aligned_mesh(scene, 2 * static_cast<int>(std::ceil(0.5 * finer * model.elements)));
  }
  return false;
}

/// A longer step, or a method with fewer solves in each step, if that costs less.
NumericalModel BatchSearch::find_cheaper(const NumericalModel& model) {
  NumericalModel best = model;
  const double ratio_of_model = error_ratio(steps_);
  std::vector<const char*> methods = cheaper_methods_;
  methods.push_back(base::methods().front().name);
  for (const char* method : methods) {
    double ratio_of_longer = 0.0;
    for (const double factor : search::batch_steps) {
      const NumericalModel candidate = with_step(model, factor, method);
      if (candidate.step > longest_ || solves(candidate) >= solves(best)) continue;
      // The error of a time step between two known steps of one method is about the geometric mean of their errors.
      if (candidate.method == model.method && std::sqrt(ratio_of_model * ratio_of_longer) > search::surely_above)
        continue;
      const PeakErrors errors = errors_of(candidate, model);
      ratio_of_longer = error_ratio(errors);
      if (unreachable(ratio_of_longer, row_of(candidate), factor)) break;
      if (ratio_of_longer > 1.0) continue;
      steps_ = errors;
      best = candidate;
    }
  }
  return best;
}

/// The errors of the steps of `candidate`, by comparison with half the model's step.
PeakErrors BatchSearch::errors_of(const NumericalModel& candidate, const NumericalModel& model) {
  PeakErrors errors = change(trials_, candidate, with_step(model, 0.5));
  const double ratio = row_of(candidate).solves() > 1.0 ? 1.0 : search::one_solve;
  if (ratio > 1.0) errors[run::wheel_force] *= search::one_solve_force;
  for (std::size_t q = 0; q < run::quantities; ++q) errors[q] = ratio * errors[q] + halved_[q];
  return errors;
}

/// The ratio of the largest error to its allowed value.
double BatchSearch::error_ratio(const PeakErrors& errors) const {
  return greatest(errors) / (search::share * accuracy_);
}

}  // namespace traverse::error_control
