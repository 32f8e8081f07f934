// Two second-order sections of a Butterworth filter by the bilinear transform, applied forward and backward to series
// that are continued by point reflection at both ends.
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

// Both sections follow each other through the rows, and Width series go side by side in registers. x, y, z: what goes
// in, what leaves the first section and the second, each with the two before it.
template <std::size_t Width>
void LowPass::pass(double* row, std::ptrdiff_t to_next, std::size_t rows) const {
  const Section a = sections_[0], b = sections_[1];
  std::array<double, Width> x1, x2, y1, y2, z1, z2;
  for (std::size_t k = 0; k < Width; ++k) x1[k] = x2[k] = y1[k] = y2[k] = z1[k] = z2[k] = row[k];
  for (std::size_t r = 0; r < rows; ++r, row += to_next)
    for (std::size_t k = 0; k < Width; ++k) {
      const double x = row[k];
      const double y = (a.b * (x + 2.0 * x1[k] + x2[k]) - a.a2 * y2[k]) - a.a1 * y1[k];
      const double z = (b.b * (y + 2.0 * y1[k] + y2[k]) - b.a2 * z2[k]) - b.a1 * z1[k];
      x2[k] = x1[k];
      x1[k] = x;
      y2[k] = y1[k];
      y1[k] = y;
      z2[k] = z1[k];
      z1[k] = row[k] = z;
    }
}

void LowPass::pass(double* row, std::ptrdiff_t to_next, std::size_t rows, std::size_t count) const {
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) pass<4>(row + k, to_next, rows);
  for (; k + 2 <= count; k += 2) pass<2>(row + k, to_next, rows);
  if (k < count) pass<1>(row + k, to_next, rows);
}

void LowPass::apply(std::vector<double>& series, std::size_t count) const {
  const std::size_t n = series.size() / count, margin = n > 0 ? std::min(margin_, n - 1) : 0;
  if (n < 2) return;
  std::vector<double> longer(series.size() + 2 * margin * count);
  const double *front = series.data(), *back = front + (n - 1) * count;
  for (std::size_t i = 0; i < margin; ++i)
    for (std::size_t k = 0; k < count; ++k) {
      longer[i * count + k] = 2.0 * front[k] - front[(margin - i) * count + k];
      longer[(margin + n + i) * count + k] = 2.0 * back[k] - front[(n - 2 - i) * count + k];
    }
  const auto within = longer.begin() + static_cast<std::ptrdiff_t>(margin * count);
  std::copy(series.begin(), series.end(), within);
  const std::size_t rows = n + 2 * margin;
  const auto to_next = static_cast<std::ptrdiff_t>(count);
  pass(longer.data(), to_next, rows, count);
  pass(longer.data() + (rows - 1) * count, -to_next, rows, count);
  std::copy_n(within, series.size(), series.begin());
}

}  // namespace traverse::app
