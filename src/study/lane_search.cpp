#include "study/lane_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/first_guess.hpp"
#include "accuracy/trials.hpp"

namespace traverse::app {
namespace {

using lanes::CrossingResult;

constexpr double part_of_modes = 0.4, part_of_mesh = 0.1, part_of_steps = 0.4;  // of the wanted error
constexpr int most_halvings = 8;
constexpr std::array methods = {"genalpha", "esdirk4"};
constexpr std::array step_factors = {2.0, 1.4, 1.0, 0.7, 0.5};  // times the step of esdirk4, of what may cost less
constexpr std::array numbers_of_modes = {4, 6, 8, 12, 16, 24, 32, 48, 64, 84};
// Each is compared with half as many more; errors that fall with the square or faster are at most 1.8 times the change.
constexpr double more_modes = 1.5, of_the_change = 1.8;
constexpr double order_of_modes = 6.0;   // that errors of the modes fall with at most: what is farther off is not tried
constexpr double elements_a_wave = 4.0;  // of the highest mode; a finer mesh has to agree
constexpr double clearly_finer = 1.3, order_of_mesh = 4.0;

int mesh_for(const Scene& scene, int modes) {
  if (!scene.mesh_open) return mesh_of(scene);
  const double longest = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double waves = 0.5 * modes * longest / scene.beam->length() + 1.0;  // of the highest mode in that span
  const int elements = static_cast<int>(std::ceil(elements_a_wave * waves));
  return aligned_mesh(scene, std::max(first_mesh(scene), elements + elements % 2));
}

/// The finer one goes first, as modes of the coarser one may be among its own.
LaneErrors change(LaneTrials& trials, const LaneModel& from, const LaneModel& to, double factor = 1.0) {
  const std::vector<CrossingResult>& fine = trials.run(to);
  LaneErrors errors = difference(trials.scene(), trials.run(from), fine);
  for (double& error : errors) error *= factor;
  return errors;
}

double solves(const LaneModel& model) {
  return static_cast<double>(model.method->make(model.method->parameter.value).stages.size()) / model.step;
}

}  // namespace

std::optional<LaneModel> LaneSearch::run(double first_step) {
  const int modes = numbers_of_modes.front();
  LaneModel model{modes, mesh_for(trials_.scene(), modes), structure::find_method("esdirk4"), first_step};
  // Steps first, as modes are told apart by what the contacts do to them.
  if (!halve_step(model) || !add_modes(model) || !refine_mesh(model) || !halve_step(model)) return std::nullopt;
  return cheaper(model);
}

bool LaneSearch::halve_step(LaneModel& model) {
  for (int i = 0; i < most_halvings; ++i) {
    LaneModel finer = model;
    finer.step *= 0.5;
    steps_ = change(trials_, model, finer);
    if (greatest(steps_) <= part_of_steps * accuracy_) return true;
    model = finer;
  }
  return false;
}

/// Half as many modes more, equal spans having each as often as they are.
LaneModel LaneSearch::with_more_modes(const LaneModel& model) {
  LaneModel more = model, less = model;
  for (int modes = model.modes, found = 0;; modes = mixed_.modes(less)) {
    if (found >= more_modes * modes) return more;
    more.modes = static_cast<int>(std::ceil(more_modes * modes));
    more.elements = less.elements = mesh_for(trials_.scene(), more.modes);
    found = mixed_.modes(more);
  }
}

bool LaneSearch::add_modes(LaneModel& model) {
  double fewest = 0.0;
  for (const int modes : numbers_of_modes) {
    if (modes < fewest) continue;
    model.modes = modes;
    const LaneModel more = with_more_modes(model);
    model.elements = more.elements;
    modes_ = change(mixed_, model, more, of_the_change);
    const double over = greatest(modes_) / (part_of_modes * accuracy_);
    if (over <= 1.0) {
      dense_ = more.elements;
      model.elements = mesh_for(trials_.scene(), modes);
      return true;
    }
    fewest = modes * std::pow(over, 1.0 / order_of_modes);
  }
  return false;
}

/// Against the mesh that the modes were compared on, where it is fine enough: its runs are known.
bool LaneSearch::refine_mesh(LaneModel& model) {
  for (int i = 0; trials_.scene().mesh_open && i < most_halvings; ++i) {
    LaneModel finer = model;
    finer.elements = dense_ >= clearly_finer * model.elements ? dense_ : 2 * model.elements;
    const double ratio = static_cast<double>(model.elements) / finer.elements;
    mesh_ = change(mixed_, model, finer, 1.0 / (1.0 - std::pow(ratio, order_of_mesh)));
    LaneErrors both = mesh_;
    for (std::size_t q = 0; q < quantities; ++q) both[q] += modes_[q];
    if (greatest(both) <= (part_of_modes + part_of_mesh) * accuracy_) return true;
    model = finer;
  }
  return !trials_.scene().mesh_open;
}

/// A longer step, or the method of one solve a step, where that costs less.
LaneModel LaneSearch::cheaper(const LaneModel& model) {
  LaneModel exact = model;
  exact.step *= 0.5;
  LaneModel best = model;
  for (const char* method : methods)
    for (const double factor : step_factors) {
      const LaneModel tried = {model.modes, model.elements, structure::find_method(method), factor * model.step};
      if (solves(tried) >= solves(best)) continue;
      const LaneErrors own = change(trials_, tried, exact);
      const double over = greatest(own) / (part_of_steps * accuracy_);
      if (over > std::pow(factor / step_factors.back(), tried.method->order)) break;  // nor will the shortest do
      if (over > 1.0) continue;
      steps_ = own;
      best = tried;
    }
  return best;
}

}  // namespace traverse::app
