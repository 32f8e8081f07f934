// Interpolation of an evenly sampled series by a natural cubic spline, with an error of order four in the interval.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace traverse::fit {

class Spline {
 public:
  /// The samples at 0, interval, 2 interval, ... They must outlive the spline.
  Spline(std::span<const double> samples, double interval)
      : samples_(samples), interval_(interval), bend_(samples.size(), 0.0) {
    // b[i-1] + 4 b[i] + b[i+1] = y[i-1] - 2 y[i] + y[i+1], with b = interval^2 y''/6 and 0 at both ends
    std::vector<double> factor(samples.size(), 0.0);
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
      const double pivot = 4.0 - factor[i - 1];
      factor[i] = 1.0 / pivot;
      bend_[i] = (samples[i - 1] - 2.0 * samples[i] + samples[i + 1] - bend_[i - 1]) / pivot;
    }
    for (std::size_t i = samples.size(); i-- > 1;)
      if (i + 1 < samples.size()) bend_[i] -= factor[i] * bend_[i + 1];
  }

  /// The value at t; before the first and after the last sample the value of that sample.
  double operator()(double t) const {
    const double last = static_cast<double>(samples_.size() - 1), at = std::clamp(t / interval_, 0.0, last);
    const auto i = static_cast<std::size_t>(std::min(at, std::max(last - 1.0, 0.0)));
    if (i + 1 >= samples_.size()) return samples_[i];
    const double b = at - static_cast<double>(i), a = 1.0 - b;
    return a * samples_[i] + b * samples_[i + 1] + (a * a * a - a) * bend_[i] + (b * b * b - b) * bend_[i + 1];
  }

 private:
  std::span<const double> samples_;
  double interval_;
  std::vector<double> bend_;
};

}  // namespace traverse::fit
