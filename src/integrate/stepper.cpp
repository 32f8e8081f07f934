// Creates and configures the PETSc TS, and runs the loop over steps up to the next sample or known event, with the
// choice of each step length and the check for unbounded motion.
#include "integrate/stepper.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "arrays.hpp"
#include "integrate/integrators.hpp"
#include "integrate/second_order.hpp"
#include "integrator_choice.hpp"
#include "traverse/options/input.hpp"

namespace traverse::integrate {
namespace {

using base::check;
using coupling::Terms;

constexpr PetscInt no_limit = std::numeric_limits<PetscInt>::max() - 1;  // of steps; TS wants some bound
constexpr int most_rejections = 12;                                      // of one step, each a quarter as long
constexpr double near_event = 1e-3;     // of a step: events closer than this share the end of a step
constexpr double restart_growth = 2.0;  // steps of a method that carries accelerations on may not grow faster
constexpr long steps_unseen = 16;       // between two looks at the bounds of the motion, which cost a pass over it
constexpr double kept_step = 1e-7;      // of a step: lengths that need no other factorisation

bool has_type(TS ts, const char* type) {
  PetscBool same = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(static_cast<TS>(ts)), type, &same));
  return same == PETSC_TRUE;
}

}  // namespace

Stepper::Stepper(coupling::System& system, Settings settings) : system_(system), settings_(std::move(settings)) {
  const MPI_Comm comm = system.comm();
  const int n = system.local_size();
  check(VecCreateMPI(comm, n, PETSC_DETERMINE, y_.out()));
  check(VecDuplicate(y_, rate_.out()));

  check(TSCreate(comm, ts_.out()));
  check(TSSetProblemType(ts_, TS_NONLINEAR));
  const std::string type = chosen_type(settings_.type);
  register_second_order();
  check(TSSetType(ts_, type.c_str()));
  if (type == TSARKIMEX) {
    check(TSARKIMEXSetType(ts_, TSARKIMEX4));
    check(TSARKIMEXSetFullyImplicit(ts_, PETSC_TRUE));
  }
  check(TSSetSolution(ts_, y_));
  check(TSSetMaxSteps(ts_, no_limit));
  check(TSSetMaxSNESFailures(ts_, -1));
  check(TSSetMaxStepRejections(ts_, most_rejections));
  check(TSSetErrorIfStepFails(ts_, PETSC_FALSE));
  TSAdapt adapt = nullptr;
  check(TSGetAdapt(ts_, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTNONE));
  try {
    check(TSSetFromOptions(ts_));
  } catch (const SolverError& error) {
    options::refuse_by_petsc(error.what());
  }
  check(TSGetMaxSteps(ts_, &most_steps_));
  monitored_ = has_monitors(ts_);
  check(TSSetMaxSteps(ts_, no_limit));
  // Time and step are the scene's; TS takes one step at a time and never looks ahead to an end.
  check(TSSetTime(ts_, 0.0));
  check(TSSetMaxTime(ts_, std::numeric_limits<double>::max()));
  check(TSSetExactFinalTime(ts_, TS_EXACTFINALTIME_STEPOVER));
  check(TSSetTimeStep(ts_, settings_.time_step));
  TSAdaptType adapt_type = nullptr;
  check(TSAdaptGetType(adapt, &adapt_type));
  adaptive_ = std::string_view(adapt_type) != TSADAPTNONE;
  if (std::string_view(adapt_type) == ladder_adapt)
    set_ladder(ts_, ladder_.emplace(shared_evenly(settings_.interval, settings_.time_step)));
  next_step_ = settings_.time_step;
  set_up_type();
}

void Stepper::set_up_type() {
  TSType name = nullptr;
  check(TSGetType(ts_, &name));
  if (const structure::MethodRow* own = structure::find_method(name)) {
    second_order_ = true;
    high_order_ = own->order > 2;
    set_system(ts_, system_);
    return;
  }
  const PetscType& type = *find_petsc_type(name);
  check(VecDuplicate(y_, before_.out()));
  implicit_ = type.implicit;
  multistep_ = type.multistep;
  high_order_ = type.order > 2;
  bool imex = false;
  if (has_type(ts_, TSARKIMEX)) {
    PetscBool fully = PETSC_TRUE;
    check(TSARKIMEXGetFullyImplicit(ts_, &fully));
    imex = fully != PETSC_TRUE;
  }
  if (!implicit_ || imex) check(TSSetRHSFunction(ts_, nullptr, rhs_function, this));
  if (!implicit_) return;
  implicit_terms_ = imex ? Terms::beam : Terms::all;
  check(VecDuplicate(y_, residual_.out()));
  check(VecSet(residual_, 0.0));
  const PetscInt n = system_.local_size();
  for (std::vector<double>* x : {&stage_c_, &known_y_, &known_rate_}) x->resize(static_cast<std::size_t>(n));
  check(MatCreateShell(system_.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, this, jacobian_.out()));
  check(TSSetIFunction(ts_, nullptr, ifunction, this));
  check(TSSetIJacobian(ts_, jacobian_, jacobian_, ijacobian, this));
  SNES snes = nullptr;
  check(TSGetSNES(ts_, &snes));
  check(SNESSetType(snes, SNESSHELL));
  check(SNESShellSetContext(snes, this));
  check(SNESShellSetSolve(snes, shell_solve));
}

