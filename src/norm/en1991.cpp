// Determinant lengths, dynamic factors Phi, phi' and phi'', frequency bounds and damping ratios of clause 6.4 and annex
// C of EN 1991-2 in closed form.
#include "norm/en1991.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traverse::norm {
namespace {

constexpr double percent = 0.01;
constexpr double bounds_from = 4.0, bounds_change = 20.0,
                 bounds_to = 100.0;                                   // m, lengths at which the limits of n0 change
constexpr double damping_changes = 20.0, vehicles_damp_below = 30.0;  // m
constexpr double full_speed = 22.0;  // m/s, speed from which irregularities have their full effect

/// c/(sqrt(L) - 0.2) + d in [1, most].
double phi_of_length(double length, double c, double d, double most) {
  const double root = std::sqrt(length) - 0.2;
  return root <= 0.0 ? most : std::clamp(c / root + d, 1.0, most);
}

}  // namespace

double determinant_length(std::span<const double> spans) {
  constexpr double k[] = {1.0, 1.2, 1.3, 1.4, 1.5};
  const double mean = std::accumulate(spans.begin(), spans.end(), 0.0) / static_cast<double>(spans.size());
  return std::max(k[std::min(spans.size(), std::size(k)) - 1] * mean, *std::max_element(spans.begin(), spans.end()));
}

std::vector<double> determinant_lengths(const beam::BeamModel& model) {
  std::vector<double> lengths;
  for (std::size_t first = 0; first < model.spans.size();) {
    std::size_t end = first + 1;
    while (end < model.spans.size() && model.joint(static_cast<int>(end)) != beam::Joint::separate) ++end;
    lengths.resize(end, determinant_length(std::span(model.spans).subspan(first, end - first)));
    first = end;
  }
  return lengths;
}

double phi2(double length) { return phi_of_length(length, 1.44, 0.82, 1.67); }
double phi3(double length) { return phi_of_length(length, 2.16, 0.73, 2.0); }

double phi_of_speed(double v, double length, double n0) {
  const double K = v / (2.0 * length * n0);
  return K < 0.76 ? K / (1.0 - K + K * K * K * K) : 1.325;
}

double phi_of_track(double v, double length, double n0) {
  const double a = std::min(v / full_speed, 1.0), tenth = length / 10.0, twentieth = length / 20.0;
  const double sum =
      56.0 * std::exp(-tenth * tenth) + 50.0 * (length * n0 / 80.0 - 1.0) * std::exp(-twentieth * twentieth);
  return std::max(0.0, a / 100.0 * sum);
}

std::optional<std::pair<double, double>> frequency_bounds(double length) {
  if (length < bounds_from || length > bounds_to) return {};
  const double low = length <= bounds_change ? 80.0 / length : 23.58 * std::pow(length, -0.592);
  return std::pair{low, 94.76 * std::pow(length, -0.748)};
}

double least_damping(options::BridgeMaterial material, double span) {
  const options::DampingBound& bound = options::damping_bounds[static_cast<std::size_t>(material)];
  return percent * (bound.long_spans + bound.slope * std::max(0.0, damping_changes - span));
}

double additional_damping(double span) {
  if (span >= vehicles_damp_below) return 0.0;
  const double L = span, numerator = 0.0187 * L - 0.00064 * L * L;
  return percent * std::max(0.0, numerator / (1.0 - 0.0441 * L - 0.0044 * L * L + 0.000255 * L * L * L));
}

}  // namespace traverse::norm
