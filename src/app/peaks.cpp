#include "traverse/app/peaks.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::app {
namespace {

constexpr double kept = 0.5;           // of the largest extreme so far
constexpr double compared = 0.9;       // of the largest one
constexpr double likely = 1.5;         // times the root mean square: what an extreme's error hardly exceeds
constexpr double off_centre = 2e-3;    // m: a wheel on a slope touches the beam so far from its centre, at most
constexpr std::size_t most = 1 << 16;  // extremes of a quantity; then those below `compared` are let go

bool between(const std::vector<double>& times, double from, double to) {
  const auto next = std::lower_bound(times.begin(), times.end(), from);
  return next != times.end() && *next <= to;
}

}  // namespace

// Through three samples from `first` on.
Curve::Point Curve::parabola(std::size_t first, double t) const {
  const double *x = &time_[first], *y = &value_[first];
  const double slope = (y[1] - y[0]) / (x[1] - x[0]);
  const double bend = ((y[2] - y[1]) / (x[2] - x[1]) - slope) / (x[2] - x[0]);
  return {y[0] + (t - x[0]) * (slope + bend * (t - x[1])), slope + bend * (2.0 * t - x[0] - x[1])};
}

// Of a kink between the middle two of the samples; a sample so near it that it may lie on the other side is not used.
Peak Curve::where_sides_meet(double at, double uncertain) const {
  const Point left = parabola(at - time_[3] > uncertain ? 1 : 0, at);
  const Point right = parabola(time_[4] - at > uncertain ? 4 : 5, at);
  const double bend = left.slope - right.slope, gap = right.value - left.value;
  const double shift = std::abs(gap) < std::abs(bend) * uncertain ? gap / bend : 0.0;
  return {0.5 * (left.value + right.value + shift * (left.slope + right.slope)), at + shift};
}

template <class Note>
void Curve::at_kinks(const Kinks& kinks, Note&& note) {
  const std::vector<double>& times = kinks.times;
  while (kink_ < times.size() && times[kink_] <= time_[3]) ++kink_;
  for (; kink_ < times.size() && times[kink_] <= time_[4]; ++kink_) {
    const bool others = (kink_ > 0 && times[kink_ - 1] >= time_[0]) ||
                        (kink_ + 1 < times.size() && times[kink_ + 1] <= time_[last]);
    const std::size_t larger = std::abs(value_[3]) > std::abs(value_[4]) ? 3 : 4;
    const Peak peak =
        others ? Peak{value_[larger], time_[larger]} : where_sides_meet(times[kink_], kinks.uncertain);
    note(peak.value, peak.time);
  }
}

template <class Note>
void Curve::add(double t, double value, const Kinks& kinks, Note&& note) {
  std::copy(time_.begin() + 1, time_.end(), time_.begin());
  std::copy(value_.begin() + 1, value_.end(), value_.begin());
  time_[last] = t;
  value_[last] = value;
  if (++count_ == 1) return note(value, t);
  if (count_ < 3) return;
  const double before = value_[last - 2], middle = value_[last - 1];
  const bool highest = std::abs(middle) >= std::abs(before) && std::abs(middle) > std::abs(value);
  if (highest && (count_ < width || !between(kinks.times, time_[last - 2], t))) {
    const double dt1 = time_[last - 1] - time_[last - 2], dt2 = t - time_[last - 1];
    const double slope = ((middle - before) / dt1 * dt2 + (value - middle) / dt2 * dt1) / (dt1 + dt2);
    const double bend = ((value - middle) / dt2 - (middle - before) / dt1) / (dt1 + dt2);
    const double shift = before * value > 0.0 ? -slope / (2.0 * bend) : 0.0;
    note(middle + 0.5 * slope * shift, time_[last - 1] + shift);
  }
  if (count_ >= width) at_kinks(kinks, note);
}

Peaks::Peaks(std::vector<Kinks> passages, std::size_t wheels)
    : passages_(std::move(passages)), probes_(passages_.size()), wheels_(wheels) {}

