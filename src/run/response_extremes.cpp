// Extremes of all probes and wheels, the difference of two runs, whose peaks are paired by place, sign and time, with
// the largest and the root mean square deviation, and the datasets of /envelope.
#include "run/response_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace traverse::run {
namespace {

constexpr double stored_share = 0.5;    // relative to the largest extreme so far
constexpr double compared_share = 0.6;  // relative to the largest one
constexpr double spread_factor = 2.0;   // times the root mean square: probable bound of an extreme's error
constexpr std::size_t max_peaks =
    1 << 16;  // largest number for a quantity; if exceeded, peaks below `compared_share` are removed

bool earlier(const Extreme& a, const Extreme& b) { return a.place != b.place ? a.place < b.place : a.time < b.time; }

std::vector<Extreme> sorted(std::vector<Extreme> peaks) {
  std::sort(peaks.begin(), peaks.end(), earlier);
  return peaks;
}

/// The peak nearest in time among the sorted peaks with the same place and sign; null if none is within max_shift, s.
const Extreme* nearest(const std::vector<Extreme>& peaks, const Extreme& to, double max_shift) {
  const Extreme* nearest_peak = nullptr;
  double distance = max_shift;
  for (auto peak = std::lower_bound(peaks.begin(), peaks.end(), Extreme{0.0, to.time - max_shift, to.place}, earlier);
       peak != peaks.end() && peak->place == to.place && peak->time <= to.time + max_shift; ++peak) {
    if (std::abs(peak->time - to.time) > distance || peak->value * to.value < 0.0) continue;
    distance = std::abs(peak->time - to.time);
    nearest_peak = &*peak;
  }
  return nearest_peak;
}

}  // namespace

ResponseExtremes::ResponseExtremes(std::size_t probes, std::size_t wheels, double lag, bool axial, bool twists)
    : lag_(lag),
      axial_(axial),
      forces_(probes, ProbeForces(axial, twists)),
      motions_(probes),
      wheels_(wheels),
      ranges_(probes) {
  for (std::size_t q = 0; q < evaluated_quantities; ++q) largest_of_each_[q].resize(q == wheel_force ? wheels : probes);
}

ResponseExtremes ResponseExtremes::of_failure() {
  ResponseExtremes none;
  none.failed_ = true;
  return none;
}

void ResponseExtremes::record_peak(Quantity q, std::size_t place, double value, double time) {
  const Extreme peak{value, time, place};
  if (std::abs(value) > std::abs(largest_of_each_[q][place].value)) largest_of_each_[q][place] = peak;
  if (std::abs(value) > std::abs(largest_[q].value)) largest_[q] = peak;
  if (std::abs(value) < stored_share * std::abs(largest_[q].value) || value == 0.0) return;
  std::vector<Extreme>& peaks = peaks_[q];
  peaks.push_back(peak);
  if (peaks.size() < max_peaks) return;
  std::erase_if(peaks,
                [&](const Extreme& p) { return std::abs(p.value) < compared_share * std::abs(largest_[q].value); });
  if (peaks.size() > max_peaks / 2) peaks.erase(peaks.begin(), peaks.end() - max_peaks / 2);
}

void ResponseExtremes::record_range(Quantity q, std::size_t probe, double value, double time, double other) {
  auto& [least, greatest] = ranges_[probe][q];
  if (std::isnan(least.time) || value < least.value) least = {value, time, other};
  if (std::isnan(greatest.time) || value > greatest.value) greatest = {value, time, other};
}

auto ResponseExtremes::recorder_of(Quantity q, std::size_t probe) {
  return [this, q, probe](double value, double at, bool outward) {
    record_range(q, probe, value, at, 0.0);
    if (outward) record_peak(q, probe, value, at);
  };
}

auto ResponseExtremes::recorder_of_forces(std::size_t probe) {
  return [this, probe](Quantity q, double value, double at, bool outward, double other) {
    record_range(q, probe, value, at, other);
    if (outward) record_peak(q, probe, value, at);
  };
}

void ResponseExtremes::add(double t, Values<recovery::Response> probes, Values<double> wheel_forces,
                           std::span<const recovery::StationPassage> passages) {
  const auto at_probe = [&passages](std::size_t probe) {  // removes them, and those before them, from the list
    const auto past = [&](std::size_t limit) {
      return static_cast<std::size_t>(
          std::find_if(passages.begin(), passages.end(), [&](const auto& p) { return p.station >= limit; }) -
          passages.begin());
    };
    passages = passages.subspan(past(probe));
    const auto first = passages.first(past(probe + 1));
    passages = passages.subspan(first.size());
    return first;
  };
  for (const std::size_t i : probes.which) {
    const recovery::Response& probe = probes.of_all[i];
    const std::array values = {probe.relative_deflection, probe.acceleration, probe.axial_displacement};
    const std::size_t known = values.size() - (axial_ ? 0 : 1);
    for (std::size_t m = 0; m < known; ++m) motions_[i][m].add(t, values[m], no_kinks, recorder_of(motions[m], i));
    forces_[i].add(t, probe, at_probe(i), lag_, recorder_of_forces(i));
  }
  for (const std::size_t i : wheel_forces.which) {
    wheels_[i].add(t, wheel_forces.of_all[i], no_kinks, [&](double value, double at, bool outward) {
      if (outward) record_peak(wheel_force, i, value, at);
    });
  }
}

