#include "run/low_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::app {
namespace {

constexpr double periods_beyond = 3.0;  // of the filter's frequency; what came before has died away by then

}  // namespace

LowPass::LowPass(double frequency, double interval)
    : margin_(static_cast<std::size_t>(std::ceil(periods_beyond / (frequency * interval)))) {
  // The bilinear transform of 1/(s^2 + 2 cos(angle) s + 1), with which the filter's frequency stays where it is.
  const double k = std::tan(std::numbers::pi * frequency * interval);
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const double angle = std::numbers::pi * (2.0 * static_cast<double>(i) + 1.0) / 8.0;
    const double middle = 2.0 * std::cos(angle) * k, scale = 1.0 / (1.0 + middle + k * k);
    sections_[i] = {k * k * scale, 2.0 * (k * k - 1.0) * scale, (1.0 - middle + k * k) * scale};
  }
}

void LowPass::pass(std::vector<double>& series) const {
  for (const Section& s : sections_) {
    // The two states for which a constant has always been there.
    double first = (3.0 * s.b - s.a1 - s.a2) * series.front(), second = (s.b - s.a2) * series.front();
    for (double& value : series) {
      const double y = s.b * value + first;
      first = 2.0 * s.b * value - s.a1 * y + second;
      second = s.b * value - s.a2 * y;
      value = y;
    }
  }
}

void LowPass::apply(std::vector<double>& series) const {
  if (series.size() < 2) return;
  const std::size_t n = series.size(), margin = std::min(margin_, n - 1);
  std::vector<double> longer(n + 2 * margin);
  for (std::size_t i = 0; i < margin; ++i) {
    longer[i] = 2.0 * series.front() - series[margin - i];
    longer[margin + n + i] = 2.0 * series.back() - series[n - 2 - i];
  }
  std::copy(series.begin(), series.end(), longer.begin() + static_cast<std::ptrdiff_t>(margin));
  pass(longer);
  std::reverse(longer.begin(), longer.end());
  pass(longer);
  std::copy_n(longer.rbegin() + static_cast<std::ptrdiff_t>(margin), n, series.begin());
}

}  // namespace traverse::app