long Stepper::rejected() const {
  PetscInt rejected = 0;
  check(TSGetStepRejections(ts_, &rejected));
  return rejected;
}

std::string Stepper::method() const {
  TSType type = nullptr;
  check(TSGetType(ts_, &type));
  std::string text = type;
  if (has_type(ts_, TSARKIMEX)) {
    TSARKIMEXType which = nullptr;
    check(TSARKIMEXGetType(ts_, &which));
    text = std::string("arkimex ") + which + (implicit_terms_ == Terms::all ? ", implicit" : ", beam implicit");
  } else if (multistep_) {
    PetscInt order = 0;
    check(TSBDFGetOrder(ts_, &order));
    text += " " + std::to_string(order);
  }
  return text;
}

double* Stepper::state() {
  double* array = nullptr;
  check(VecGetArray(y_, &array));
  return array;
}

void Stepper::restore_state(double** array) { check(VecRestoreArray(y_, array)); }

// --- the loop ------------------------------------------------------------------------------------------------------

void Stepper::begin(const std::function<void(const Instant&)>& sample) {
  if (way_.begun) return;
  if (settings_.corners) system_.expect_corners(settings_.end_time, settings_.time_step);
  sample_now(sample, Purpose::sample);
  {
    Array y(y_);
    system_.accept(way_.t, y.data);
  }
  show_to_monitors(way_.t);
  way_.begun = true;
}

double Stepper::run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
                    const std::function<void(double)>& between) {
  const double slack = near_event * std::min({settings_.time_step, settings_.interval, settings_.end_time});
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::max(settings_.end_time, 1.0);
  Way& way = way_;
  double& t = way.t;
  begin(sample);
  for (bool going = true; going && t < settings_.end_time - slack;) {
    if (!way.under_way) set_target(slack);
    while (going && t < way.target) {
      if (between) between(t);
      t = take_step(t, way.target - t);
      if (t > way.target - rounding) {
        t = way.target;
        check(TSSetTime(ts_, t));
      }
      Array y(y_);
      const bool rewritten = system_.accept(t, y.data);
      if (rewritten) check(TSRestartStep(ts_));
      if (steps_ % steps_unseen == 0) check_bounds(t, y.data);
      show_to_monitors(t);
      going = step(t, steps_) && !stopped_at_limit();
    }
    way.under_way = t < way.target;
    if (t == way.next_sample) {
      const bool stored = ++way.samples % settings_.stored == 0 && !way.beyond;
      sample_now(sample, stored ? Purpose::sample : t == settings_.end_time ? Purpose::end : Purpose::look);
    } else if (way.passage < settings_.passages.size() && t == settings_.passages[way.passage]) {
      sample_now(sample, Purpose::look);
    }
  }
  return t;
}

// The next time at which a step has to end.
void Stepper::set_target(double slack) {
  way_.under_way = true;
  way_.next_sample = static_cast<double>(way_.samples + 1) * settings_.interval;
  way_.beyond = way_.next_sample > settings_.end_time + slack;  // the end is no multiple of the interval
  if (way_.next_sample > settings_.end_time - slack) way_.next_sample = settings_.end_time;
  way_.target = way_.next_sample;
  const auto stop_at = [&](const std::vector<double>& times, std::size_t& next) {
    while (next < times.size() && times[next] <= way_.t + slack) ++next;
    if (next < times.size() && times[next] < way_.target - slack) way_.target = times[next];
  };
  stop_at(settings_.events, way_.event);
  stop_at(settings_.passages, way_.passage);
}

// TS takes single steps here, in which it calls none.
void Stepper::show_to_monitors(double t) {
  if (!monitored_) return;
  check(TSMonitor(ts_, static_cast<PetscInt>(steps_), t, y_));
}

