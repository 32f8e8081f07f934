#include "study/lane_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "accuracy/accuracy.hpp"
#include "accuracy/first_guess.hpp"
#include "accuracy/trials.hpp"

namespace traverse::app {
namespace {

constexpr double part_of_modes = 0.4, part_of_mesh = 0.1, part_of_steps = 0.4;  // of the wanted error
constexpr int most_halvings = 8;
constexpr double first_step_factor = 4.0;  // times the step that the search by elements would begin with
constexpr std::array methods = {"genalpha", "esdirk4"};
// Times the errors of genalpha's steps, which come and go with where these end; forces are off where a run of its own
// changes their length, too.
constexpr double of_one_solve = 1.5, of_its_forces = 2.0;
constexpr std::array step_factors = {2.0, 1.4, 1.0, 0.7, 0.5};  // times the step of esdirk4, of what may cost less
constexpr std::array numbers_of_modes = {4, 6, 8, 12, 16, 24, 32, 48, 64, 84};
// Each is compared with half as many more. Without damping that grows with the frequency errors of moments fall with
// the first power.
constexpr double more_modes = 1.5, of_an_undamped_moment = 3.0;
constexpr double supposed_order = 2.0, slowest_order = 1.0;  // of their errors
constexpr double order_of_modes = 4.5;  // that errors of the modes fall with at most: what is farther off is not tried
// The modes that are compared reach over the frequency at which wheels vibrate on their contacts, which stirs modes
// near it: comparisons below it agree whatever these do. Accelerations show modes farther from it.
constexpr double above_contacts = 1.1, above_them_in_accelerations = 2.0;
constexpr double surely = 0.7;           // of a number of modes that is foreseen: fewer are not looked at
constexpr double elements_a_wave = 4.0;  // of the highest mode; a finer mesh has to agree
constexpr double order_of_mesh = 4.0;
constexpr double surely_within = 0.8, clearly_over = 1.3;  // times what steps or modes may leave
constexpr double lowest_order = 0.5, highest_order = 4.0;  // of the steps

int mesh_for(const Scene& scene, int modes) {
  if (!scene.mesh_open) return mesh_of(scene);
  const double longest = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double waves = 0.5 * modes * longest / scene.beam->length() + 1.0;  // of the highest mode in that span
  const int elements = static_cast<int>(std::ceil(elements_a_wave * waves));
  return aligned_mesh(scene, std::max(first_mesh(scene), elements + elements % 2));
}

LaneErrors change(LaneTrials& trials, const LaneModel& from, const LaneModel& to, double factor = 1.0) {
  trials.run_at_once(std::array{to, from});  // as modes of a coarser mesh's model may be among those of the finer
  LaneErrors errors = difference(trials.scene(), trials.run(from), trials.run(to));
  for (double& error : errors) error *= factor;
  return errors;
}

/// The error that half the step leaves, by what halving it has changed now and the time before, which tell the order.
double left_of(double change, double before, double most) {
  const double order = std::clamp(before > change ? std::log2(before / change) : 0.0, lowest_order, most);
  return change / (std::exp2(order) - 1.0);
}

LaneModel with_step(const LaneModel& model, double factor, const char* method = nullptr) {
  LaneModel other = model;
  other.step *= factor;
  if (method != nullptr) other.method = structure::find_method(method);
  return other;
}

/// Whether not even the shortest step of a method will do, where this one leaves so many times what it may.
bool hopeless(double over, const structure::MethodRow& method, double factor) {
  return over > std::pow(factor / step_factors.back(), method.order);
}

/// Solves that a second of motion takes.
double solves(const LaneModel& model) { return model.method->solves() / model.step; }

}  // namespace

LaneModel LaneSearch::first(double duration) {
  const int modes = numbers_of_modes.front();
  LaneModel model{modes, mesh_for(trials_.scene(), modes), structure::find_method("esdirk4"), 0.0};
  const FirstSteps steps = first_steps(trials_.scene(), trials_.first_omega(model), duration);
  longest_ = steps.longest;
  model.step = std::min(first_step_factor * steps.first, longest_);
  trials_.run_at_once(std::array{with_step(model, 0.25), with_step(model, 0.5), model, with_step(model, 2.0)});
  return model;
}

std::optional<LaneModel> LaneSearch::run(LaneModel model) {
  // Steps first, as modes are told apart by what the contacts do to them; and modes again where they want shorter ones.
  if (!foresee_step(model)) return std::nullopt;
  for (double step = 0.0; step != model.step;) {
    step = model.step;
    if (!add_modes(model)) return std::nullopt;
    foresee(model);
    if (!halve_step(model)) return std::nullopt;
  }
  return with_steps(model);
}

std::optional<LaneModel> LaneSearch::with_steps(LaneModel model) {
  foresee(model);
  if (!refine_mesh(model) || !halve_step(model)) return std::nullopt;
  return cheaper(model);
}

/// What is compared in any case goes at once, the longest run first.
void LaneSearch::foresee(const LaneModel& model) {
  std::vector<LaneModel> steps = {with_step(model, 0.5), model, with_step(model, 2.0)};
  if (one_solve_) steps.push_back(with_step(model, step_factors.front(), methods.front()));
  if (trials_.scene().mesh_open && &mixed_ == &trials_) steps.push_back(on_coarser_mesh(model));
  trials_.run_at_once(steps);
}

/// The step that few modes ask for, which all that are needed are to confirm, and whether methods of one solve a step
/// are worth a trial.
bool LaneSearch::foresee_step(LaneModel& model) {
  for (int i = 0; i < most_halvings; ++i, model.step *= 0.5) {
    measure_steps(model);
    const bool does = over(steps_) <= 1.0;
    if (!does && over(halved_) > surely_within) continue;
    // With one solve a step wheel forces are off where steps change their length.
    const LaneModel one_solve =
        with_step(model, does ? step_factors.front() : 0.5 * step_factors.front(), methods.front());
    one_solve_ = !asks_for_forces_alone(trials_.scene()) &&
                 !hopeless(over(left_by(one_solve, model)), *one_solve.method, step_factors.front());
    if (!does) model.step *= 0.5;
    return true;
  }
  return false;
}

bool LaneSearch::halve_step(LaneModel& model) {
  for (int i = 0; i < most_halvings; ++i) {
    measure_steps(model);
    if (over(steps_) <= 1.0) return true;
    model.step *= 0.5;
  }
  return false;
}

void LaneSearch::measure_steps(const LaneModel& model) {
  trials_.run_at_once(std::array{with_step(model, 0.5), model, with_step(model, 2.0)});
  const LaneErrors before = change(trials_, with_step(model, 2.0), model);
  const LaneErrors now = change(trials_, model, with_step(model, 0.5));
  for (std::size_t q = 0; q < quantities; ++q) {
    // Without damping a moment is a sum of 1/n^2 over all modes, of which a step follows those below a frequency.
    const bool follows = q != moment || damps_high_modes(trials_.scene());
    halved_[q] = left_of(now[q], before[q], follows ? highest_order : 1.0);
    steps_[q] = now[q] + halved_[q];
  }
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
  const double above = asks_for(trials_.scene(), acceleration) ? above_them_in_accelerations : above_contacts;
  const double stirred = above * contact_frequency(trials_.scene(), true), allowed = part_of_modes * accuracy_;
  // Frequencies of bending grow about with the square of their number.
  double fewest = surely * model.modes * std::sqrt(stirred / mixed_.last_omega(model)) / more_modes;
  bool glances = 2.0 * model.step <= longest_;  // at what is likely to be too few, with steps twice as long
  for (const int modes : numbers_of_modes) {
    if (modes < model.modes || modes < fewest) continue;
    if (modes > most_modes_) return false;
    model.modes = modes;
    const LaneModel more = with_more_modes(model);
    model.elements = more.elements;
    if (mixed_.last_omega(more) < stirred) continue;
    double times = glances ? greatest(left_out(with_step(model, 2.0), with_step(more, 2.0))) / allowed : 0.0;
    glances = false;
    if (times <= clearly_over) {
      modes_ = left_out(model, more);
      mind_slow_orders(model.modes);
      times = greatest(modes_) / allowed;
      if (times <= 1.0) return true;
    }
    fewest = modes * std::pow(times, 1.0 / order_of_modes);
  }
  return false;
}

/// What a number of modes leaves of errors, as more of them tell.
LaneErrors LaneSearch::left_out(const LaneModel& model, const LaneModel& more) {
  LaneErrors errors = change(mixed_, model, more, of_the_change);
  if (!damps_high_modes(trials_.scene())) errors[moment] *= of_an_undamped_moment / of_the_change;
  return errors;
}

/// Where the changes of fewer modes and of these show an order below the one that left_out supposes, more is left.
void LaneSearch::mind_slow_orders(int modes) {
  const auto left_of_a_change = [](double order) { return 1.0 / (1.0 - std::pow(more_modes, -order)); };
  const LaneErrors now = changes_[modes] = modes_;
  const auto own = changes_.find(modes);
  if (own == changes_.begin()) return;
  const auto& [fewer, before] = *std::prev(own);
  for (std::size_t q = 0; q < quantities; ++q) {
    if (now[q] == 0.0 || (q == moment && !damps_high_modes(trials_.scene()))) continue;
    const double order = std::log(before[q] / now[q]) / std::log(static_cast<double>(modes) / fewer);
    modes_[q] *= left_of_a_change(std::clamp(order, slowest_order, supposed_order)) / left_of_a_change(supposed_order);
  }
}

LaneModel LaneSearch::on_coarser_mesh(LaneModel model) const {
  model.elements = aligned_mesh(trials_.scene(), model.elements / 2);
  return model;
}

/// On the mesh that the modes were compared on, whose errors a coarser one tells.
bool LaneSearch::refine_mesh(LaneModel& model) {
  for (int i = 0; trials_.scene().mesh_open && i < most_halvings; ++i) {
    const LaneModel coarser = on_coarser_mesh(model);
    const double ratio = static_cast<double>(coarser.elements) / model.elements;
    mesh_ = change(mixed_, coarser, model, 1.0 / (std::pow(ratio, -order_of_mesh) - 1.0));
    LaneErrors both = mesh_;
    for (std::size_t q = 0; q < quantities; ++q) both[q] += modes_[q];
    if (greatest(both) <= (part_of_modes + part_of_mesh) * accuracy_) return true;
    model.elements *= 2;
  }
  return !trials_.scene().mesh_open;
}

/// A longer step, or the method of one solve a step, where that costs less.
LaneModel LaneSearch::cheaper(const LaneModel& model) {
  LaneModel best = model;
  const double of_model = over(steps_);
  for (const char* method : std::span(methods).subspan(one_solve_ ? 0 : 1)) {
    double of_longer = 0.0;
    for (const double factor : step_factors) {
      const LaneModel tried = with_step(model, factor, method);
      if (tried.step > longest_ || solves(tried) >= solves(best)) continue;
      // Between two steps of one method that are known: about the root of both.
      if (tried.method == model.method && std::sqrt(of_model * of_longer) > clearly_over) continue;
      const LaneErrors own = left_by(tried, model);
      of_longer = over(own);
      if (hopeless(of_longer, *tried.method, factor)) break;
      if (of_longer > 1.0) continue;
      steps_ = own;
      best = tried;
    }
  }
  return best;
}

/// The errors of such steps, told by half those of the model.
LaneErrors LaneSearch::left_by(const LaneModel& tried, const LaneModel& model) {
  LaneErrors own = change(trials_, tried, with_step(model, 0.5));
  const double times = tried.method->solves() > 1.0 ? 1.0 : of_one_solve;
  if (times > 1.0) own[wheel_force] *= of_its_forces;
  for (std::size_t q = 0; q < quantities; ++q) own[q] = times * own[q] + halved_[q];
  return own;
}

/// Times what steps may leave.
double LaneSearch::over(const LaneErrors& errors) const { return greatest(errors) / (part_of_steps * accuracy_); }

}  // namespace traverse::app