void ResponseExtremes::finish() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    for (std::size_t m = 0; m < motions.size(); ++m) motions_[i][m].finish(no_kinks, recorder_of(motions[m], i));
    forces_[i].finish(lag_, recorder_of_forces(i));
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i)
    wheels_[i].finish(no_kinks, [&](double value, double at, bool outward) {
      if (outward) record_peak(wheel_force, i, value, at);
    });
}

namespace {

/// Calls record(value, time) for the extremes of one of the series, and returns its tracker.
template <class Record>
ExtremumTracker track_series(std::span<const double> rows, std::size_t series, std::size_t which, double interval,
                             Record&& record) {
  ExtremumTracker curve;
  double t = 0.0;
  for (std::size_t at = which, k = 0; at < rows.size(); at += series, t = static_cast<double>(++k) * interval)
    curve.add(t, rows[at], no_kinks, record);
  return curve;
}

}  // namespace

// The last instant is not the end of the run: the extreme of a curve that rises there is unknown.
void ResponseExtremes::add_low_passed(std::span<const double> rows, double interval) {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const auto record = [&](double value, double at, bool outward) {
      if (outward) record_peak(low_passed, i, value, at);
    };
    track_series(rows, motions_.size(), i, interval, record).record_last(no_kinks, record);
  }
}

// Only samples near the largest one can belong to the largest extreme. The five samples around each of them determine
// the interpolated extreme.
Extreme largest_peak(std::span<const double> rows, std::size_t series, double interval, std::size_t first) {
  double greatest = 0.0;
  for (const double value : rows) greatest = std::max(greatest, std::abs(value));
  Extreme largest;
  const std::size_t last = rows.size() / std::max<std::size_t>(series, 1);
  for (std::size_t at = 0; at < rows.size(); ++at) {
    const double value = std::abs(rows[at]);
    if (value < share_of_largest_sample * greatest) continue;
    const std::size_t k = at / series, i = at % series;
    const bool inner = k > 0 && k + 1 < last;
    if (inner && (value < std::abs(rows[at - series]) || value < std::abs(rows[at + series]))) continue;
    const std::size_t from = k - std::min<std::size_t>(k, 2), past = std::min(k + 3, last);
    const auto record = [&](double extreme, double time, bool) {
      if (std::abs(extreme) > std::abs(largest.value)) largest = {extreme, time, i};
    };
    ExtremumTracker curve;
    for (std::size_t j = from; j < past; ++j)
      curve.add(static_cast<double>(first + j) * interval, rows[j * series + i], no_kinks, record);
    if (past == last) curve.finish(no_kinks, record);
  }
  return largest;
}

double peak_difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q) {
  const double largest = std::abs(fine.largest(q).value);
  return largest == 0.0 ? 0.0 : std::abs(std::abs(rough.largest(q).value) - largest) / largest;
}

double difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q, double max_shift) {
  const double largest = std::abs(fine.largest(q).value);
  if (rough.failed() || fine.failed()) return 1.0;
  if (largest == 0.0) return 0.0;
  // Wheel forces vary about the weight: the threshold is relative to the largest variation.
  const double weight = q == wheel_force && !fine.of(q).empty() ? std::abs(fine.of(q).front().value) : 0.0;
  const double least = weight < largest ? weight + compared_share * (largest - weight) : compared_share * largest;
  const std::vector<Extreme> others = sorted(rough.of(q)), all = sorted(fine.of(q));
  double squares = 0.0;
  int count = 0;
  for (const Extreme& peak : all) {
    if (std::abs(peak.value) < least) continue;
    const Extreme* other = nearest(others, peak, max_shift);
    if (other == nullptr || nearest(all, *other, max_shift) != &peak) continue;
    squares += (other->value - peak.value) * (other->value - peak.value);
    ++count;
  }
  const double spread = count > 0 ? std::sqrt(squares / count) / largest : 0.0;
  return std::max(peak_difference(rough, fine, q), spread_factor * spread);
}

ResponseExtremes peaks_for(const scene::Scene& scene, std::size_t wheels, double lag) {
  return {scene.output.probes.size(), wheels, lag, scene.beam && scene.beam->axial,
          scene.beam && scene.beam->torsion.has_value()};
}

std::vector<results::Recorder::Dataset> envelopes(const ResponseExtremes& peaks, bool forces) {
  std::vector<results::Recorder::Dataset> sets;
  if (peaks.probes() == 0) return sets;
  const auto add = [&](const std::string& name, Quantity q, double Range::End::*number, const char* unit) {
    std::vector<double> values;
    for (std::size_t p = 0; p < peaks.probes(); ++p)
      values.insert(values.end(), {peaks.range(q, p).least.*number, peaks.range(q, p).greatest.*number});
    sets.push_back({"/envelope/" + name, {peaks.probes(), 2}, std::move(values), unit});
  };
  const auto add_with_times = [&](const std::string& name, Quantity q, const char* unit) {
    add(name, q, &Range::End::value, unit);
    add(name + "_time", q, &Range::End::time, "s");
  };
  add_with_times("deflection", deflection, "m");
  add_with_times("acceleration", acceleration, "m/s2");
  if (!forces) return sets;
  add_with_times("moment", moment, "N m");
  add_with_times("shear", shear_force, "N");
  add("moment_shear", moment, &Range::End::other, "N");
  add("shear_moment", shear_force, &Range::End::other, "N m");
  return sets;
}

}  // namespace traverse::run
