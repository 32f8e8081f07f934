// The structure by modes in a stage (beam_task.hpp). With v = v~ + displacement a and w = w~ + rate a the equation of
// each mode is
//
//   (1 + 2 sigma rate + omega^2 displacement) a = phi^T forces - 2 sigma w~ - omega^2 v~
//
// The wheels need nodal values: those under the bridge's self-weight plus the sum of phi v.
#pragma once

#include "engine/beam_task.hpp"
#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

/// Entry: double for modes that all runs share, otherwise Row.
template <class Entry>
struct ModalRows {
  BeamTask& t;

  void factorise(Row rate, Row displacement) const {
    const Entry *damping = entries<Entry>(t.modal_damping), *stiffness = entries<Entry>(t.modal_stiffness);
    for (int i = 0; i < t.unknowns; ++i)
      rows(t.pivot)[i] = 1.0 / (1.0 + rate * damping[i] + displacement * stiffness[i]);
    const int* o = t.transverse;
    for (int e = 0; e < t.elements; ++e) {
      const int first = t.first_column[e] * t.block,
                unknown[4] = {first + o[0], first + o[1], first + t.block + o[0], first + t.block + o[1]};
      Row* to = rows(t.compliance) + 10L * e;
      for (int i = 0, n = 0; i < 4; ++i)
        for (int j = i; j < 4; ++j, ++n) {
          const Entry *one = shapes(unknown[i]), *other = shapes(unknown[j]);
          Row sum{};
          for (int k = 0; k < t.unknowns; ++k) sum += one[k] * other[k] * rows(t.pivot)[k];
          to[n] = (i == j ? 1.0 : 2.0) * displacement * sum;
        }
    }
  }

  /// The modal forces without the forces of wheels.
  void find_residual(const TrainTask& train, int stage) const {
    Row *v = rows(t.v_predicted), *w = rows(t.w_predicted);
    combine(stage + 1, train.stage[stage], 0, t.unknowns, t.v, t.w, t.a, v, w);
    t.solution = t.a[stage + 1];
    const Entry *damping = entries<Entry>(t.modal_damping), *stiffness = entries<Entry>(t.modal_stiffness);
    for (int i = 0; i < t.unknowns; ++i) rows(t.residual)[i] = -(damping[i] * w[i] + stiffness[i] * v[i]);
  }

  /// Marks the columns under wheels; no others are loaded or evaluated.
  void set_window(const TrainTask& train, Row /*rate*/, Row /*displacement*/) const {
    for (int c = 0; c < t.columns; ++c) t.under_wheels[c] = 0;
    for (const SurfacePatch& p : train.patch)
      for (int at = 0; at < train.wheels * lanes; ++at) {
        if (p.slot[at] == train.ground) continue;
        const int column = p.slot[at] / lanes / t.block;
        t.under_wheels[column] = t.under_wheels[column + 1] = 1;
      }
  }

  void begin_passes() const {}
  void clear_loads() const {
    for (int i = 0; i < t.columns * t.block; ++i) rows(t.work)[i] = Row{};
  }

  /// Solves the stage under the present forces, in open lanes.
  void solve(Row displacement, RowMask open) const {
    Row* a = rows(t.solution);
    for (int i = 0; i < t.unknowns; ++i) a[i] = open ? rows(t.residual)[i] : a[i];
    for_marked([&](int unknown, const Entry* phi) {
      const Row force = open ? rows(t.work)[unknown] : Row{};
      for (int i = 0; i < t.unknowns; ++i) a[i] += phi[i] * force;
    });
    for (int i = 0; i < t.unknowns; ++i) {
      a[i] = open ? rows(t.pivot)[i] * a[i] : a[i];
      rows(t.modal_stage)[i] = rows(t.v_predicted)[i] + displacement * a[i];
    }
    for_marked([&](int unknown, const Entry* phi) {
      Row value = spread(entries<Entry>(t.dead)[unknown]);
      for (int i = 0; i < t.unknowns; ++i) value += phi[i] * rows(t.modal_stage)[i];
      rows(t.v_stage)[unknown] = value;
    });
  }

  void end_passes(const TrainTask& /*train*/, int /*stage*/) const {}

 private:
  const Entry* shapes(int unknown) const { return entries<Entry>(t.shape) + static_cast<long>(unknown) * t.unknowns; }

  /// Calls use(unknown, its values in the modes).
  template <class Use>
  void for_marked(Use use) const {
    for (int c = 0; c < t.columns; ++c) {
      if (t.under_wheels[c] == 0) continue;
      for (int k = 0; k < t.block; ++k) use(c * t.block + k, shapes(c * t.block + k));
    }
  }
};

}  // namespace
}  // namespace traverse::engine
