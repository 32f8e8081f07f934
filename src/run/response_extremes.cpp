// Extremes of all probes and wheels, and the difference of two runs: peaks are paired by place, sign and time, and the
// largest and the root mean square deviation are compared.
#include "run/response_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace traverse::app {
namespace {

constexpr double kept = 0.5;           // of the largest extreme so far
constexpr double compared = 0.6;       // of the largest one
constexpr double likely = 2.0;         // times the root mean square: what an extreme's error hardly exceeds
const std::vector<double> smooth;      // without kinks
constexpr std::size_t most = 1 << 16;  // extremes of a quantity; then those below `compared` are let go

bool earlier(const Extreme& a, const Extreme& b) { return a.place != b.place ? a.place < b.place : a.time < b.time; }

std::vector<Extreme> in_order(std::vector<Extreme> peaks) {
  std::sort(peaks.begin(), peaks.end(), earlier);
  return peaks;
}

/// The one of the same place and sign, of those in order, that is nearest in time; null: none is within reach, s.
const Extreme* nearest(const std::vector<Extreme>& peaks, const Extreme& to, double reach) {
  const Extreme* found = nullptr;
  double apart = reach;
  for (auto peak = std::lower_bound(peaks.begin(), peaks.end(), Extreme{0.0, to.time - reach, to.place}, earlier);
       peak != peaks.end() && peak->place == to.place && peak->time <= to.time + reach; ++peak) {
    if (std::abs(peak->time - to.time) > apart || peak->value * to.value < 0.0) continue;
    apart = std::abs(peak->time - to.time);
    found = &*peak;
  }
  return found;
}

}  // namespace

ResponseExtremes::ResponseExtremes(std::vector<std::vector<double>> passages, std::size_t wheels, double lag,
                                   bool axial, bool passages_known)
    : passages_(std::move(passages)),
      lag_(lag),
      axial_(axial),
      forces_(passages_.size(), ProbeForces(axial, passages_known)),
      motions_(passages_.size()),
      wheels_(wheels),
      ranges_(passages_.size()) {
  for (std::size_t q = 0; q < quantities; ++q) each_[q].resize(q == wheel_force ? wheels : passages_.size());
}

ResponseExtremes ResponseExtremes::of_failure() {
  ResponseExtremes none;
  none.failed_ = true;
  return none;
}

void ResponseExtremes::note(Quantity q, std::size_t place, double value, double time) {
  const Extreme peak{value, time, place};
  if (std::abs(value) > std::abs(each_[q][place].value)) each_[q][place] = peak;
  if (std::abs(value) > std::abs(largest_[q].value)) largest_[q] = peak;
  if (std::abs(value) < kept * std::abs(largest_[q].value) || value == 0.0) return;
  std::vector<Extreme>& found = found_[q];
  found.push_back(peak);
  if (found.size() < most) return;
  std::erase_if(found, [&](const Extreme& p) { return std::abs(p.value) < compared * std::abs(largest_[q].value); });
  if (found.size() > most / 2) found.erase(found.begin(), found.end() - most / 2);
}

void ResponseExtremes::record_range(Quantity q, std::size_t probe, double value, double time, double other) {
  auto& [least, greatest] = ranges_[probe][q];
  if (std::isnan(least.time) || value < least.value) least = {value, time, other};
  if (std::isnan(greatest.time) || value > greatest.value) greatest = {value, time, other};
}

auto ResponseExtremes::record_of(Quantity q, std::size_t probe) {
  return [this, q, probe](double value, double at, bool outward) {
    record_range(q, probe, value, at, 0.0);
    if (outward) note(q, probe, value, at);
  };
}

auto ResponseExtremes::record_of_forces(std::size_t probe) {
  return [this, probe](Quantity q, double value, double at, bool outward, double other) {
    record_range(q, probe, value, at, other);
    if (outward) note(q, probe, value, at);
  };
}

void ResponseExtremes::add(double t, std::span<const beam::Response> probes, std::span<const double> wheel_forces) {
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::array values = {probes[i].deflection, probes[i].acceleration, probes[i].axial_displacement};
    const std::size_t known = values.size() - (axial_ ? 0 : 1);
    for (std::size_t m = 0; m < known; ++m) motions_[i][m].add(t, values[m], smooth, record_of(motions[m], i));
    forces_[i].add(t, probes[i], passages_[i], lag_, record_of_forces(i));
    roughness_.acceleration = std::max(roughness_.acceleration, motions_[i][acceleration].bend());
  }
  for (std::size_t i = 0; i < wheel_forces.size(); ++i) {
    wheels_[i].add(t, wheel_forces[i], smooth, [&](double value, double at, bool outward) {
      if (outward) note(wheel_force, i, value, at);
    });
    roughness_.wheel_force = std::max(roughness_.wheel_force, wheels_[i].bend());
  }
}

SecondDifference ResponseExtremes::roughness() const {
  const auto relative = [this](double bend, Quantity q) {
    const double largest = std::abs(largest_[q].value);
    return largest > 0.0 ? bend / largest : 0.0;
  };
  return {relative(roughness_.acceleration, acceleration), relative(roughness_.wheel_force, wheel_force)};
}

