// Implements the functions that PETSc calls of a TS type: one step with its repetitions, the error estimate, the
// options, and the TSAdapt that selects steps from the ladder.
#include "integrate/second_order.hpp"

#include <petsc/private/tsimpl.h>  // types of TS and TSAdapt; how many monitors there are

#include <algorithm>
#include <limits>
#include <string_view>

#include "base/petsc.hpp"

namespace traverse::integrate {
namespace {

using base::check;
using base::guard;

constexpr double shorter = 0.25;  // of a step that could not be taken

struct Data {
  const structure::MethodRow* row = nullptr;
  coupling::System* system = nullptr;
  double parameter = 0.0;  // of the method
  bool started = false;
};

Data& data_of(TS ts) { return *static_cast<Data*>(ts->data); }

bool is_ladder(TSAdapt adapt) {
  TSAdaptType type = nullptr;
  check(TSAdaptGetType(adapt, &type));
  return type != nullptr && std::string_view(type) == ladder_adapt;
}

PetscErrorCode set_up(TS ts) {
  return guard([&] {
    Data& data = data_of(ts);
    data.system->begin_motion(data.row->make(data.parameter));
    if (is_ladder(ts->adapt)) data.system->measure_errors();
    check(TSAdaptCandidatesClear(ts->adapt));
    check(TSAdaptCandidateAdd(ts->adapt, nullptr, data.row->order, 1, 1.0, 1.0, PETSC_TRUE));
  });
}

/// What the step control says of a step.
struct Verdict {
  TS ts;
  PetscReal next = 0.0;
  PetscBool accepted = PETSC_FALSE;
  bool ask() {
    PetscInt scheme = 0;
    check(TSAdaptChoose(ts->adapt, ts, ts->time_step, &scheme, &next, &accepted));
    return accepted == PETSC_TRUE;
  }
};

// Of a step that could not be taken.
double shorter_step(TS ts, const Verdict& verdict) {
  if (verdict.next > 0.0) return verdict.next;
  const double next = shorter * ts->time_step;
  if (!is_ladder(ts->adapt)) return next;
  StepSizeControl& ladder = *static_cast<StepSizeControl*>(ts->adapt->data);
  ladder.judge(ts->time_step, std::numeric_limits<double>::infinity());
  return std::min(next, ladder.wanted());
}

void take_step(TS ts, Data& data, double* y) {
  if (!data.started || ts->steprestart == PETSC_TRUE) data.system->restart_motion(ts->ptime, y);
  data.started = true;
  for (int rejections = 0;; ++rejections) {
    Verdict verdict{ts};
    if (data.system->step_motion(ts->ptime, ts->time_step, y, [&verdict] { return verdict.ask(); })) {
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
  const structure::MethodParameter& parameter = data.row->parameter;
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

// TSSetType has named the type before it calls this.
PetscErrorCode create_second_order(TS ts) {
  return guard([&] {
    TSType type = nullptr;
    check(TSGetType(ts, &type));
    const structure::MethodRow* row = structure::find_method(type);
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
    StepSizeControl& ladder = *static_cast<StepSizeControl*>(adapt->data);
    *scheme = 0;
    *absolute = *relative = -1.0;  // not told apart
    *accept = ladder.judge(h, *error) ? PETSC_TRUE : PETSC_FALSE;
    *next = ladder.wanted();
  });
}

PetscErrorCode create_ladder(TSAdapt adapt) {
  adapt->ops->choose = choose;
  return base::success;
}

}  // namespace

void register_second_order() {
  check(TSAdaptRegister(ladder_adapt, create_ladder));
  for (const structure::MethodRow& row : structure::methods()) check(TSRegister(row.name, create_second_order));
}

void set_system(TS ts, coupling::System& system) { data_of(ts).system = &system; }

bool has_monitors(TS ts) { return ts->numbermonitors > 0; }

bool& has_started(TS ts) { return data_of(ts).started; }

void set_ladder(TS ts, StepSizeControl& ladder) { ts->adapt->data = &ladder; }

}  // namespace traverse::integrate
