// Superposes the modes to nodal displacements, velocities and accelerations at each sample, and adds the static
// correction, the static response of all modes that are not included.
//
// The steps are those of a TS of the type modal, which PETSc does not have: the exact motion of modes under moving
// forces, y = (q, q'), the same on every rank. A step of any length, also with events inside it, is computed in closed
// form; there is no right-hand side, no stage and no error estimate.
#include "integrate/modal_stepper.hpp"

#include <petsc/private/tsimpl.h>  // a type of TS

#include <algorithm>
#include <limits>
#include <numbers>

#include "base/petsc.hpp"
#include "beam/shape.hpp"
#include "integrate/second_order.hpp"
#include "train/wheel_paths.hpp"
#include "traverse/options/input.hpp"

namespace traverse::integrate {
namespace {

using base::check;

constexpr const char* type_name = "modal";

ModalMotion& motion_of(TS ts) { return *static_cast<ModalMotion*>(ts->data); }

void copy_solution(const ModalMotion& motion, Vec y) {
  double* values = nullptr;
  check(VecGetArray(y, &values));
  std::copy(motion.q().begin(), motion.q().end(), values);
  std::copy(motion.rate().begin(), motion.rate().end(), values + motion.q().size());
  check(VecRestoreArray(y, &values));
}

PetscErrorCode step_modal(TS ts) {
  return base::guard([&] {
    motion_of(ts).advance(ts->ptime + ts->time_step);
    ts->ptime += ts->time_step;
    copy_solution(motion_of(ts), ts->vec_sol);
  });
}

PetscErrorCode view(TS ts, PetscViewer viewer) {
  return PetscViewerASCIIPrintf(viewer, "  %d modes, exact in time\n", static_cast<int>(motion_of(ts).q().size()));
}

PetscErrorCode destroy_modal(TS ts) {  // the motion belongs to its owner
  ts->data = nullptr;
  return base::success;
}

PetscErrorCode create_modal(TS ts) {
  ts->ops->step = step_modal;
  ts->ops->view = view;
  ts->ops->destroy = destroy_modal;
  ts->usessnes = PETSC_FALSE;
  ts->default_adapt_type = TSADAPTNONE;
  return base::success;
}

/// A TS of type modal on `motion`, which must outlive it, at the motion's time. Reads PETSc's options.
base::Handle<TS> make_modal_ts(ModalMotion& motion) {
  check(TSRegister(type_name, create_modal));
  base::Handle<TS> ts;
  base::Handle<Vec> y;
  const auto size = static_cast<PetscInt>(2 * motion.q().size());
  check(VecCreateSeq(PETSC_COMM_SELF, size, y.out()));
  copy_solution(motion, y);
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  check(TSSetType(ts, type_name));
  static_cast<TS>(ts)->data = &motion;
  check(TSSetSolution(ts, y));
  check(TSSetTime(ts, motion.time()));
  check(TSSetMaxSteps(ts, std::numeric_limits<PetscInt>::max() - 1));
  check(TSSetMaxTime(ts, std::numeric_limits<double>::max()));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_STEPOVER));
  try {
    check(TSSetFromOptions(ts));
  } catch (const SolverError& error) {
    options::refuse_by_petsc(error.what());
  }
  return ts;
}

constexpr double just_before =
    1e-12;  // relative to the run's duration: at a jump the samples have the values before it
// Phase of the fastest mode between two instants for peaks, rad: the degree of their interpolation is four
// (base/extremum.hpp), and its error 3e-4 of the amplitude of this mode.
constexpr double phase_per_step = 0.2 * std::numbers::pi;

}  // namespace

ModalStepper::ModalStepper(coupling::System& system, const structure::ModalBridge& bridge,
                           structure::BeamOperator& statics, const coupling::SystemInput& input, bool equilibrium,
                           double end_time, double interval, long stored)
    : system_(system),
      bridge_(bridge),
      statics_(statics),
      load_(input.load),
      history_(bridge.influence(), input.load),
      motion_(bridge, history_, input.load.speed, equilibrium),
      end_time_(end_time),
      interval_(interval),
      stored_(stored) {
  const auto n = static_cast<std::size_t>(system_.structure_unknowns());
  sagging_.assign(n, 0.0);
  if (input.self_weight) {
    bridge_.beam().add_self_weight(input.gravity, sagging_.data());
    for (std::size_t k = 0; k < n; ++k)
      if (bridge_.beam().fixed()[k] != 0) sagging_[k] = 0.0;
    statics_.solve_static(sagging_.data());
  }
  y_.assign(static_cast<std::size_t>(system_.local_size()), 0.0);
  acceleration_.assign(n, 0.0);
  force_.assign(n, 0.0);
  drag_.assign(n, 0.0);
  shapes_.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(bridge_.modes()));
  for (std::size_t i = 0; i < bridge_.modes(); ++i)
    std::copy_n(bridge_.shape(i), n, shapes_.col(static_cast<Eigen::Index>(i)).data());
  amplitude_.resize(shapes_.cols());
  share_.resize(shapes_.cols() + 1);
  longest_step_ = phase_per_step / *std::max_element(bridge_.omega().begin(), bridge_.omega().end());
  has_drag_ = *std::max_element(bridge_.own_drag().begin(), bridge_.own_drag().end()) > 0.0;
  motion_.integrate_energy();
  motion_.prepare(interval_ / instants());
  ts_ = make_modal_ts(motion_);
  base::check(TSGetMaxSteps(ts_, &most_steps_));
  base::check(TSSetMaxSteps(ts_, std::numeric_limits<PetscInt>::max() - 1));  // counted here
}

std::string ModalStepper::method() const { return std::to_string(bridge_.modes()) + " modes, exact in time"; }