double SecondDifference::times(const SecondDifference& others) const {
  const auto ratio = [](double a, double b) { return a > 0.0 ? a / b : 0.0; };
  return std::max(ratio(acceleration, others.acceleration), ratio(wheel_force, others.wheel_force));
}

void ResponseExtremes::finish() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    for (std::size_t m = 0; m < motions.size(); ++m) motions_[i][m].finish(smooth, record_of(motions[m], i));
    forces_[i].finish(passages_[i], lag_, record_of_forces(i));
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i)
    wheels_[i].finish(smooth, [&](double value, double at, bool outward) {
      if (outward) note(wheel_force, i, value, at);
    });
}

namespace {

/// Calls note(value, time) for the outward extremes of one of the series. Returns its curve.
template <class Note>
ExtremumTracker follow(std::span<const double> rows, std::size_t series, std::size_t which, double interval,
                       Note&& note) {
  ExtremumTracker curve;
  double t = 0.0;
  for (std::size_t at = which, k = 0; at < rows.size(); at += series, t = static_cast<double>(++k) * interval)
    curve.add(t, rows[at], smooth, note);
  return curve;
}

}  // namespace

// The last instant is no end of the run: where a curve still rises there, its extreme is not known.
void ResponseExtremes::add_low_passed(std::span<const double> rows, double interval) {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const auto record_it = [&](double value, double at, bool outward) {
      if (outward) note(low_passed, i, value, at);
    };
    follow(rows, motions_.size(), i, interval, record_it).rest(smooth, record_it);
  }
}

Extreme largest_peak(std::span<const double> rows, std::size_t series, double interval) {
  Extreme largest;
  for (std::size_t i = 0; i < series; ++i) {
    const auto note = [&](double value, double time, bool) {
      if (std::abs(value) > std::abs(largest.value)) largest = {value, time, i};
    };
    follow(rows, series, i, interval, note).finish(smooth, note);
  }
  return largest;
}

double peak_difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q) {
  const double largest = std::abs(fine.largest(q).value);
  return largest == 0.0 ? 0.0 : std::abs(std::abs(rough.largest(q).value) - largest) / largest;
}

double difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q, double reach) {
  const double largest = std::abs(fine.largest(q).value);
  if (rough.failed() || fine.failed()) return 1.0;
  if (largest == 0.0) return 0.0;
  // Wheel forces vary about the weight: what is near the largest one is seen by that.
  const double rest = q == wheel_force && !fine.of(q).empty() ? std::abs(fine.of(q).front().value) : 0.0;
  const double least = rest < largest ? rest + compared * (largest - rest) : compared * largest;
  const std::vector<Extreme> others = in_order(rough.of(q)), all = in_order(fine.of(q));
  double squares = 0.0;
  int count = 0;
  for (const Extreme& peak : all) {
    if (std::abs(peak.value) < least) continue;
    const Extreme* other = nearest(others, peak, reach);
    if (other == nullptr || nearest(all, *other, reach) != &peak) continue;
    squares += (other->value - peak.value) * (other->value - peak.value);
    ++count;
  }
  const double spread = count > 0 ? std::sqrt(squares / count) / largest : 0.0;
  return std::max(peak_difference(rough, fine, q), likely * spread);
}

std::vector<std::vector<double>> passages_of(const Scene& scene) {
  std::vector<std::vector<double>> passages(scene.output.probes.size());
  if (!scene.beam || scene.beam->track || scene.analysis != Analysis::transient) return passages;
  std::vector<std::pair<double, base::SpeedLaw>> starts;  // x at t = 0 and how it goes on
  const auto start = [&](double x, const base::SpeedLaw& law) {
    if (law.direction() != 0.0) starts.emplace_back(x, law);
  };
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    if (drive_of(scene.train, i) == train::Drive::constant)
      for (const double x : wheels_at_start(scene, i)) start(x, law_of(scene.train, i));
  for (std::size_t i = 0; i < scene.load.positions.size(); ++i) start(scene.load.positions[i], law_of(scene.load, i));
  for (std::size_t p = 0; p < passages.size(); ++p) {
    for (const auto& [x, law] : starts) {
      const double t = law.time_of(scene.output.probes[p] - x);
      if (t > 0.0 && std::isfinite(t)) passages[p].push_back(t);
    }
    std::sort(passages[p].begin(), passages[p].end());
  }
  return passages;
}

bool knows_passages(const Scene& scene) {
  if (!scene.beam || scene.beam->track || scene.analysis != Analysis::transient) return true;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    if (drive_of(scene.train, i) != train::Drive::constant) return false;
  return true;
}

ResponseExtremes peaks_for(const Scene& scene, std::size_t wheels, double lag) {
  return {passages_of(scene), wheels, lag, scene.beam && scene.beam->axial, knows_passages(scene)};
}

}  // namespace traverse::app
