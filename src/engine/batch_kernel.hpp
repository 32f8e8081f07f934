// A stage of a batch (batch_task.hpp): the structure under the forces of its wheels, by elements (beam_kernel.hpp) or
// by modes, then these forces again (train_kernel.hpp), repeated in each lane until no force changes.
//
// With v = v~ + displacement a and w = w~ + rate a the equation of each mode is
//
//   (1 + 2 sigma rate + omega^2 displacement) a = phi^T forces - 2 sigma w~ - omega^2 v~
//
// The wheels need nodal values: those under the bridge's self-weight plus the sum of phi v.
#pragma once

#include "engine/batch_peaks.hpp"
#include "engine/batch_task.hpp"
#include "engine/beam_kernel.hpp"
#include "engine/train_kernel.hpp"
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

namespace {

inline constexpr int most_passes = 60;
inline constexpr double height_reach =
    2e-5;  // m: contacts that move less than this reuse the parabola of the track's height

/// The row of an element's first nodal value under wheels.
inline int first_row(const BeamTask& beam, int element) {
  return beam.lever == nullptr ? beam.first_column[element] * beam.block : beam.track_row + element * beam.values;
}

/// Sets the patches of a wheel in one lane.
inline void place_wheel(const BatchTask& task, int at, int lane) {
  TrainTask& train = *task.train;
  const BeamTask& beam = *task.beam;
  const SurfaceTable& table = task.surface[task.table[at]];
  int& k = task.interval[at];
  k = find_interval(table, train.along[at], k);
  set_patches(train, at, table.patches[k]);
  for (int n = 0; n < 2; ++n) {
    const int element = table.patches[k].patch[n].element;
    SurfacePatch& p = train.patch[n];
    p.slot[at] = element < 0 ? train.ground : first_row(beam, element) * lanes + lane;
    for (int i = 0; i < 10; ++i)
      p.compliance[i][at] = element < 0 ? 0.0 : beam.compliance[(10L * element + i) * lanes + lane];
  }
}

/// Calls function(structure) with the task's BeamRows or ModalRows.
template <class Use>
void with_structure(BeamTask& task, Use use) {
  if (task.shape != nullptr)
    task.shared ? use(ModalRows<double>{task}) : use(ModalRows<Row>{task});
  else if (task.block == 2)
    use(BeamRows<2>{task});
  else if (task.block == 3)
    use(BeamRows<3>{task});
  else
    use(BeamRows<0>{task});
}

/// Sets the patches of the wheels that have left theirs, or of all wheels. Returns whether there were any.
inline bool place_wheels(const BatchTask& task, bool all) {
  bool moved = false;
  TrainTask& train = *task.train;
  for (int i = 0; i < train.wheels; ++i) {
    const Row x = rows(train.along)[i];
    const RowMask out = (x < rows(train.from)[i]) | (x > rows(train.to)[i]);
    if (!all && !Rows::any(out)) continue;
    moved = true;
    bool second_used = false;
    for (int l = 0; l < lanes; ++l) {
      const int at = i * lanes + l;
      if (all || Rows::is_set(out, l)) place_wheel(task, at, l);
      second_used |= task.surface[task.table[at]].patches[task.interval[at]].candidates > 1;
    }
    task.touches_two_patches[i] = second_used ? 1 : 0;
    for (SurfacePatch& p : train.patch) {
      const int* slot = p.slot + i * lanes;
      bool contiguous_slots = slot[0] != train.ground, ground = !contiguous_slots;
      for (int l = 1; l < lanes; ++l) {
        contiguous_slots = contiguous_slots && slot[l] == slot[0] + l;
        ground = ground && slot[l] == train.ground;
      }
      p.slot_order[i] = ground ? all_ground : contiguous_slots ? contiguous : scattered;
    }
  }
  return moved;
}

/// Computes track heights for contacts that have moved farther than `within`. Returns the lanes with such contacts.
inline RowMask interpolate_heights(const BatchTask& task, double within) {
  const HeightTable& track = task.heights;
  RowMask moved{};
  if (track.stations == 0) return moved;
  TrainTask& train = *task.train;
  const double per = 1.0 / track.distance, last = static_cast<double>(track.stations - 1);
  const long stride = track.shared ? 1 : lanes;
  for (int i = 0; i < train.wheels; ++i) {
    const Row x = rows(train.station)[i];
    const RowMask outside = Rows::magnitude(x - rows(train.profile_station)[i]) > within;
    if (!Rows::any(outside)) continue;
    moved |= outside;
    Row at = (x - track.start) * per, u{}, h0{}, s0{}, h1{}, s1{};
    at = at > 0.0 ? at : Row{};  // also for NaN
    at = at < last ? at : Rows::fill(last);
    for (int l = 0; l < lanes; ++l) {
      long k = static_cast<long>(Rows::numbers(at)[l]);
      if (k > track.stations - 2) k = track.stations - 2;
      const double* values = track.values + 2 * k * stride + (track.shared ? 0 : l);
      Rows::numbers(u)[l] = Rows::numbers(at)[l] - static_cast<double>(k);
      Rows::numbers(h0)[l] = values[0];
      Rows::numbers(s0)[l] = values[stride];
      Rows::numbers(h1)[l] = values[2 * stride];
      Rows::numbers(s1)[l] = values[3 * stride];
    }
    const Row c2 = 3.0 * (h1 - h0) - 2.0 * s0 - s1, c3 = s0 + s1 - 2.0 * (h1 - h0);
    const auto store = [&](double* to, Row value) { rows(to)[i] = outside ? value : rows(to)[i]; };
    store(train.profile_station, x);
    store(train.h, h0 + u * (s0 + u * (c2 + u * c3)));
    store(train.h_x, per * (s0 + u * (2.0 * c2 + 3.0 * u * c3)));
    store(train.h_xx, per * per * (2.0 * c2 + 6.0 * u * c3));
  }
  return moved;
}

/// Solves one implicit stage in all lanes: predicts, then iterates structure and contact forces until they converge;
/// failures are written to task.failed. distance: m that all runs have travelled; new_step: the length of steps has
/// changed.
template <Surface kind>
void solve_batch_stage(const BatchTask& task, int stage, double distance, bool new_step) {
  TrainTask& train = *task.train;
  BeamTask& beam = *task.beam;
  const Row rate = row(train.stage[stage].rate), displacement = row(train.stage[stage].displacement);
  for (int k = 0; k < train.blocks; ++k) *rows(task.distance[k]) = Rows::fill(distance);
  predict(train, stage, task.work);
  const bool moved = place_wheels(task, new_step);
  interpolate_heights(task, 0.0);
  Row& failed = *rows(task.failed);
  with_structure(beam, [&](const auto& structure) {
    if (moved) structure.set_window(train, rate, displacement);
    structure.find_residual(train, stage);
    structure.begin_passes();
    RowMask iterating = failed == Row{};
    for (int k = 0; k < train.blocks; ++k) rows(train.converged)[k] = Row{};
    for (int pass = 0; Rows::any(iterating); ++pass) {
      structure.clear_loads();
      add_loads<kind>(train);
      structure.solve(displacement, iterating);
      const Changes changes = update_forces<kind>(train, iterating);
      failed = iterating & changes.below_surface ? Rows::fill(below_surface) : failed;
      iterating &= (changes.largest_change > train.tolerance) | interpolate_heights(task, height_reach);
      iterating &= failed == Row{};
      if (pass < most_passes) continue;
      failed = iterating ? Rows::fill(not_converged) : failed;
      break;
    }
    structure.end_passes(train, stage);
  });
  end_stage_of_train<kind>(train, stage, false);
}

}  // namespace

}  // namespace traverse::engine
