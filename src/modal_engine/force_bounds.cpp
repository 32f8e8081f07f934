// Bounds of cubic polynomials by their Bernstein coefficients, added up interval by interval.
#include "modal_engine/force_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traverse::modal_engine {
namespace {

constexpr std::size_t most_lengths = 64;  // of moves whose coefficients are computed once
constexpr double same_length = 1e-12;     // relative to the whole distance

using Cubic = std::array<double, 4>;

double value(const Cubic& c, double s) { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }

Cubic cubic_of(const integrate::ForceHistory& history, std::size_t interval, std::size_t channel) {
  const double* c = history.interval(interval) + channel;
  const std::size_t n = history.channels;
  return {c[0], c[n], c[2 * n], c[3 * n]};
}

/// Not below the largest magnitude in an interval of this length.
double magnitude_bound(const Cubic& c, double length) {
  const double first = c[0] + length * c[1] / 3.0, second = c[0] + length * (2.0 * c[1] + length * c[2]) / 3.0;
  return std::max({std::abs(c[0]), std::abs(first), std::abs(second), std::abs(value(c, length))});
}
double slope_bound(const Cubic& c, double length) {
  const double middle = c[1] + length * c[2], end = c[1] + length * (2.0 * c[2] + 3.0 * length * c[3]);
  return std::max({std::abs(c[1]), std::abs(middle), std::abs(end)});
}
/// Not below the variation of the slope.
double bend_bound(const Cubic& c, double length) {
  return length * (std::abs(c[2]) + std::abs(c[2] + 3.0 * length * c[3]));
}

/// The index of a length in a list, to which it is added if it is new; -1: the list is full.
int index_of(double length, double tolerance, std::vector<double>& lengths) {
  const auto known =
      std::find_if(lengths.begin(), lengths.end(), [&](double one) { return std::abs(one - length) <= tolerance; });
  const auto index = static_cast<int>(known - lengths.begin());
  if (known != lengths.end()) return index;
  if (lengths.size() == most_lengths) return -1;
  lengths.push_back(length);
  return index;
}

/// The largest magnitude in an interval of this length, or `least` if that is greater.
double largest_magnitude(const Cubic& c, double length, double least) {
  if (magnitude_bound(c, length) <= least) return least;
  const auto evaluate = [&](double s) {
    if (s >= 0.0 && s <= length) least = std::max(least, std::abs(value(c, s)));
  };
  evaluate(0.0);
  evaluate(length);
  const double discriminant = c[2] * c[2] - 3.0 * c[1] * c[3];  // for the zeros of the slope
  if (discriminant < 0.0) return least;
  const double larger_root_numerator = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
  if (c[3] != 0.0) evaluate(larger_root_numerator / (3.0 * c[3]));
  if (larger_root_numerator != 0.0) evaluate(c[1] / larger_root_numerator);
  return least;
}

}  // namespace

Jumps::Jumps(const integrate::ForceHistory& history)
    : largest(history.channels, 0.0), steepest(largest), value(history.coefficients.size() / 4), slope(value) {
  const std::size_t n = history.channels;
  for (std::size_t i = 0; i < history.start.size(); ++i) {
    const double* c = history.interval(i);
    for (std::size_t k = 0; k < n; ++k) {
      largest[k] = std::max(largest[k], std::abs(c[k]));
      steepest[k] = std::max(steepest[k], std::abs(c[n + k]));
    }
    if (i == 0) continue;
    const double d = history.start[i] - history.start[i - 1];
    const double* b = history.interval(i - 1);
    for (std::size_t k = 0; k < n; ++k) {
      const double b1 = b[n + k], b2 = b[2 * n + k], b3 = b[3 * n + k];
      value[i * n + k] = std::abs(c[k] - (b[k] + d * (b1 + d * (b2 + d * b3))));
      slope[i * n + k] = std::abs(c[n + k] - (b1 + d * (2.0 * b2 + 3.0 * d * b3)));
    }
  }
}

ForceBounds::ForceBounds(const structure::ModalBridge& bridge, const integrate::ForceHistory& history,
                         const Jumps& jumps, const std::vector<char>& all_kink)
    : history_(history),
      all_kink_(all_kink),
      modes_(bridge.modes()),
      probes_(bridge.probes().count),
      size_(2 * modes_ + 6 * probes_),
      numbers_(size_ * history.start.size(), 0.0) {
  set_factors(bridge);
  for (const double weight : bridge.probes().weight_deflection) static_peaks_.push_back(std::abs(weight));
  std::vector<Cubic> sums(2 * probes_);
  for (std::size_t i = 0; i < history.start.size(); ++i) add_interval(bridge, i, jumps, sums);
}

