// Modal forces and static corrections as cubic polynomials of the distance travelled: the influence lines of all moving
// forces, shifted to their positions and added interval by interval.
#include "integrate/force_history.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "train/wheel_paths.hpp"

namespace traverse::integrate {
namespace {

constexpr double most_numbers = 2e8;     // 1.6 GB
constexpr double same_distance = 1e-12;  // distances that differ by less, relative to the bridge's length, are equal

/// Adds force*influence at x + s, as a polynomial of the distance s. `sum` must not overlap the influence.
void add(const structure::PiecewiseCubic& influence, std::size_t piece, double force, double x, double* sum) {
  const std::size_t n = influence.channels;
  const double* c = &influence.coefficients[4 * n * piece];
  const double d = x - influence.breaks[piece];
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const double c1 = c[n + i], c2 = c[2 * n + i], c3 = c[3 * n + i];
    sum[i] += force * (c[i] + d * (c1 + d * (c2 + d * c3)));
    sum[n + i] += force * (c1 + d * (2.0 * c2 + 3.0 * d * c3));
    sum[2 * n + i] += force * (c2 + 3.0 * d * c3);
    sum[3 * n + i] += force * c3;
  }
}

}  // namespace

ForceHistory::ForceHistory(const structure::PiecewiseCubic& influence, const train::MovingLoad& load)
    : start{0.0}, channels(influence.channels) {
  const std::vector<double>& breaks = influence.breaks;
  const double length = breaks.back() - breaks.front();
  if (static_cast<double>(load.positions.size() * breaks.size()) * 4.0 * static_cast<double>(channels) > most_numbers)
    throw InputError("model_modes: so many modes, probes, forces and elements do not fit into memory; use fewer of " +
                     std::to_string(channels) + " modes and probes, or the full model (model_modes: 0)");
  for (const double x : load.positions) {
    for (const double at : breaks)
      if (at > x) start.push_back(at - x);
  }
  std::sort(start.begin(), start.end());
  start.erase(
      std::unique(start.begin(), start.end(), [&](double a, double b) { return b - a <= same_distance * length; }),
      start.end());
  // What arrives at the first instant is not on the bridge yet: the first interval ends at once.
  const auto arrives = [&](double x) { return std::abs(x - breaks.front()) <= same_distance * length; };
  if (load.speed != 0.0 && std::any_of(load.positions.begin(), load.positions.end(), arrives))
    start.insert(start.begin(), 0.0);
  coefficients.assign(4 * channels * start.size(), 0.0);
  const auto middle = [&](std::size_t i) {
    if (load.speed == 0.0) return start[i];
    return i + 1 < start.size() ? 0.5 * (start[i] + start[i + 1]) : start[i] + length;
  };
  for (std::size_t j = 0; j < load.positions.size(); ++j) {
    const double position = load.positions[j];
    // The search begins one interval before the force enters, because equal starts were merged.
    const auto entered = std::lower_bound(start.begin(), start.end(), breaks.front() - position);
    for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(entered - start.begin() - 1, 0)); i < start.size();
         ++i) {
      const double x = position + middle(i);
      if (x > breaks.back()) break;
      if (!train::is_on_line(breaks.front(), breaks.back(), x, load.speed)) continue;
      const auto next = std::upper_bound(breaks.begin(), breaks.end() - 1, x);
      add(influence, static_cast<std::size_t>(next - breaks.begin()) - 1, load.forces[j], position + start[i],
          &coefficients[4 * channels * i]);
    }
  }
}

}  // namespace traverse::integrate
