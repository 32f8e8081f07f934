// A stage of runs side by side (batch_task.hpp): the structure under the forces of its wheels, these forces anew
// (train_kernel.hpp), and so on until none changes any more, lane by lane.
#pragma once

#include "engine/batch_peaks.hpp"
#include "engine/beam_kernel.hpp"
#include "engine/modal_kernel.hpp"
#include "engine/train_kernel.hpp"

namespace traverse::engine {
namespace {

inline constexpr int most_passes = 60;
inline constexpr double near_look_up = 2e-5;  // m: as far a track's parabola is exact

/// The wheel of one lane on other patches.
inline void place_wheel(const BatchTask& t, int at, int lane) {
  TrainTask& train = *t.train;
  const BeamTask& beam = *t.beam;
  const SurfaceTable& table = t.surface[t.table[at]];
  int& k = t.there[at];
  k = follow(table, train.along[at], k);
  put_on(train, at, table.there[k]);
  for (int n = 0; n < 2; ++n) {
    const int element = table.there[k].patch[n].element;
    SurfacePatch& p = train.patch[n];
    p.slot[at] = element < 0 ? train.ground : beam.first_column[element] * beam.block * lanes + lane;
    for (int i = 0; i < 10; ++i)
      p.compliance[i][at] = element < 0 ? 0.0 : beam.compliance[(10L * element + i) * lanes + lane];
  }
}

/// use(the structure), as BeamRows of its blocks or as ModalRows.
template <class Use>
void with_structure(BeamTask& task, Use use) {
  if (task.shape != nullptr)
    use(ModalRows{task});
  else if (task.block == 2)
    use(BeamRows<2>{task});
  else if (task.block == 3)
    use(BeamRows<3>{task});
  else if (task.block == 5)
    use(BeamRows<5>{task});
  else
    use(BeamRows<0>{task});
}

/// Those that have left theirs, or all; whether there are any.
inline bool place_wheels(const BatchTask& t, bool all) {
  bool moved = false;
  TrainTask& train = *t.train;
  for (int i = 0; i < train.wheels; ++i) {
    const Row x = rows(train.along)[i];
    const RowMask out = (x < rows(train.from)[i]) | (x > rows(train.to)[i]);
    if (!all && !Rows::any(out)) continue;
    moved = true;
    bool two = false;
    for (int l = 0; l < lanes; ++l) {
      const int at = i * lanes + l;
      if (all || Rows::holds(out, l)) place_wheel(t, at, l);
      two |= t.surface[t.table[at]].there[t.there[at]].candidates > 1;
    }
    t.second[i] = two ? 1 : 0;
    for (SurfacePatch& p : train.patch) {
      const int* slot = p.slot + i * lanes;
      bool follow = slot[0] != train.ground, ground = !follow;
      for (int l = 1; l < lanes; ++l) {
        follow = follow && slot[l] == slot[0] + l;
        ground = ground && slot[l] == train.ground;
      }
      p.together[i] = ground ? grounded : follow ? in_line : apart;
    }
  }
  return moved;
}

/// Heights of the track where contacts have moved farther than `within`; lanes with such ones.
inline RowMask look_up_heights(const BatchTask& t, double within) {
  const HeightTable& track = t.heights;
  RowMask moved{};
  if (track.stations == 0) return moved;
  TrainTask& train = *t.train;
  const double per = 1.0 / track.distance, last = static_cast<double>(track.stations - 1);
  const long stride = track.shared ? 1 : lanes;
  for (int i = 0; i < train.wheels; ++i) {
    const Row x = rows(train.station)[i];
    const RowMask anew = Rows::magnitude(x - rows(train.looked_up)[i]) > within;
    if (!Rows::any(anew)) continue;
    moved |= anew;
    Row at = (x - track.start) * per, u{}, h0{}, s0{}, h1{}, s1{};
    at = at > 0.0 ? at : Row{};  // one that is no number, too
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
    const Row second = 3.0 * (h1 - h0) - 2.0 * s0 - s1, third = s0 + s1 - 2.0 * (h1 - h0);
    const auto take = [&](double* to, Row value) { rows(to)[i] = anew ? value : rows(to)[i]; };
    take(train.looked_up, x);
    take(train.h, h0 + u * (s0 + u * (second + u * third)));
    take(train.h_x, per * (s0 + u * (2.0 * second + 3.0 * u * third)));
    take(train.h_xx, per * per * (2.0 * second + 6.0 * u * third));
  }
  return moved;
}

/// gone: m that all runs have travelled then; anew: steps have another length than before.
template <Surface kind>
void solve_batch_stage(const BatchTask& t, int stage, double gone, bool anew) {
  TrainTask& train = *t.train;
  BeamTask& beam = *t.beam;
  const Row rate = row(train.stage[stage].rate), displacement = row(train.stage[stage].displacement);
  for (int k = 0; k < train.blocks; ++k) *rows(t.distance[k]) = Rows::fill(gone);
  combine(stage + 1, train.stage[stage], 0, beam.unknowns, beam.v, beam.w, beam.a, rows(beam.v_predicted),
          rows(beam.w_predicted));
  predict(train, stage, t.work);
  const bool moved = place_wheels(t, anew);
  look_up_heights(t, 0.0);
  Row& failed = *rows(t.failed);
  with_structure(beam, [&](const auto& structure) {
    if (moved) structure.mark(train, rate, displacement);
    structure.find_residual(rate, displacement);
    structure.begin_passes();
    RowMask open = failed == Row{};
    for (int k = 0; k < train.blocks; ++k) rows(train.settled)[k] = Row{};
    for (int pass = 0; Rows::any(open); ++pass) {
      structure.clear_loads();
      add_loads<kind>(train);
      structure.solve(displacement, open);
      const Changes changes = update_forces<kind>(train, open);
      failed = open & changes.fallen ? Rows::fill(below_surface) : failed;
      open &= (changes.most > train.tolerance) | look_up_heights(t, near_look_up);
      open &= failed == Row{};
      if (pass < most_passes) continue;
      failed = open ? Rows::fill(not_converged) : failed;
      break;
    }
    structure.end_passes();
    structure.accelerations(rate, rows(beam.a[stage + 1]));
  });
  end_stage_of_train<kind>(train, stage, false);
}

}  // namespace
}  // namespace traverse::engine
