// Selects the next step length longest/2^k from the local error estimate of an embedded method: at once shorter where
// the error is too large, twice as long after two accurate steps.
#include "integrate/step_size_control.hpp"

#include <algorithm>
#include <cmath>

#include "base/whole.hpp"

namespace traverse::integrate {
namespace {

constexpr int most_rungs = 1000;    // shorter steps than the last one are none
constexpr int lowest = 16;          // rung that errors lead to
constexpr int most_fallen = 4;      // rungs at once
constexpr double growth = 16.0;     // of the error from a rung to the next: local errors of order 4
constexpr double aim = 0.5;         // of the tolerance, on another rung
constexpr int calm_steps = 2;       // before a longer one
constexpr double same_step = 1e-6;  // of a step: lengths that differ by rounding
constexpr double rounding = 1e-9;   // of a step

}  // namespace

double shared_evenly(double whole, double most) {
  return whole / std::max(1.0, std::ceil(whole / most * (1.0 - rounding)));
}

double StepSizeControl::length(int level) const { return std::ldexp(longest_, -level); }

// The first rung that is not longer.
int StepSizeControl::rung_within(double most) const {
  if (!std::isfinite(most)) return 0;
  return std::max(0, base::whole(std::ceil(std::log2(longest_ / most * (1.0 - rounding))), most_rungs));
}

bool StepSizeControl::judge(double h, double error) {
  if (!(error <= 1.0) && h > length(lowest) * (1.0 + same_step)) {
    int level = rung_within(h * (1.0 - same_step));
    const int last = std::min(lowest, level + most_fallen - 1);
    while (level < last && !(error * std::pow(length(level) / h, std::log2(growth)) <= aim)) ++level;
    level_ = std::max(level, level_);
    calm_ = 0;
    return false;
  }
  if (h < wanted() * (1.0 - same_step)) return true;  // it says little of longer ones
  calm_ = error * growth <= aim ? calm_ + 1 : 0;
  if (level_ > 0 && calm_ >= calm_steps) {
    --level_;
    calm_ = 0;
  }
  return true;
}

double StepSizeControl::towards(double left, double most) const {
  const int first = std::max(level_, rung_within(most));
  for (int level = first; level <= std::max(first, lowest); ++level) {
    const double count = std::round(left / length(level));
    if (count >= 1.0 && std::abs(left - count * length(level)) <= same_step * length(level))
      return count == 1.0 ? left : length(level);
  }
  const double h = length(first);
  if (left <= h) return left;
  return left < 2.0 * h ? 0.5 * left : h;
}

}  // namespace traverse::integrate
