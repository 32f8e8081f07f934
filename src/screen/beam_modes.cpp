// Finds each wavenumber by bisection of the number of modes below it, and its shape as the null vector of the
// conditions at the supports.
#include "screen/beam_modes.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "base/gauss.hpp"

namespace traverse::screen {
namespace {

constexpr double negligible = 1e-12;  // relative to the largest coefficient of a shape

/// The number of natural frequencies of a clamped span below lambda = beta L.
int clamped_below(double lambda) {
  const int i = static_cast<int>(lambda / std::numbers::pi);
  const double sign = std::cos(lambda) - 1.0 / std::cosh(lambda) < 0.0 ? 1.0 : -1.0;
  return i - static_cast<int>(1.0 - (i % 2 == 0 ? 1.0 : -1.0) * sign) / 2;
}

/// The number of modes below beta: those of the clamped spans, and the negative pivots of the dynamic stiffness of the
/// rotations at the supports.
int modes_below(std::span<const double> spans, double beta) {
  int count = 0;
  double pivot = 0.0, carried = 0.0;
  const auto eliminate = [&](double diagonal, double next) {
    pivot = diagonal - carried;
    if (pivot == 0.0) pivot = 1e-300;
    if (pivot < 0.0) ++count;
    carried = next * next / pivot;
  };
  double diagonal = 0.0;
  for (const double span : spans) {
    const double lambda = beta * span, ch = std::cosh(lambda), sh = std::sinh(lambda), s = std::sin(lambda),
                 c = std::cos(lambda), below = 1.0 - c * ch;
    count += clamped_below(lambda);
    const double own = (ch * s - sh * c) / below, coupling = (sh - s) / below;
    eliminate(diagonal + own, coupling);
    diagonal = own;
  }
  eliminate(diagonal, 0.0);
  return count;
}

double wavenumber(std::span<const double> spans, int number) {
  double low = 0.0, high = 1e-6;
  for (const double span : spans) high = std::max(high, std::numbers::pi / span);
  while (modes_below(spans, high) < number) high *= 1.5;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return high;
    (modes_below(spans, middle) >= number ? high : low) = middle;
  }
}

/// phi, phi'/beta and phi''/beta^2 for the four coefficients.
Eigen::Matrix<double, 3, 4> values(double beta, double L, double xi) {
  const double s = std::sin(beta * xi), c = std::cos(beta * xi), e = std::exp(-beta * xi),
               f = std::exp(-beta * (L - xi));
  Eigen::Matrix<double, 3, 4> at;
  at << s, c, e, f, c, -s, -e, f, -s, -c, e, f;
  return at;
}

std::vector<SpanShape> shape_of(std::span<const double> spans, double beta) {
  const auto n = static_cast<Eigen::Index>(spans.size());
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  Eigen::Index row = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double L = spans[static_cast<std::size_t>(j)];
    const auto start = values(beta, L, 0.0), end = values(beta, L, L);
    conditions.block(row++, 4 * j, 1, 4) = start.row(0);
    conditions.block(row++, 4 * j, 1, 4) = end.row(0);
    if (j == 0) conditions.block(row++, 0, 1, 4) = start.row(2);
    if (j + 1 == n) {
      conditions.block(row++, 4 * j, 1, 4) = end.row(2);
      break;
    }
    const auto next = values(beta, spans[static_cast<std::size_t>(j + 1)], 0.0);
    for (const int derivative : {1, 2}) {
      conditions.block(row, 4 * j, 1, 4) = end.row(derivative);
      conditions.block(row++, 4 * (j + 1), 1, 4) = -next.row(derivative);
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(conditions, Eigen::ComputeFullV);
  Eigen::VectorXd v = svd.matrixV().rightCols(1);
  const double least = negligible * v.cwiseAbs().maxCoeff();
  v = v.unaryExpr([least](double x) { return std::abs(x) < least ? 0.0 : x; });
  std::vector<SpanShape> shapes;
  for (Eigen::Index j = 0; j < n; ++j) shapes.push_back({v[4 * j], v[4 * j + 1], v[4 * j + 2], v[4 * j + 3]});
  return shapes;
}

/// The integral of phi^2 along a span, by Gauss's rule of three points on short parts.
double square_of(const SpanShape& shape, double beta, double L) {
  const int parts = 16 + static_cast<int>(32.0 * beta * L);
  const double h = L / parts;
  double sum = 0.0;
  const auto add = [&](double xi, double weight) { sum += weight * std::pow(shape_at(shape, beta, L, xi), 2); };
  for (int i = 0; i < parts; ++i) base::at_gauss_points<3>(i * h, (i + 1) * h, add);
  return sum;
}

}  // namespace

double shape_at(const SpanShape& shape, double beta, double L, double xi) {
  return shape.a * std::sin(beta * xi) + shape.b * std::cos(beta * xi) + shape.c * std::exp(-beta * xi) +
         shape.d * std::exp(-beta * (L - xi));
}

std::array<double, 3> shape_and_derivatives(const SpanShape& shape, double beta, double L, double xi) {
  const double sine = std::sin(beta * xi), cosine = std::cos(beta * xi), falling = shape.c * std::exp(-beta * xi),
               rising = shape.d * std::exp(-beta * (L - xi)), harmonic = shape.a * sine + shape.b * cosine;
  return {harmonic + falling + rising, beta * (shape.a * cosine - shape.b * sine - falling + rising),
          beta * beta * (falling + rising - harmonic)};
}

std::vector<BeamMode> beam_modes(std::span<const double> spans, int count) {
  std::vector<BeamMode> modes;
  for (int number = 1; number <= count; ++number) {
    BeamMode mode;
    mode.beta = wavenumber(spans, number);
    mode.spans = shape_of(spans, mode.beta);
    double square = 0.0;
    for (std::size_t j = 0; j < spans.size(); ++j) square += square_of(mode.spans[j], mode.beta, spans[j]);
    for (SpanShape& shape : mode.spans)
      for (double* coefficient : {&shape.a, &shape.b, &shape.c, &shape.d}) *coefficient /= std::sqrt(square);
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace traverse::screen
