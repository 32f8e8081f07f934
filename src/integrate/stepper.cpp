// Creates and configures the PETSc TS, and runs the loop over steps up to the next sample or known event, with the
// choice of each step length and the check for unbounded motion.
#include "integrate/stepper.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <string_view>

#include "integrate/integrators.hpp"
#include "second_order.hpp"
#include "structure/beam_operator.hpp"
#include "traverse/options/input.hpp"

namespace traverse::integrate {
namespace {

using base::check;

constexpr PetscInt no_limit = std::numeric_limits<PetscInt>::max() - 1;  // number of steps; TS requires a limit
constexpr int most_rejections = 12;        // limit for one step; each rejection reduces its length to a quarter
constexpr double near_event = 1e-3;        // fraction of a step: closer events share the end of a step
constexpr double restart_growth = 2.0;     // largest growth of steps of a method that reuses accelerations
constexpr long steps_between_checks = 16;  // between two checks that the motion is bounded
constexpr double reused_step = 1e-7;       // relative difference of step lengths that need no new factorisation
constexpr double full_turn = 2.0 * std::numbers::pi;  // rad

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
  // The scene defines time and step; TS computes one step at a time without a final time.
  check(TSSetTime(ts_, 0.0));
  check(TSSetMaxTime(ts_, std::numeric_limits<double>::max()));
  check(TSSetExactFinalTime(ts_, TS_EXACTFINALTIME_STEPOVER));
  check(TSSetTimeStep(ts_, settings_.time_step));
  TSAdaptType adapt_type = nullptr;
  check(TSAdaptGetType(adapt, &adapt_type));
  adaptive_ = std::string_view(adapt_type) != TSADAPTNONE;
  if (std::string_view(adapt_type) == step_level_adapt)
    set_step_size_control(ts_, step_control_.emplace(shared_evenly(settings_.interval, settings_.time_step)));
  next_step_ = settings_.time_step;
  set_up_type();
}

void Stepper::set_up_type() {
  TSType name = nullptr;
  check(TSGetType(ts_, &name));
  if (const base::MethodRow* own = base::find_method(name)) {
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
  if (!implicit_) return check(TSSetRHSFunction(ts_, nullptr, rhs_function, this));
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

StepCount Stepper::count_steps(double end, double step, double interval) {
  std::vector<double> stops;
  std::merge(settings_.events.begin(), settings_.events.end(), settings_.crossing_times.begin(),
             settings_.crossing_times.end(), std::back_inserter(stops));
  StepCount count = integrate::count_steps(end, interval, step, stops, structure::stored_factors);
  if (!settings_.kinks || multistep_) return count;
  system_.list_kinks(end, step);
  const double turns = 2.0 * system_.kink_passages();  // a wheel begins and ends to turn about each
  return {count.steps + turns, count.lengths + turns};
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
    text = std::string("arkimex ") + which + ", implicit";
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
  if (progress_.begun) return;
  if (settings_.kinks) system_.list_kinks(settings_.end_time, settings_.time_step);
  sample_now(sample, Purpose::sample);
  {
    Array y(y_);
    system_.accept(progress_.t, y.data);
  }
  call_monitors(progress_.t);
  progress_.begun = true;
}

double Stepper::run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
                    const std::function<void(double)>& between) {
  const double slack = near_event * std::min({settings_.time_step, settings_.interval, settings_.end_time});
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::max(settings_.end_time, 1.0);
  Progress& progress = progress_;
  double& t = progress.t;
  begin(sample);
  for (bool running = true; running && t < settings_.end_time - slack;) {
    if (!progress.under_way) set_target(slack);
    while (running && t < progress.target) {
      if (between) between(t);
      t = take_step(t, progress.target - t);
      if (t > progress.target - rounding) {
        t = progress.target;
        check(TSSetTime(ts_, t));
      }
      Array y(y_);
      const bool rewritten = system_.accept(t, y.data);
      if (rewritten) check(TSRestartStep(ts_));
      if (steps_ % steps_between_checks == 0) check_bounds(t, y.data);
      call_monitors(t);
      running = step(t, steps_) && !stopped_at_limit();
      if (system_.contacts().leaves_guide(settings_.contact_tolerance)) sample_now(sample, Purpose::exit);
      if (t != progress.next_sample) sample_now(sample, Purpose::peaks);
    }
    progress.under_way = t < progress.target;
    if (t == progress.next_sample) {
      const bool stored = ++progress.samples % settings_.stored == 0 && !progress.ends_between_samples;
      sample_now(sample, stored ? Purpose::sample : t == settings_.end_time ? Purpose::end : Purpose::peaks);
    }
  }
  return t;
}

void Stepper::serve() {
  check(TSSetUp(ts_));
  Array y(y_);
  system_.serve(y.data);
}

// Sets the next time at which a step must end.
void Stepper::set_target(double slack) {
  progress_.under_way = true;
  progress_.next_sample = static_cast<double>(progress_.samples + 1) * settings_.interval;
  progress_.ends_between_samples =
      progress_.next_sample > settings_.end_time + slack;  // the end is not a multiple of the interval
  if (progress_.next_sample > settings_.end_time - slack) progress_.next_sample = settings_.end_time;
  progress_.target = progress_.next_sample;
  const auto stop_at = [&](const std::vector<double>& times, std::size_t& next) {
    while (next < times.size() && times[next] <= progress_.t + slack) ++next;
    if (next < times.size() && times[next] < progress_.target - slack) progress_.target = times[next];
  };
  stop_at(settings_.events, progress_.event);
  stop_at(settings_.crossing_times, progress_.crossing);
}

// TS computes single steps and calls no monitors in them.
void Stepper::call_monitors(double t) {
  if (!monitored_) return;
  check(TSMonitor(ts_, static_cast<PetscInt>(steps_), t, y_));
}

// The next step towards a target in `remaining` s: a step-size level (longest step times 2^-k), or `remaining` divided
// into equal steps. If the target moves a little, the step and thus the beam's factorisation are unchanged.
double Stepper::next_step(double from, double remaining) const {
  const double limit = system_.contacts().step_limit(from);
  const double impact = system_.contacts().time_to_impact(settings_.contact_tolerance);
  if (step_control_) return std::min(step_control_->next_step(remaining, limit), impact);
  const double allowed = std::min({adaptive_ ? next_step_ : settings_.time_step, limit, impact});
  const double even = shared_evenly(remaining, allowed);
  const bool reuse =
      even < remaining && last_step_ <= allowed && std::abs(even - last_step_) <= reused_step * last_step_;
  return reuse ? last_step_ : even;
}

// One step from the time of TS, not longer than the time to the next target. Returns the new time.
double Stepper::take_step(double from, double remaining) {
  const auto kink_event = next_kink(from, remaining);
  if (kink_event) remaining = kink_event->time - from;
  const double h = next_step(from, remaining);
  // generalised-alpha, like multistep methods, reuses an acceleration of an earlier instant
  const bool reuses_acceleration = multistep_ || (second_order_ && !high_order_);
  if (reuses_acceleration && last_step_ > 0.0 && (h > restart_growth * last_step_)) check(TSRestartStep(ts_));
  if (system_.begin_step(from, from + h)) {  // a jump: a known rate is valid only before it
    known_ = false;
    check(TSRestartStep(ts_));
  }
  const bool ends_at_kink = kink_event && h == remaining;
  const bool locating = settings_.contact_tolerance > 0.0 && system_.fleet().contacts() > 0;
  if (second_order_)
    system_.store_steps(locating || ends_at_kink);
  else if (locating || ends_at_kink)
    check(VecCopy(y_, before_));
  double t = step_to(from, ends_at_kink ? kink_event->time : from + h);
  PetscReal next = 0.0;
  check(TSGetTimeStep(ts_, &next));
  if (locating) t = locate_contact_change(from, t);
  if (ends_at_kink && std::abs(t - kink_event->time) < kink_event->tolerance) t = end_at_kink(from, t, *kink_event);
  last_step_ = t - from;
  if (adaptive_) next_step_ = h < remaining || next < next_step_ ? next : std::max(next_step_, next);
  next_step_ = std::min(next_step_, settings_.time_step);
  ++steps_;
  return t;
}

// Computes a step from `from`, the time of TS, to `end`, or a shorter one if that cannot be solved. Returns the new
// time.
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
                      " s could not be taken, not even shortened: " + system_.failure_reason());
  return t;
}

