// The functions that TS calls: PETSc's implicit types solve their stages by System::solve_stage behind a SNESSHELL, its
// explicit ones evaluate System::rate.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrate/stepper.hpp"
#include "second_order.hpp"

namespace traverse::integrate {

using base::check;
using base::guard;

// Whether the last solved stage is the given state: its rate is known then.
bool Stepper::is_last_stage(double t, const double* y) const {
  int same = known_ && std::abs(t - known_t_) <= 1e-13 * std::max(1.0, std::abs(t)) &&
                     std::memcmp(y, known_y_.data(), known_y_.size() * sizeof(double)) == 0
                 ? 1
                 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, system_.comm());
  return same != 0;
}

void Stepper::rate(double t, Vec y, Vec ydot) {
  ReadArray in(y);
  Array out(ydot);
  if (is_last_stage(t, in.data))
    std::copy(known_rate_.begin(), known_rate_.end(), out.data);
  else
    system_.rate(t, in.data, out.data);
}

// Computes F = y' - G, or during a stage solution only records the request.
void Stepper::implicit_residual(double t, Vec y, Vec ydot, Vec residual) {
  if (request_.recording) {
    request_.t = t;
    request_.start = y != request_.unknown;
    if (request_.start) {  // PETSc 3.20 and later: ARKIMEX needs y' of its first explicit stage
      PetscReal now = 0.0;
      check(TSGetTime(ts_, &now));
      return rate(now, y, residual);
    }
    ReadArray xdot(ydot);
    std::copy_n(xdot.data, stage_c_.size(), stage_c_.begin());
    return;
  }
  rate(t, y, residual);
  check(VecAYPX(residual, -1.0, ydot));
}

void Stepper::solve_stage(SNES snes, Vec x) {
  request_.recording = true;
  request_.unknown = x;
  check(SNESComputeFunction(snes, x, residual_));
  if (request_.start) {
    request_.recording = false;
    return check(VecCopy(residual_, x));
  }
  check(SNESComputeJacobian(snes, x, jacobian_, jacobian_));
  request_.recording = false;
  Vec right_side = nullptr;
  check(SNESGetRhs(snes, &right_side));
  Array y(x);
  const std::size_t n = stage_c_.size();
  for (std::size_t i = 0; i < n; ++i) stage_c_[i] -= request_.shift * y.data[i];
  if (right_side != nullptr) {
    ReadArray b(right_side);
    for (std::size_t i = 0; i < n; ++i) stage_c_[i] -= b.data[i];
  }
  if (!system_.solve_stage(request_.t, request_.shift, stage_c_.data(), y.data)) {
    known_ = false;
    check(SNESSetConvergedReason(snes, SNES_DIVERGED_MAX_IT));
    return;
  }
  known_ = true;
  known_t_ = request_.t;
  for (std::size_t i = 0; i < n; ++i) {
    known_y_[i] = y.data[i];
    known_rate_[i] = request_.shift * y.data[i] + stage_c_[i];
  }
}

PetscErrorCode Stepper::ifunction(TS, PetscReal t, Vec y, Vec ydot, Vec residual, void* context) {
  return guard([&] { static_cast<Stepper*>(context)->implicit_residual(t, y, ydot, residual); });
}

PetscErrorCode Stepper::ijacobian(TS, PetscReal, Vec, Vec, PetscReal shift, Mat, Mat, void* context) {
  static_cast<Stepper*>(context)->request_.shift = shift;
  return base::success;
}

PetscErrorCode Stepper::rhs_function(TS, PetscReal t, Vec y, Vec ydot, void* context) {
  return guard([&] { static_cast<Stepper*>(context)->rate(t, y, ydot); });
}

PetscErrorCode Stepper::shell_solve(SNES snes, Vec x) {
  return guard([&] {
    void* context = nullptr;
    check(SNESShellGetContext(snes, &context));
    static_cast<Stepper*>(context)->solve_stage(snes, x);
  });
}

}  // namespace traverse::integrate