// What comes next on the way to a target `left` s away: a rung of the ladder, or what is left shared evenly among the
// steps that it takes. Where the target moves a little, the step stays, and with it the beam's factorisation.
double Stepper::next_step(double from, double left) const {
  const double limit = system_.contacts().step_limit(from);
  const double impact = system_.contacts().time_to_impact(settings_.contact_tolerance);
  if (ladder_) return std::min(ladder_->towards(left, limit), impact);
  const double wanted = std::min({adaptive_ ? next_step_ : settings_.time_step, limit, impact});
  const double even = shared_evenly(left, wanted);
  const bool held = even < left && last_step_ <= wanted && std::abs(even - last_step_) <= kept_step * last_step_;
  return held ? last_step_ : even;
}

// One step from where TS is, no longer than what is left to the next target. Returns the time reached.
double Stepper::take_step(double from, double left) {
  const auto turn = next_kink(from, left);
  if (turn) left = turn->time - from;
  const double h = next_step(from, left);
  // generalised-alpha carries on an acceleration of a part of a step elsewhere, as multistep methods do
  const bool carries = multistep_ || (second_order_ && !high_order_);
  if (carries && last_step_ > 0.0 && (h > restart_growth * last_step_)) check(TSRestartStep(ts_));
  if (system_.begin_step(from, from + h)) {  // a jump: what is known of the rate belongs to its other side
    known_ = false;
    check(TSRestartStep(ts_));
  }
  const bool turns = turn && h == left;
  const bool locating = settings_.contact_tolerance > 0.0 && system_.fleet().contacts() > 0;
  if (second_order_)
    system_.keep_steps(locating || turns);
  else if (locating || turns)
    check(VecCopy(y_, before_));
  double t = step_to(from, turns ? turn->time : from + h);
  PetscReal next = 0.0;
  check(TSGetTimeStep(ts_, &next));
  if (locating) t = locate_contact_change(from, t);
  if (turns && std::abs(t - turn->time) < turn->tolerance) t = end_at_kink(from, t, *turn);
  last_step_ = t - from;
  if (adaptive_) next_step_ = h < left || next < next_step_ ? next : std::max(next_step_, next);
  next_step_ = std::min(next_step_, settings_.time_step);
  ++steps_;
  return t;
}

// From where TS is, `from`, to `end` or, where that cannot be solved, not as far. Returns the time reached.
double Stepper::step_to(double from, double end) {
  const double h = end - from;
  system_.begin_trial();
  check(TSSetTimeStep(ts_, h));
  check(TSStep(ts_));
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(ts_, &reason));
  PetscReal t = 0.0;
  check(TSGetTime(ts_, &t));
  if (reason < 0)
    throw StepTooLong("the step of " + std::to_string(h) + " s at t = " + std::to_string(t) +
                      " s could not be taken, not even shortened: " + system_.trouble());
  return t;
}

void Stepper::sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose) {
  PetscReal t = 0.0;
  check(TSGetTime(ts_, &t));
  const bool known = second_order_ && steps_ > 0 && system_.knows_acceleration();
  if (!known) rate(t, y_, rate_, Terms::all);
  ReadArray y(y_);
  ReadArray ydot(rate_);
  if (purpose != Purpose::look) check_bounds(t, y.data);
  sample({t, y.data, known ? system_.acceleration() : ydot.data + system_.structure_unknowns(), nullptr, purpose});
}

// SolverError where the motion is no number any more, or the beam deflects by more than its length.
void Stepper::check_bounds(double t, const double* y) const {
  const auto abs = [](const double* x, int size) { return Eigen::Map<const Eigen::ArrayXd>(x, size).abs(); };
  const int n = system_.local_size(), unknowns = system_.structure_unknowns();
  double bounds[2] = {abs(y, n).sum(), unknowns > 0 ? abs(y, unknowns).maxCoeff() : 0.0};  // of displacements
  MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_DOUBLE, MPI_MAX, system_.comm());
  const bool off = system_.beam() != nullptr && bounds[1] > system_.beam()->model().length();
  if (t == 0.0 && off)
    throw SolverError(
        "at rest the beam deflects by more than its length: what holds it is far too soft for its loads; look at the "
        "units of beam_EI, the foundation's k and the loads");
  if (!std::isfinite(bounds[0]) || off)
    throw StepTooLong("the motion has grown beyond all bounds by t = " + std::to_string(t) +
                      " s: the step is too long for this integrator; use a smaller -ts_dt or an implicit -ts_type");
}

}  // namespace traverse::integrate
