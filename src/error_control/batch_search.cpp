// Halves steps and elements until what that changes is within the accuracy, then looks for what costs less.
#include "error_control/batch_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "error_control/accuracy.hpp"
#include "error_control/initial_guess.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"

namespace traverse::app {
namespace {

constexpr std::array methods = {"genalpha", "esdirk4"};
constexpr double least_finer = 1.25, most_finer = 2.0;  // times the elements, from mesh to mesh

PeakErrors change(BatchTrialRuns& trials, const NumericalModel& from, const NumericalModel& to, double factor = 1.0) {
  trials.run_at_once(std::array{to, from});
  PeakErrors errors = difference(trials.scene(), trials.run(from), trials.run(to));
  for (double& error : errors) error *= factor;
  return errors;
}

/// The error that half the step leaves, by what halving it has changed now and the time before, which tell the order.
double left_of(double change, double before, double most) {
  const double order = std::clamp(before > change ? std::log2(before / change) : 0.0, search::least_order, most);
  return change / (std::exp2(order) - 1.0);
}

NumericalModel with_step(const NumericalModel& model, double factor, const char* method = nullptr) {
  NumericalModel other = model;
  *other.step *= factor;
  if (method != nullptr) other.method = method;
  return other;
}

/// Whether not even the shortest step of a method will do, where this one leaves so many times what it may.
bool hopeless(double over, const structure::MethodRow& method, double factor) {
  return over > std::pow(factor / search::batch_steps.back(), method.order);
}

/// Solves that a second of motion takes.
const structure::MethodRow& row_of(const NumericalModel& model) { return *structure::find_method(model.method); }
double solves(const NumericalModel& model) { return row_of(model).solves() / *model.step; }

}  // namespace

NumericalModel BatchSearch::first(double duration) {
  const Scene& scene = trials_.scene();
  NumericalModel model = scene.model;
  model.elements = scene.mesh_open ? aligned_mesh(scene, first_mesh(scene)) : mesh_of(scene);
  model.modes = 0;
  model.method = "esdirk4";
  model.vehicles = VehicleModel::linear;
  model.step = 1.0;  // until the first frequency is known
  const FirstSteps steps = first_steps(trials_.scene(), trials_.first_omega(model), duration);
  longest_ = steps.longest;
  model.step = std::min(search::first_batch_step * steps.first, longest_);
  return model;
}

// Steps first, as meshes are told apart by what the contacts do to them; and again where a finer mesh wants shorter
// ones.
std::optional<NumericalModel> BatchSearch::run(NumericalModel model) {
  if (!predict_step(model) || !refine_mesh(model) || !halve_step(model)) return std::nullopt;
  return cheaper(model);
}

NumericalModel BatchSearch::on_finer_mesh(NumericalModel model) const {
  if (trials_.scene().mesh_open) model.elements = aligned_mesh(trials_.scene(), 2 * model.elements);
  return model;
}

/// The step that the first mesh asks for, which the one that does is to confirm, and whether methods of one solve a
/// step are worth a trial.
bool BatchSearch::predict_step(NumericalModel& model) {
  for (int i = 0; i < search::most_halvings; ++i, *model.step *= 0.5) {
    measure_steps(model);
    const bool does = over(steps_) <= 1.0;
    if (!does && over(halved_) > search::surely_within) continue;
    // With one solve a step wheel forces are off where steps change their length.
    const NumericalModel one_solve =
        with_step(model, does ? search::batch_steps.front() : 0.5 * search::batch_steps.front(), methods.front());
    one_solve_ = !asks_for_forces_alone(trials_.scene()) &&
                 !hopeless(over(left_by(one_solve, model)), row_of(one_solve), search::batch_steps.front());
    if (!does) *model.step *= 0.5;
    return true;
  }
  return false;
}

bool BatchSearch::halve_step(NumericalModel& model) {
  for (int i = 0; i < search::most_halvings; ++i) {
    measure_steps(model);
    if (over(steps_) <= 1.0) return true;
    *model.step *= 0.5;
  }
  return false;
}

void BatchSearch::measure_steps(const NumericalModel& model) {
  trials_.run_at_once(std::array{with_step(model, 0.5), model, with_step(model, 2.0)});
  const PeakErrors before = change(trials_, with_step(model, 2.0), model);
  const PeakErrors now = change(trials_, model, with_step(model, 0.5));
  for (std::size_t q = 0; q < quantities; ++q) {
    // Without damping a moment is a sum of 1/n^2 over all modes, of which a step follows those below a frequency.
    const bool follows = q != moment || damps_high_modes(trials_.scene());
    halved_[q] = left_of(now[q], before[q], follows ? search::full_order : 1.0);
    steps_[q] = now[q] + halved_[q];
  }
}

/// As what twice the elements change tells.
bool BatchSearch::refine_mesh(NumericalModel& model) {
  const Scene& scene = trials_.scene();
  if (!scene.mesh_open) return true;
  for (int i = 0; i < search::most_halvings && model.elements <= search::most_in_a_span; ++i) {
    mesh_ = change(mixed_, model, on_finer_mesh(model), search::finer_mesh);
    if (!damps_high_modes(scene)) mesh_[moment] *= search::undamped_sum / search::finer_mesh;
    const double times = greatest(mesh_) / (search::share * accuracy_);
    if (times <= 1.0) return true;
    const double finer = std::clamp(std::pow(times, 1.0 / search::mesh_order), least_finer, most_finer);
    model.elements = aligned_mesh(scene, 2 * static_cast<int>(std::ceil(0.5 * finer * model.elements)));
  }
  return false;
}

/// A longer step, or the method of one solve a step, where that costs less.
NumericalModel BatchSearch::cheaper(const NumericalModel& model) {
  NumericalModel best = model;
  const double of_model = over(steps_);
  for (const char* method : std::span(methods).subspan(one_solve_ ? 0 : 1)) {
    double of_longer = 0.0;
    for (const double factor : search::batch_steps) {
      const NumericalModel tried = with_step(model, factor, method);
      if (tried.step > longest_ || solves(tried) >= solves(best)) continue;
      // Between two steps of one method that are known: about the root of both.
      if (tried.method == model.method && std::sqrt(of_model * of_longer) > search::surely_beyond) continue;
      const PeakErrors own = left_by(tried, model);
      of_longer = over(own);
      if (hopeless(of_longer, row_of(tried), factor)) break;
      if (of_longer > 1.0) continue;
      steps_ = own;
      best = tried;
    }
  }
  return best;
}

/// The errors of such steps, told by half those of the model.
PeakErrors BatchSearch::left_by(const NumericalModel& tried, const NumericalModel& model) {
  PeakErrors own = change(trials_, tried, with_step(model, 0.5));
  const double times = row_of(tried).solves() > 1.0 ? 1.0 : search::one_solve;
  if (times > 1.0) own[wheel_force] *= search::one_solve_force;
  for (std::size_t q = 0; q < quantities; ++q) own[q] = times * own[q] + halved_[q];
  return own;
}

/// Times what steps may leave.
double BatchSearch::over(const PeakErrors& errors) const { return greatest(errors) / (search::share * accuracy_); }

}  // namespace traverse::app
