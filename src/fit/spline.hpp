// Interpolation of an evenly sampled series by a natural cubic spline, with an error of order four in the interval.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "base/spline.hpp"

namespace traverse::fit {

class Spline {
 public:
  /// The samples at 0, interval, 2 interval, ... They must outlive the spline.
  Spline(std::span<const double> samples, double interval) : samples_(samples), interval_(interval) {
    std::vector<double> numbers(samples.size());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    bend_ = base::spline_curvatures(numbers, samples);
  }

  /// The value at t; before the first and after the last sample the value of that sample.
  double operator()(double t) const {
    const double last = static_cast<double>(samples_.size() - 1), at = std::clamp(t / interval_, 0.0, last);
    const auto i = static_cast<std::size_t>(std::min(at, std::max(last - 1.0, 0.0)));
    if (i + 1 >= samples_.size()) return samples_[i];
    const double b = at - static_cast<double>(i), a = 1.0 - b;
    return a * samples_[i] + b * samples_[i + 1] + ((a * a * a - a) * bend_[i] + (b * b * b - b) * bend_[i + 1]) / 6.0;
  }

 private:
  std::span<const double> samples_;
  double interval_;
  std::vector<double> bend_;  // second derivatives by the number of a sample
};

}  // namespace traverse::fit