void ForceBounds::set_factors(const structure::ModalBridge& bridge) {
  const structure::ModalProbes& probes = bridge.probes();
  by_amplitude_.resize(2 * modes_ * probes_);
  by_rate_.resize(3 * modes_ * probes_);
  for (std::size_t k = 0; k < modes_; ++k) {
    const double omega = bridge.omega()[k], omega2 = omega * omega, damping = 2.0 * bridge.sigma()[k];
    for (std::size_t p = 0; p < probes_; ++p) {
      const std::size_t at = k * probes_ + p;
      const double form = std::abs(probes.deflection[at]), bend_inertia = probes.moment_by_acceleration[at];
      const double bend = probes.moment[at] - omega2 * bend_inertia;
      const double bend_rate = probes.moment_by_rate[at] - damping * bend_inertia;
      double *c = &by_amplitude_[2 * k * probes_ + p], *d = &by_rate_[3 * k * probes_ + p];
      c[0] = form;
      c[probes_] = std::hypot(bend, omega * bend_rate);
      d[probes_] = form * damping / omega2;
      d[2 * probes_] = std::abs(bend_rate) / omega2;
    }
  }
}

void ForceBounds::add_interval(const structure::ModalBridge& bridge, std::size_t interval, const Jumps& jumps,
                               std::vector<Cubic>& sums) {
  const std::vector<double>& start = history_.start;
  const bool is_last = interval + 1 == start.size();  // without forces on the bridge
  const double length = is_last ? 0.0 : start[interval + 1] - start[interval];
  // Windows contain jumps only that are too small to count.
  const bool inside = all_kink_[interval] == 0;
  double *variation = numbers(interval), *static_part = variation + 2 * modes_, *by_speed = static_part + 3 * probes_;
  const structure::ModalProbes& probes = bridge.probes();
  for (std::size_t r = 0; r < 2 * probes_; ++r) {
    sums[r] = cubic_of(history_, interval, modes_ + r);
    sums[r][0] += r < probes_ ? probes.weight_deflection[r] : probes.weight_moment[r - probes_];
  }
  for (std::size_t k = 0; k < modes_; ++k) {
    const double omega = bridge.omega()[k], omega2 = omega * omega, cube = omega2 * omega;
    const Cubic force = cubic_of(history_, interval, k);
    const double steepest = slope_bound(force, length);
    const std::size_t jump = interval * history_.channels + k;
    variation[2 * k] = (bend_bound(force, length) + (inside ? jumps.slope[jump] : 0.0)) / cube;
    variation[2 * k + 1] =
        2.0 * bridge.sigma()[k] * steepest * length / cube + (inside ? jumps.value[jump] / omega2 : 0.0);
    for (std::size_t r = 0; r < 3 * probes_; ++r) by_speed[r] += by_rate_[3 * k * probes_ + r] * steepest;
    for (std::size_t p = 0; p < probes_; ++p) {
      const std::size_t at = k * probes_ + p;
      for (std::size_t power = 0; power < 4; ++power) {
        const double quasi_static = force[power] / omega2;
        sums[p][power] += probes.deflection[at] * quasi_static;
        sums[probes_ + p][power] += probes.moment[at] * quasi_static;
      }
    }
  }
  for (std::size_t p = 0; p < probes_; ++p) {
    static_part[p] = magnitude_bound(sums[p], length);
    static_part[2 * probes_ + p] = magnitude_bound(sums[probes_ + p], length);
    if (!is_last) static_peaks_[p] = largest_magnitude(sums[p], length, static_peaks_[p]);
  }
}

ForceWindows ForceBounds::windows(double length) const {
  const std::vector<double>& start = history_.start;
  const std::size_t count = start.size();
  const double tolerance = same_length * start.back();
  ForceWindows windows;
  windows.first_move = {0};
  windows.last = length;
  const auto add_move = [&](double move, double end) {
    windows.move_end.push_back(end);
    windows.move_length.push_back(index_of(move, tolerance, windows.length));
  };
  const auto add_stretch = [&](std::size_t first, double parts) {
    windows.end.push_back(windows.move_end.back());
    windows.parts.push_back(parts);
    windows.first_move.push_back(static_cast<long>(windows.move_end.size()));
    windows.numbers.insert(windows.numbers.end(), &numbers_[first * size_], &numbers_[first * size_] + size_);
  };
  for (std::size_t first = 0, past = 0; first + 1 < count; first = past) {
    past = first + 1;
    const double whole = start[past] - start[first], parts = std::max(1.0, std::round(whole / length));
    add_move(whole / parts, start[past]);
    for (; parts == 1.0 && past + 1 < count && all_kink_[past] == 0 && start[past + 1] - start[first] <= length; ++past)
      add_move(start[past + 1] - start[past], start[past + 1]);
    add_stretch(first, parts);
    double* sums = &windows.numbers[windows.numbers.size() - size_];
    for (std::size_t more = first + 1; more < past; ++more) {
      const double* own = &numbers_[more * size_];
      for (std::size_t k = 0; k < 2 * modes_; ++k) sums[k] += own[k];
      for (std::size_t k = 2 * modes_; k < size_; ++k) sums[k] = std::max(sums[k], own[k]);
    }
  }
  add_move(length, start.back() + length);
  add_stretch(count - 1, 1.0);
  return windows;
}

}  // namespace traverse::modal_engine