void Stepper::sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose) {
  PetscReal t = 0.0;
  check(TSGetTime(ts_, &t));
  const bool known = second_order_ && steps_ > 0 && system_.provides_acceleration();
  if (!known) rate(t, y_, rate_);
  ReadArray y(y_);
  ReadArray ydot(rate_);
  if (is_stored(purpose)) check_bounds(t, y.data);
  sample({t, y.data, known ? nullptr : ydot.data + system_.structure_unknowns(), nullptr, purpose});
}

// Throws SolverError if the motion is not finite, or if the beam deflects by more than its length or turns over.
void Stepper::check_bounds(double t, const double* y) const {
  double sum = Eigen::Map<const Eigen::ArrayXd>(y, system_.local_size()).abs().sum();
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_MAX, system_.comm());
  const structure::Extent extent = system_.extent(y);
  const bool deflects_too_much = system_.beam() != nullptr && (extent.displacement > system_.beam()->model().length() ||
                                                               extent.rotation > full_turn);
  if (t == 0.0 && deflects_too_much)
    throw SolverError(
        "at rest the beam deflects by more than its length or turns over: what holds it is far too soft for its loads; "
        "look at the units of beam_EI, the foundation's k and the loads");
  if (!std::isfinite(sum) || deflects_too_much)
    throw StepTooLong("the motion has grown beyond all bounds by t = " + std::to_string(t) +
                      " s: the step is too long for this integrator; use a smaller -ts_dt or an implicit -ts_type");
}

}  // namespace traverse::integrate