void ModalStepper::begin(const std::function<void(const Instant&)>& sample) {
  if (begun_) return;
  system_.begin_step(0.0, 0.0);
  call_monitors();
  sample_now(sample, Purpose::sample);
  begun_ = true;
}

double ModalStepper::run(const std::function<void(const Instant&)>& sample,
                         const std::function<bool(double, long)>& step, const std::function<void(double)>& between) {
  const double slack = 1e-3 * std::min(interval_, end_time_);
  begin(sample);
  for (bool running = true; running && motion_.time() < end_time_ - slack;) {
    if (between) between(motion_.time());
    double t = static_cast<double>(steps_ + 1) * interval_;
    const bool ends_between_samples = t > end_time_ + slack;  // the end is not a multiple of the interval
    if (t > end_time_ - slack) t = end_time_;
    const double from = static_cast<double>(steps_) * interval_, parts = std::ceil((t - from) / longest_step_);
    for (double part = 1.0; running && part < parts; ++part) {
      const double at = from + (t - from) * part / parts;
      if (at <= motion_.time()) continue;  // computed before the run was stopped
      advance(at);
      sample_now(sample, Purpose::peaks);
      running = step(motion_.time(), steps_);
    }
    if (!running) break;
    advance(t);
    ++steps_;
    call_monitors();
    const bool stored = steps_ % stored_ == 0 && !ends_between_samples;
    sample_now(sample, stored ? Purpose::sample : t == end_time_ ? Purpose::end : Purpose::peaks);
    running = step(t, steps_) && !stopped_at_limit();
  }
  return motion_.time();
}

// Forces that enter or leave at t are not, or still, on the bridge.
void ModalStepper::advance(double t) {
  base::check(TSSetTimeStep(ts_, t - motion_.time()));
  base::check(TSStep(ts_));
  system_.begin_step(t - 2.0 * just_before * end_time_, t);
}

void ModalStepper::keep(base::Archive& archive) {
  archive.same(motion_, steps_, at_start_, begun_);
  statics_.keep(archive, [](long) { return nullptr; });
  base::check(TSSetTime(ts_, motion_.time()));
}

void ModalStepper::call_monitors() {
  if (!has_monitors(ts_)) return;
  Vec y = nullptr;
  base::check(TSGetSolution(ts_, &y));
  base::check(TSMonitor(ts_, static_cast<PetscInt>(steps_), motion_.time(), y));
}

// This rank's nodal forces; at a jump the forces before it.
void ModalStepper::nodal_loads(double* nodal) const {
  const beam::Line& line = bridge_.beam().bridge();
  std::fill_n(nodal, force_.size(), 0.0);
  for (std::size_t j = 0; j < load_.forces.size(); ++j) {
    const double t = motion_.time(), before = t > 0.0 ? t - just_before * end_time_ : 0.0;
    const double x = load_.positions[j] + load_.speed * before;
    if (!train::is_on_line(line.mesh.start(), line.mesh.end(), x, load_.speed)) continue;
    const beam::Station s = line.mesh.locate(load_.positions[j] + load_.speed * t);
    const auto parts = structure::on_unknowns(line, {s.element, s.xi, 0.0, -load_.forces[j]});
    line.for_unknowns(s.element, [&](int k, int unknown, double factor) {
      const int local = bridge_.beam().local(unknown);
      if (local >= 0 && bridge_.beam().fixed()[local] == 0) nodal[local] += factor * parts[static_cast<std::size_t>(k)];
    });
  }
}

void ModalStepper::sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose) {
  const auto n = shapes_.rows(), m = shapes_.cols();
  const auto of_modes = [m](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::ArrayXd>(values.data(), m);
  };
  const auto nodal = [n](double* values) { return Eigen::Map<Eigen::VectorXd>(values, n); };
  auto v = nodal(y_.data()), w = nodal(y_.data() + n), a = nodal(acceleration_.data()), force = nodal(force_.data());
  // The static correction first: K* v = forces P and dampers' forces, minus the modes' share.
  nodal_loads(force_.data());
  bridge_.add_forces_on_others(motion_.rate().data(), force_.data());
  v = force;
  statics_.solve_static(v.data());
  // The modal forces, and twice the energy of the static deflections, J.
  share_.head(m).noalias() = shapes_.transpose() * force;
  share_[m] = v.dot(force);
  MPI_Allreduce(MPI_IN_PLACE, share_.data(), static_cast<int>(share_.size()), MPI_DOUBLE, MPI_SUM, system_.comm());
  const auto omega = of_modes(bridge_.omega());
  const double stored = 0.5 * (share_[m] - (share_.head(m).array() / omega).square().sum());
  if (!begun_) at_start_ = stored;

  amplitude_ = of_modes(motion_.q()) - share_.head(m).array() / omega.square();
  v.noalias() += shapes_ * amplitude_.matrix();
  v += nodal(sagging_.data());
  w.noalias() = shapes_ * of_modes(motion_.rate()).matrix();
  a.noalias() = shapes_ * of_modes(motion_.acceleration()).matrix();
  if (has_drag_) {
    amplitude_ = of_modes(bridge_.own_drag()) * of_modes(motion_.rate());
    nodal(drag_.data()).noalias() = shapes_ * amplitude_.matrix();
  }
  if (const std::size_t energies = 2 * force_.size(); y_.size() > energies) {  // the rank that stores the energies
    y_[energies] = motion_.dissipated();
    y_[energies + 1] = motion_.work() + stored - at_start_;  // forces have supplied the energy of the correction
  }
  sample({motion_.time(), y_.data(), acceleration_.data(), has_drag_ ? drag_.data() : nullptr, purpose});
}

}  // namespace traverse::integrate
