// Implements the functions that PETSc calls of a TS type: one step with its repetitions, the error estimate, the
// options, and the TSAdapt of the step-size control.
#include "integrate/second_order.hpp"

#include <petsc/private/tsimpl.h>  // types of TS and TSAdapt; number of monitors

#include <algorithm>
#include <limits>
#include <string_view>

#include "base/petsc.hpp"

namespace traverse::integrate {
namespace {

using base::check;
using base::guard;

constexpr double shortening = 0.25;  // factor of the length of a step that could not be solved

struct Data {
  const base::MethodRow* row = nullptr;
  coupling::System* system = nullptr;
  double parameter = 0.0;  // parameter of the method
  bool started = false;
};

Data& data_of(TS ts) { return *static_cast<Data*>(ts->data); }

bool uses_step_size_control(TSAdapt adapt) {
  TSAdaptType type = nullptr;
  check(TSAdaptGetType(adapt, &type));
  return type != nullptr && std::string_view(type) == step_level_adapt;
}

PetscErrorCode set_up(TS ts) {
  return guard([&] {
    Data& data = data_of(ts);
    data.system->begin_motion(data.row->make(data.parameter));
    if (uses_step_size_control(ts->adapt)) data.system->measure_errors();
    check(TSAdaptCandidatesClear(ts->adapt));
    check(TSAdaptCandidateAdd(ts->adapt, nullptr, data.row->order, 1, 1.0, 1.0, PETSC_TRUE));
  });
}

/// The result of the step-size control for a step.
struct Verdict {
  TS ts;
  PetscReal next = 0.0;
  PetscBool accepted = PETSC_FALSE;
  bool evaluate() {
    PetscInt scheme = 0;
    check(TSAdaptChoose(ts->adapt, ts, ts->time_step, &scheme, &next, &accepted));
    return accepted == PETSC_TRUE;
  }
};

// The length for the repetition of a step that could not be solved.
double shorter_step(TS ts, const Verdict& verdict) {
  if (verdict.next > 0.0) return verdict.next;
  const double next = shortening * ts->time_step;
  if (!uses_step_size_control(ts->adapt)) return next;
  StepSizeControl& control = *static_cast<StepSizeControl*>(ts->adapt->data);
  control.evaluate(ts->time_step, std::numeric_limits<double>::infinity());
  return std::min(next, control.allowed_step());
}

void take_step(TS ts, Data& data, double* y) {
  if (!data.started || ts->steprestart == PETSC_TRUE) data.system->restart_motion(ts->ptime, ts->time_step, y);
  data.started = true;
  for (int rejections = 0;; ++rejections) {
    Verdict verdict{ts};
    if (data.system->step_motion(ts->ptime, ts->time_step, y, [&verdict] { return verdict.evaluate(); })) {
      ts->ptime += ts->time_step;
      ts->time_step = verdict.next;
      return;
    }
    const bool unlimited = ts->max_reject < 0, vanished = ts->ptime + ts->time_step == ts->ptime;
    if (vanished || (!unlimited && rejections >= ts->max_reject)) {
      ts->reason = TS_DIVERGED_STEP_REJECTED;
      return;
    }
    ++ts->reject;
    ts->time_step = shorter_step(ts, verdict);
  }
}

PetscErrorCode step_second_order(TS ts) {
  return guard([&] {
    double* y = nullptr;
    check(VecGetArray(ts->vec_sol, &y));
    take_step(ts, data_of(ts), y);
    check(VecRestoreArray(ts->vec_sol, &y));
  });
}

PetscErrorCode read_options(TS ts, base::OptionItems PetscOptionsObject) {
  Data& data = data_of(ts);
  const base::MethodParameter& parameter = data.row->parameter;
  PetscOptionsHeadBegin(PetscOptionsObject, data.row->name);
  if (parameter.option != nullptr)
    PetscCall(PetscOptionsReal(parameter.option, parameter.words, "", data.parameter, &data.parameter, nullptr));
  PetscOptionsHeadEnd();
  return base::success;
}

PetscErrorCode reset(TS ts) {
  data_of(ts).started = false;
  return base::success;
}

PetscErrorCode destroy_second_order(TS ts) {
  delete static_cast<Data*>(ts->data);
  ts->data = nullptr;
  return base::success;
}

// The local error over the tolerance.
PetscErrorCode error_of_step(TS ts, NormType, PetscInt* order, PetscReal* error) {
  return guard([&] {
    const double* y = nullptr;
    check(VecGetArrayRead(ts->vec_sol, &y));
    *order = data_of(ts).row->order;
    *error = data_of(ts).system->step_error(y) / ts->rtol;
    check(VecRestoreArrayRead(ts->vec_sol, &y));
  });
}

// TSSetType has set the name of the type before it calls this.
PetscErrorCode create_second_order(TS ts) {
  return guard([&] {
    TSType type = nullptr;
    check(TSGetType(ts, &type));
    const base::MethodRow* row = base::find_method(type);
    ts->ops->setup = set_up;
    ts->ops->step = step_second_order;
    ts->ops->setfromoptions = read_options;
    ts->ops->reset = reset;
    ts->ops->destroy = destroy_second_order;
    ts->ops->evaluatewlte = error_of_step;
    ts->data = new Data{row, nullptr, row->parameter.value};
  });
}

PetscErrorCode choose(TSAdapt adapt, TS ts, PetscReal h, PetscInt* scheme, PetscReal* next, PetscBool* accept,
                      PetscReal* error, PetscReal* absolute, PetscReal* relative) {
  return guard([&] {
    PetscInt order = PETSC_DECIDE;
    check(TSEvaluateWLTE(ts, adapt->wnormtype, &order, error));
    StepSizeControl& control = *static_cast<StepSizeControl*>(adapt->data);
    *scheme = 0;
    *absolute = *relative = -1.0;  // not distinguished
    *accept = control.evaluate(h, *error) ? PETSC_TRUE : PETSC_FALSE;
    *next = control.allowed_step();
  });
}

PetscErrorCode create_step_size_control(TSAdapt adapt) {
  adapt->ops->choose = choose;
  return base::success;
}

}  // namespace

void register_second_order() {
  check(TSAdaptRegister(step_level_adapt, create_step_size_control));
  for (const base::MethodRow& row : base::methods()) check(TSRegister(row.name, create_second_order));
}

void set_system(TS ts, coupling::System& system) { data_of(ts).system = &system; }

bool has_monitors(TS ts) { return ts->numbermonitors > 0; }

bool& has_started(TS ts) { return data_of(ts).started; }

void set_step_size_control(TS ts, StepSizeControl& control) { ts->adapt->data = &control; }

}  // namespace traverse::integrate
