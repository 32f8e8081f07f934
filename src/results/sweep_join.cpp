// Two parts of a sweep as one.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "results/sweep.hpp"

namespace traverse::results {

Sweep joined(const Sweep& a, const Sweep& b) {
  std::vector<double> speeds = a.speed;
  speeds.insert(speeds.end(), b.speed.begin(), b.speed.end());
  std::vector<std::size_t> order(speeds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return speeds[i] < speeds[j]; });

  Sweep both = a;
  both.speed.clear();
  for (const std::size_t i : order) both.speed.push_back(speeds[i]);
  /// [trains][speeds][width] of both.
  const auto join = [&](std::vector<double>& into, const std::vector<double>& of_a, const std::vector<double>& of_b) {
    if (of_a.empty()) return;
    const std::size_t width = of_a.size() / (a.rows() * a.speed.size());
    into.clear();
    for (std::size_t train = 0; train < a.rows(); ++train)
      for (const std::size_t i : order) {
        const bool first = i < a.speed.size();
        const std::size_t run = first ? train * a.speed.size() + i : train * b.speed.size() + i - a.speed.size();
        const auto from = (first ? of_a : of_b).begin() + static_cast<std::ptrdiff_t>(run * width);
        into.insert(into.end(), from, from + static_cast<std::ptrdiff_t>(width));
      }
  };
  for (Sweep::Peaks Sweep::*peaks : {&Sweep::deflection, &Sweep::acceleration, &Sweep::moment}) {
    join((both.*peaks).value, (a.*peaks).value, (b.*peaks).value);
    join((both.*peaks).time, (a.*peaks).time, (b.*peaks).time);
  }
  for (std::vector<double> Sweep::*values :
       {&Sweep::amplification, &Sweep::least_wheel_force, &Sweep::greatest_wheel_force, &Sweep::contact_losses,
        &Sweep::longest_loss, &Sweep::unseen})
    join(both.*values, a.*values, b.*values);
  if (!a.judged.limits.empty()) {
    join(both.judged.value, a.judged.value, b.judged.value);
    join(both.judged.x, a.judged.x, b.judged.x);
    for (std::size_t l = 0; l < both.judged.why.size(); ++l)
      if (both.judged.why[l].empty()) both.judged.why[l] = b.judged.why[l];
  }
  for (std::size_t i = 0; i < both.static_deflection.size(); ++i)
    if (std::isnan(both.static_deflection[i])) both.static_deflection[i] = b.static_deflection[i];
  return both;
}

}  // namespace traverse::results
