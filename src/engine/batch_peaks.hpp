// Observation of a batch (batch_task.hpp): peaks at the probes and extremes of wheel forces, also between steps, in
// each lane as for a single run (base/extremum.hpp).
#pragma once

#include "base/extremum.hpp"
#include "engine/batch_task.hpp"
#include "engine/train_vehicles.hpp"

namespace traverse::engine {
namespace {

inline constexpr double near_peak = 0.9;  // of the largest magnitude so far: no extremum below it can be larger
inline constexpr int latest = kept_samples - 1;

inline RowMask runs_until(const BatchTask& t, double distance) {
  return distance / row(t.speed) <= row(t.end_time) * (1.0 + 1e-12);
}

inline double* rotate_samples(double** samples) {
  double* const oldest = samples[0];
  for (int i = 0; i < latest; ++i) samples[i] = samples[i + 1];
  return samples[latest] = oldest;
}

template <class Entry>
Row product(const ProbeForms& p, const double* form, const double* values) {
  Row sum{};
  for (int i = 0; i < p.count; ++i) sum += entries<Entry>(form)[i] * rows(values)[p.unknown[i]];
  return sum;
}

/// The contributions of wheels on the probe's element to its deflection and moment.
template <class Entry>
void add_wheels(const BatchTask& t, const ProbeForms& p, Row& deflection, Row& moment) {
  const TrainTask& train = *t.train;
  const Row length = Rows::fill(p.to - p.from);
  const bool beside = t.beam->lever != nullptr;
  for (int i = 0; i < train.wheels; ++i) {
    const Row x = rows(train.station)[i], force = rows(train.force_up)[i];
    const RowMask inside_element = (x >= p.from) & (x <= p.to) & (force != 0.0);
    if (!Rows::any(inside_element)) continue;
    const Row lever =
        rows(train.normal)[i] * (rows(train.normal_along)[i] + rows(train.normal_up)[i] * rows(train.turn)[i]);
    const Row load[] = {inside_element ? -force : Row{}, inside_element ? train.surface_height * lever : Row{},
                        beside ? row(t.beam->lever) * (inside_element ? -force : Row{}) : Row{}};
    const Row xi = (x - p.from) / length;
    const RowMask left = x < p.x;
    const bool acts[] = {true, train.surface_height != 0.0, beside};
    for (int kind = 0; kind < ProbeForms::kinds; ++kind) {
      if (!acts[kind]) continue;
      const auto by = [&](int response) {
        Row on_left{}, on_right{};
        const Entry* of_left = entries<Entry>(p.inside) + (2 * kind + response) * ProbeForms::powers;
        const Entry* of_right = of_left + ProbeForms::inner / 2;
        for (int k = ProbeForms::powers - 1; k >= 0; --k) {
          on_left = on_left * xi + of_left[k];
          on_right = on_right * xi + of_right[k];
        }
        return load[kind] * (left ? on_left : on_right);
      };
      deflection += by(0);
      moment += by(1);
    }
  }
}

/// Computes the responses of the probes after a step from `before`, m.
template <class Entry>
void evaluate_probes(const BatchTask& t, double before) {
  PeakState& s = *t.peaks;
  const BeamTask& beam = *t.beam;
  const int n = t.probes;
  Row* response = rows(rotate_samples(s.response));
  const Row h = (s.distance[latest] - before) / row(t.speed);
  for (int k = 0; k < n; ++k) {
    const ProbeForms& p = t.probe[k];
    Row deflection = spread(entries<Entry>(p.constant)[0]), interior_moment = spread(entries<Entry>(p.constant)[1]);
    const double* const state[3] = {beam.v, beam.w, beam.a[0]};
    for (int d = 0; d < 3; ++d) {
      deflection += product<Entry>(p, p.deflection[d], state[d]);
      interior_moment += product<Entry>(p, p.moment[d], state[d]);
    }
    add_wheels<Entry>(t, p, deflection, interior_moment);
    Row &known = rows(s.interior_moment)[k], &lagged_moment = rows(s.interior_moment_lagged)[k];
    if (!s.lags || s.samples == 1) {
      lagged_moment = interior_moment;
    } else {
      Row decay = -h / row(s.lag);
      for (int l = 0; l < lanes; ++l) Rows::numbers(decay)[l] = __builtin_exp(Rows::numbers(decay)[l]);
      const Row late = row(s.lag) * (interior_moment - known) / h;
      lagged_moment = interior_moment - late + (lagged_moment - known + late) * decay;
    }
    known = interior_moment;
    response[k] = deflection;
    response[n + k] = product<Entry>(p, p.acceleration, beam.a[0]);
    response[2 * n + k] = product<Entry>(p, p.nodal_moment, beam.v) + lagged_moment;
    response[3 * n + k] =
        product<Entry>(p, p.nodal_moment, beam.w) + (s.lags ? (interior_moment - lagged_moment) / row(s.lag) : Row{});
  }
  Row sum{};
  for (int i = 0; i < beam.unknowns; ++i) sum += rows(beam.v)[i];
  Row& failed = rows(t.failed)[0];
  failed = (sum - sum == Row{}) | (failed != Row{}) ? failed : Rows::fill(not_finite);
}

/// The samples that interpolate a curve about sample m; known: number of samples since the last kink.
inline base::Stencil stencil(const double* at, int m, long known) {
  return {at, m, known < kept_samples ? kept_samples - static_cast<int>(known) : 0};
}

/// The extremum of the curve of row i near sample m, and its distance behind m.
inline Row extremum(const double* at, double* const* response, int i, int m, const base::Stencil& by, bool five,
                    Row& behind) {
  Row y[kept_samples];
  for (int k = 0; k < kept_samples; ++k) y[k] = rows(response[k])[i];
  return base::extreme_between(at, y, m, by, five, behind);
}

/// Raises row i of `peaks` to a value with its time.
inline void raise(double* peaks, double* times, int i, RowMask counts, Row value, Row time) {
  Row &peak = rows(peaks)[i], &at = rows(times)[i];
  const RowMask larger = counts & (value > peak);
  peak = larger ? value : peak;
  at = larger ? time : at;
}

inline void record_peak(const BatchTask& t, int i, RowMask counts, Row value, Row time) {
  raise(t.peaks->peak, t.peaks->peak_time, i, counts, value, time);
}

/// Records the magnitudes of linear combinations of rows.
template <class Entry>
void record_forms(const LinearForm* forms, int count, const double* values, double* peaks, double* times,
                  RowMask counts, Row time) {
  for (int k = 0; k < count; ++k) {
    const LinearForm& form = forms[k];
    Row value = form.constant != nullptr ? spread(entries<Entry>(form.constant)[0]) : Row{};
    for (int i = 0; i < form.count; ++i) value += entries<Entry>(form.coefficient)[i] * rows(values)[form.row[i]];
    raise(peaks, times, k, counts, Rows::magnitude(value), time);
  }
}

/// Response i, if its magnitude at sample m is larger than at the neighbouring samples.
inline void interpolate_peak(const BatchTask& t, int i, int m) {
  const PeakState& s = *t.peaks;
  const bool is_moment = i >= 2 * t.probes;
  if (is_moment && s.lags) return;
  const auto y = [&](int k) { return rows(s.response[k])[i]; };
  const Row middle = Rows::magnitude(y(m));
  const RowMask large = (middle > near_peak * rows(s.peak)[i]) & (middle > Rows::magnitude(y(m + 1)));
  if (!Rows::any(large)) return;
  const double* at = s.distance;
  const base::Stencil by = stencil(at, m, is_moment ? s.samples_since_kink : s.samples);
  if (!by.three) return;
  const RowMask turns = large & runs_until(t, at[m + 1]) & ((y(m) - y(by.left)) * (y(by.right) - y(m)) <= Row{}) &
                        (middle >= Rows::magnitude(y(m - 1)));
  if (!Rows::any(turns)) return;
  Row behind;
  const Row top = Rows::magnitude(extremum(at, s.response, i, m, by, by.five, behind));
  record_peak(t, i, turns, top, (at[m] + behind) / row(t.speed));
}

/// A moment with viscous lag, between the last two samples.
inline void interpolate_lagging_peak(const BatchTask& t, int i, RowMask counts) {
  const PeakState& s = *t.peaks;
  const int rate = i + t.probes;
  const Row *last = rows(s.response[latest]), *before_last = rows(s.response[latest - 1]);
  const Row start = before_last[i], rising = before_last[rate], falling = last[rate];
  const RowMask turns = counts & (rising * falling < Row{}) & (rising * start > Row{}) &
                        (Rows::greater(Rows::magnitude(start), Rows::magnitude(last[i])) > near_peak * rows(s.peak)[i]);
  if (!Rows::any(turns)) return;
  const Row began = s.distance[latest - 1] / row(t.speed), h = s.distance[latest] / row(t.speed) - began;
  for (int l = 0; l < lanes; ++l) {
    if (!Rows::is_set(turns, l)) continue;
    double later = 0.0;
    const double top = base::extreme_of_lagging(Rows::numbers(h)[l], Rows::numbers(start)[l], Rows::numbers(last[i])[l],
                                                Rows::numbers(rising)[l], Rows::numbers(falling)[l],
                                                Rows::numbers(row(s.lag))[l], later);
    const double size = top < 0.0 ? -top : top;
    if (size <= Rows::numbers(rows(s.peak)[i])[l]) continue;
    Rows::numbers(rows(s.peak)[i])[l] = size;
    Rows::numbers(rows(s.peak_time)[i])[l] = Rows::numbers(began)[l] + later;
  }
}

inline void update_probe_peaks(const BatchTask& t, RowMask counts) {
  const PeakState& s = *t.peaks;
  const int n = t.probes;
  for (int i = 0; i < 3 * n; ++i) {
    record_peak(t, i, counts, Rows::magnitude(rows(s.response[latest])[i]), s.distance[latest] / row(t.speed));
    if (i < 2 * n || !s.lags)
      interpolate_peak(t, i, 2);
    else if (s.samples >= 2)
      interpolate_lagging_peak(t, i, counts);
  }
}

/// Whether a wheel that started at x has passed no kink of the surface between two distances.
inline bool smooth(const BatchTask& t, double x, double from, double to) {
  for (int i = 0; i < t.kinks; ++i)
    if (t.kink[i] >= x + from && t.kink[i] <= x + to) return false;
  return true;
}

inline void record_least(const BatchTask& t, int wheel, RowMask counts, Row force, Row time) {
  Row &least = rows(t.peaks->least)[wheel], &at = rows(t.peaks->least_time)[wheel];
  const RowMask smaller = counts & (force < least);
  least = smaller ? force : least;
  at = smaller ? time : at;
}

/// Extremes of wheel forces between steps, interpolated near sample m.
inline void interpolate_forces(const BatchTask& t, int m) {
  const PeakState& s = *t.peaks;
  const double* at = s.distance;
  const base::Stencil by = stencil(at, m, s.samples);
  if (!by.three) return;
  const RowMask counts = runs_until(t, at[m + 1]);
  for (int j = 0; j < t.train->wheels; ++j) {
    const auto y = [&](int k) { return rows(s.force[k])[j]; };
    const Row F = y(m);
    if (!Rows::any((F > near_peak * row(s.greatest)) | (near_peak * F < rows(s.least)[j]))) continue;
    const Row before = F - y(by.left), after = y(by.right) - F;
    const RowMask turns =
        counts & (before * after <= Row{}) & ((F - y(m - 1)) * (y(m + 1) - F) <= Row{}) & (after != Row{});
    const double x = t.train->place[static_cast<long>(j) * lanes];
    if (!Rows::any(turns) || !smooth(t, x, at[by.left], at[by.right])) continue;
    Row behind, top = extremum(at, s.force, j, m, by, false, behind);
    if (by.five && smooth(t, x, at[0], at[latest])) {
      RowMask touched = y(0) > Row{};
      for (int i = 1; i < kept_samples; ++i) touched &= y(i) > Row{};
      top = touched ? extremum(at, s.force, j, m, by, true, behind) : top;
    }
    record_least(t, j, turns & (top > Row{}), top, (at[m] + behind) / row(t.speed));
    Row& greatest = rows(s.greatest)[0];
    greatest = turns & (top > greatest) ? top : greatest;
  }
}

/// Records the wheels that have lost contact in the last step, and those that have regained it.
inline void record_losses(const BatchTask& t, RowMask counts) {
  const PeakState& s = *t.peaks;
  const Row now = s.distance[latest] / row(t.speed), before = s.distance[latest - 1] / row(t.speed);
  for (int j = 0; j < t.train->wheels; ++j) {
    const Row force = rows(s.force[latest])[j];
    Row& contact_lost_time = rows(s.contact_lost_time)[j];
    const RowMask lost = counts & (force <= 0.0) & (contact_lost_time < 0.0),
                  found = (force > 0.0) & (contact_lost_time >= 0.0);
    if (!Rows::any(lost | found)) continue;
    Row &contact_loss_count = rows(s.contact_loss_count)[0], &longest_contact_loss = rows(s.longest_contact_loss)[0];
    contact_loss_count += lost ? Rows::fill(1.0) : Row{};
    const Row loss_duration = now - contact_lost_time;
    longest_contact_loss = found & (loss_duration > longest_contact_loss) ? loss_duration : longest_contact_loss;
    contact_lost_time = lost ? before : found ? Rows::fill(-1.0) : contact_lost_time;
  }
}

inline void update_wheel_forces(const BatchTask& t, RowMask counts, bool moved) {
  PeakState& s = *t.peaks;
  Row *now = rows(rotate_samples(s.force)), &greatest = rows(s.greatest)[0];
  const Row time = s.distance[latest] / row(t.speed);
  for (int j = 0; j < t.train->wheels; ++j) {
    const Row force = now[j] = rows(t.train->normal)[j];
    if (!moved) rows(s.at_start)[j] = force;
    record_least(t, j, counts, force, time);
    greatest = counts & (force > greatest) ? force : greatest;
  }
  if (!moved) return;
  interpolate_forces(t, 2);
  record_losses(t, counts);
}

/// Records the coordinates of each vehicle at the largest upper bound of its linearisation residual.
inline void record_departures(const BatchTask& t) {
  const PeakState& s = *t.peaks;
  for (int k = 0; k < t.train->blocks; ++k) {
    const VehicleBlock& b = t.train->block[k];
    if (*b.active == 0) continue;
    Row residual_root{}, &most = rows(s.largest_residual_root)[k];
    for (int i = b.first_coordinate; i < b.first_coordinate + b.freedom; ++i)
      residual_root += rows(t.roots)[i] * Rows::magnitude(rows(t.train->x)[i]);
    const RowMask larger = residual_root > most;
    if (!Rows::any(larger)) continue;
    most = larger ? residual_root : most;
    for (int i = b.first_coordinate; i < b.first_coordinate + b.freedom; ++i)
      rows(s.coordinates_at_largest)[i] = larger ? rows(t.train->x)[i] : rows(s.coordinates_at_largest)[i];
  }
}

/// After a step, with the wheels at `distance` m; moved: false at the start.
inline void sample(const BatchTask& t, double distance, bool moved) {
  PeakState& s = *t.peaks;
  const double before = s.distance[latest];
  for (int i = 0; i < latest; ++i) s.distance[i] = s.distance[i + 1];
  s.distance[latest] = distance;
  ++s.samples_since_kink;
  ++s.samples;
  const RowMask counts = runs_until(t, distance);
  const Row time = distance / row(t.speed);
  const auto observe_structure = [&](auto entry) {
    using Entry = decltype(entry);
    evaluate_probes<Entry>(t, before);
    record_forms<Entry>(t.rotation, t.rotations, t.beam->v, s.rotation, s.rotation_time, counts, time);
  };
  t.beam->shared ? observe_structure(double{}) : observe_structure(Row{});
  record_forms<Row>(t.car, t.cars, t.train->a[0], s.car, s.car_time, counts, time);
  update_probe_peaks(t, counts);
  update_wheel_forces(t, counts, moved);
  if (moved) record_departures(t);
}

/// Interpolates peaks just before a kink of the following motion.
inline void end_peaks_at_kink(const BatchTask& t) {
  for (int i = 2 * t.probes; i < 3 * t.probes; ++i) interpolate_peak(t, i, latest - 1);
  t.peaks->samples_since_kink = 1;
}

/// After the last sample.
inline void finish_peaks(const BatchTask& t) {
  for (int i = 0; i < 3 * t.probes; ++i) interpolate_peak(t, i, latest - 1);
  interpolate_forces(t, latest - 1);
}

}  // namespace
}  // namespace traverse::engine
