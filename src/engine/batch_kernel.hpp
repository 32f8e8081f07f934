// A stage of a batch (batch_task.hpp): the structure under the forces of its wheels, then these forces again
// (train_kernel.hpp), repeated in each lane until no force changes.
#pragma once

#include "engine/batch_peaks.hpp"
#include "engine/beam_kernel.hpp"
#include "engine/modal_kernel.hpp"
#include "engine/train_kernel.hpp"

namespace traverse::engine {
namespace {

inline constexpr int most_passes = 60;
inline constexpr double height_reach =
    2e-5;  // m: contacts that move less than this reuse the parabola of the track's height

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
    p.slot[at] = element < 0 ? train.ground : beam.first_column[element] * beam.block * lanes + lane;
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
