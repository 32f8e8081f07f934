#include "traverse/integrate/second_order.hpp"

#include <petsc/private/tsimpl.h>

#include <string_view>

#include "traverse/base/petsc.hpp"

namespace traverse::integrate {
namespace {

using base::check;
using base::guard;

constexpr double shorter = 0.25;  // of a step that could not be taken
constexpr double default_radius = 0.9;

struct Data {
  coupling::System* system = nullptr;
  double radius = default_radius;  // of generalised-alpha
  bool started = false;
};

Data& data_of(TS ts) { return *static_cast<Data*>(ts->data); }

bool is(TS ts, std::string_view type) {
  TSType own = nullptr;
  check(TSGetType(ts, &own));
  return own != nullptr && own == type;
}

PetscErrorCode set_up(TS ts) {
  return guard([&] {
    Data& data = data_of(ts);
    data.system->begin_motion(is(ts, esdirk4_type) ? coupling::esdirk4() : coupling::generalised_alpha(data.radius));
  });
}

void take_step(TS ts, Data& data, double* y) {
  if (!data.started || ts->steprestart == PETSC_TRUE) data.system->restart_motion(ts->ptime, y);
  data.started = true;
  for (int rejections = 0; !data.system->step_motion(ts->ptime, ts->time_step, y); ++rejections) {
    if (rejections >= ts->max_reject) {
      ts->reason = TS_DIVERGED_STEP_REJECTED;
      return;
    }
    ++ts->reject;
    ts->time_step *= shorter;
  }
  ts->ptime += ts->time_step;
}

PetscErrorCode step(TS ts) {
  return guard([&] {
    double* y = nullptr;
    check(VecGetArray(ts->vec_sol, &y));
    take_step(ts, data_of(ts), y);
    check(VecRestoreArray(ts->vec_sol, &y));
  });
}

PetscErrorCode read_options(TS ts, PetscOptionItems* PetscOptionsObject) {
  double& radius = data_of(ts).radius;
  PetscOptionsHeadBegin(PetscOptionsObject, "Generalised-alpha");
  PetscCall(PetscOptionsReal("-ts_genalpha_radius", "what is left after a step of a fast oscillation, 0 to 1", "",
                             radius, &radius, nullptr));
  PetscOptionsHeadEnd();
  return 0;
}

PetscErrorCode reset(TS ts) {
  data_of(ts).started = false;
  return 0;
}

PetscErrorCode destroy(TS ts) {
  delete static_cast<Data*>(ts->data);
  ts->data = nullptr;
  return 0;
}

PetscErrorCode create(TS ts) {
  ts->ops->setup = set_up;
  ts->ops->step = step;
  ts->ops->setfromoptions = read_options;
  ts->ops->reset = reset;
  ts->ops->destroy = destroy;
  ts->data = new Data;
  return 0;
}

}  // namespace

void register_second_order() {
  check(TSRegister(esdirk4_type, create));
  check(TSRegister(genalpha_type, create));
}

bool is_second_order(TS ts) { return is(ts, esdirk4_type) || is(ts, genalpha_type); }

void set_system(TS ts, coupling::System& system) { data_of(ts).system = &system; }

}  // namespace traverse::integrate