void Peaks::note(Quantity q, std::size_t place, double value, double time) {
  const Peak peak{value, time, static_cast<int>(place)};
  if (std::abs(value) > std::abs(largest_[q].value)) largest_[q] = peak;
  if (std::abs(value) < kept * std::abs(largest_[q].value) || value == 0.0) return;
  std::vector<Peak>& found = found_[q];
  found.push_back(peak);
  if (found.size() < most) return;
  std::erase_if(found, [&](const Peak& p) { return std::abs(p.value) < compared * std::abs(largest_[q].value); });
  if (found.size() > most / 2) found.erase(found.begin(), found.end() - most / 2);
}

void Peaks::add(double t, std::span<const beam::Response> probes, std::span<const double> wheel_forces) {
  static const Kinks smooth;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::array values = {probes[i].deflection, probes[i].acceleration, probes[i].moment};
    for (std::size_t q = 0; q < values.size(); ++q)
      probes_[i][q].add(t, values[q], q == moment ? passages_[i] : smooth, [&](double value, double at) {
        note(static_cast<Quantity>(q), i, value, at);
      });
  }
  for (std::size_t i = 0; i < wheel_forces.size(); ++i)
    wheels_[i].add(t, wheel_forces[i], smooth, [&](double value, double at) { note(wheel_force, i, value, at); });
}

void Peaks::finish() {
  for (std::size_t i = 0; i < probes_.size(); ++i)
    for (std::size_t q = 0; q < wheel_force; ++q)
      probes_[i][q].finish([&](double value, double at) { note(static_cast<Quantity>(q), i, value, at); });
  for (std::size_t i = 0; i < wheels_.size(); ++i)
    wheels_[i].finish([&](double value, double at) { note(wheel_force, i, value, at); });
}

double peak_difference(const Peaks& rough, const Peaks& fine, Quantity q) {
  const double largest = std::abs(fine.largest(q).value);
  return largest == 0.0 ? 0.0 : std::abs(std::abs(rough.largest(q).value) - largest) / largest;
}

double difference(const Peaks& rough, const Peaks& fine, Quantity q, double reach) {
  const double largest = std::abs(fine.largest(q).value);
  if (largest == 0.0) return 0.0;
  double squares = 0.0;
  int count = 0;
  const auto earlier = [](const Peak& a, const Peak& b) {
    return a.place != b.place ? a.place < b.place : a.time < b.time;
  };
  std::vector<Peak> others = rough.of(q);
  std::sort(others.begin(), others.end(), earlier);
  for (const Peak& peak : fine.of(q)) {
    if (std::abs(peak.value) < compared * largest) continue;
    double nearest = reach, off = -1.0;
    for (auto other = std::lower_bound(others.begin(), others.end(), Peak{0.0, peak.time - reach, peak.place}, earlier);
         other != others.end() && other->place == peak.place && other->time <= peak.time + reach; ++other) {
      const double apart = std::abs(other->time - peak.time);
      if (apart > nearest || other->value * peak.value < 0.0) continue;
      nearest = apart;
      off = std::abs(other->value - peak.value);
    }
    if (off < 0.0) continue;
    squares += off * off;
    ++count;
  }
  const double spread = count > 0 ? std::sqrt(squares / count) / largest : 0.0;
  return std::max(peak_difference(rough, fine, q), likely * spread);
}

std::vector<Kinks> passages_of(const Scene& scene) {
  std::vector<Kinks> passages(scene.output.probes.size());
  if (!scene.beam || scene.beam->track || scene.analysis != Analysis::transient) return passages;
  std::vector<std::pair<double, double>> starts;  // x at t = 0 and speed
  if (scene.train.drive == coupling::Drive::constant && scene.train.speed > 0.0)
    for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
      const Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(scene.train.vehicles[i])];
      for (const Wheel& wheel : vehicle.wheels) {
        const auto& body = vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)];
        starts.emplace_back(scene.train.positions[i] + body.position.x(), scene.train.speed);
      }
    }
  if (scene.load.speed > 0.0)
    for (const double x : scene.load.positions) starts.emplace_back(x, scene.load.speed);
  for (std::size_t p = 0; p < passages.size(); ++p) {
    for (const auto& [x, speed] : starts) {
      const double t = (scene.output.probes[p] - x) / speed;
      if (t > 0.0) passages[p].times.push_back(t);
      passages[p].uncertain = std::max(passages[p].uncertain, off_centre / speed);
    }
    std::sort(passages[p].times.begin(), passages[p].times.end());
  }
  return passages;
}

}  // namespace traverse::app
