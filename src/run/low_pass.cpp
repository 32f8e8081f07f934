// Two second-order sections of a Butterworth filter by the bilinear transform, applied forward and backward to series
// that are continued by point reflection at both ends.
#include "run/low_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::run {
namespace {

constexpr double margin_periods =
    3.0;  // number of periods of the filter's frequency after which a transient has decayed

}  // namespace

LowPass::LowPass(double frequency, double interval)
    : margin_(static_cast<std::size_t>(std::ceil(margin_periods / (frequency * interval)))) {
  // Bilinear transform of 1/(s^2 + 2 cos(angle) s + 1), which preserves the filter's frequency.
  const double k = std::tan(std::numbers::pi * frequency * interval);
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const double angle = std::numbers::pi * (2.0 * static_cast<double>(i) + 1.0) / 8.0;
    const double middle = 2.0 * std::cos(angle) * k, scale = 1.0 / (1.0 + middle + k * k);
    sections_[i] = {k * k * scale, 2.0 * (k * k - 1.0) * scale, (1.0 - middle + k * k) * scale};
  }
}

// Both sections are applied row by row to Width series at once in registers. x, y, z: input, output of the first and of
// the second section, each with its two former values.
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
  const std::size_t width = count % 4 == 3 ? count + 1 : count;  // four series at once are faster than two and one
  std::vector<double> extended((n + 2 * margin) * width);
  const double *front = series.data(), *back = front + (n - 1) * count;
  for (std::size_t i = 0; i < margin; ++i)
    for (std::size_t k = 0; k < count; ++k) {
      extended[i * width + k] = 2.0 * front[k] - front[(margin - i) * count + k];
      extended[(margin + n + i) * width + k] = 2.0 * back[k] - front[(n - 2 - i) * count + k];
    }
  double* const inner = &extended[margin * width];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < count; ++k) inner[i * width + k] = series[i * count + k];
  const std::size_t rows = n + 2 * margin;
  const auto to_next = static_cast<std::ptrdiff_t>(width);
  pass(extended.data(), to_next, rows, width);
  pass(extended.data() + (rows - 1) * width, -to_next, rows, width);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < count; ++k) series[i * count + k] = inner[i * width + k];
}

}  // namespace traverse::run
