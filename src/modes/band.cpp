// Banded L D L^T factorisation, the count of eigenvalues below a shift by the signs of the pivots (Sylvester's law of
// inertia), and brackets of eigenvalues by bisection.
#include "band.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

namespace traverse::modes {

namespace {

/// The number of negative pivots of K - sigma M. `Width` is a compile-time constant for common bandwidths, for speed.
template <class Width>
int negative_pivots(const Band& K, const Band& M, double sigma, Width width) {
  const int w = width;
  // The last rows of L and their pivots, in ring buffers whose lengths are a power of two.
  const unsigned ring = std::bit_ceil(static_cast<unsigned>(w) + 1), mask = ring - 1;
  const auto in_ring = [mask](int i) { return static_cast<unsigned>(i) & mask; };
  std::vector<double> L(ring * ring), d(ring);
  int negative = 0;
  for (int i = 0; i < K.size(); ++i) {
    const int first = std::max(0, i - w);
    const double *k = K.row(i), *m = M.row(i);
    double* row = &L[in_ring(i) * ring];
    double pivot = k[0] - sigma * m[0];
    const double size = std::abs(k[0]) + std::abs(sigma * m[0]);
    for (int j = first; j < i; ++j) {
      double scaled = k[i - j] - sigma * m[i - j];  // L_ij d_j
      const double* other = &L[in_ring(j) * ring];
      for (int p = std::max(first, j - w); p < j; ++p) {
        scaled -= row[in_ring(p)] * d[in_ring(p)] * other[in_ring(p)];
      }
      const double l = scaled / d[in_ring(j)];
      row[in_ring(j)] = l;
      pivot -= l * scaled;
    }
    const double least = std::numeric_limits<double>::epsilon() * size;
    if (std::abs(pivot) < least * 1e-3) pivot = least * 1e-3;
    d[in_ring(i)] = pivot;
    if (pivot < 0.0) ++negative;
  }
  return negative;
}

}  // namespace

int count_below(const Band& K, const Band& M, double sigma) {
  switch (K.width()) {
    case 1:
      return negative_pivots(K, M, sigma, std::integral_constant<int, 1>());
    case 3:
      return negative_pivots(K, M, sigma, std::integral_constant<int, 3>());
    default:
      return negative_pivots(K, M, sigma, K.width());
  }
}

void add_product(const Band& A, double factor, const double* x, double* y) {
  for (int i = 0; i < A.size(); ++i) {
    const double* row = A.row(i);
    double sum = row[0] * x[i];
    for (int j = std::max(0, i - A.width()); j < i; ++j) {
      sum += row[i - j] * x[j];
      y[j] += factor * row[i - j] * x[i];
    }
    y[i] += factor * sum;
  }
}

Factor::Factor(const Band& K) : rows_(K) {
  const int w = K.width();
  for (int i = 0; i < K.size(); ++i) {
    const int first = std::max(0, i - w);
    for (int j = first; j < i; ++j) {
      double scaled = rows_.at(i, j);  // L_ij d_j, for which rows_.at(i, p), p < j, are already computed
      for (int p = std::max(first, j - w); p < j; ++p) scaled -= rows_.at(i, p) * rows_.at(j, p);
      rows_.at(i, j) = scaled;
    }
    for (int j = first; j < i; ++j) {
      const double scaled = rows_.at(i, j);
      rows_.at(i, j) = scaled / rows_.at(j, j);
      rows_.at(i, i) -= rows_.at(i, j) * scaled;
    }
    positive_ = positive_ && rows_.at(i, i) > 0.0;
  }
}

void Factor::solve(double* x) const {
  const int n = rows_.size(), w = rows_.width();
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - w); j < i; ++j) x[i] -= rows_.at(i, j) * x[j];
  }
  for (int i = 0; i < n; ++i) x[i] /= rows_.at(i, i);
  for (int i = n - 1; i >= 0; --i) {
    for (int j = std::max(0, i - w); j < i; ++j) x[j] -= rows_.at(i, j) * x[i];
  }
}

double highest_quotient(const Band& K, const Band& M) {
  double highest = 0.0;
  for (int i = 0; i < K.size(); ++i) highest = std::max(highest, K.at(i, i) / M.at(i, i));
  return highest;
}

Bracket bracket_lowest(const Band& K, const Band& M) {
  // Rayleigh's quotient of a unit vector is an upper bound of the lowest eigenvalue.
  double high = std::numeric_limits<double>::max();
  for (int i = 0; i < K.size(); ++i) high = std::min(high, K.at(i, i) / M.at(i, i));
  high *= 1.0 + 1e-6;
  const double least = high * 1e-20;
  while (high > least) {
    const double low = 0.25 * high;
    if (count_below(K, M, low) == 0) return {low, high};
    high = low;
  }
  return {};
}

Bracket narrow(Bracket b, int max_count, double min_width, const std::function<int(double)>& below) {
  int inside = below(b.high);
  while (b.high > b.low * (1.0 + min_width) && (b.high > 1.05 * b.low || inside > max_count)) {
    const double middle = std::sqrt(b.low) * std::sqrt(b.high);
    const int count = below(middle);
    if (count <= 0) {
      b.low = middle;
    } else {
      b.high = middle;
      inside = count;
    }
  }
  // Moves low close to the lowest eigenvalue, relative to the distances of the others in the bracket.
  double lowest = b.high;
  while (inside > 1 && lowest - b.low > std::max(0.1 * (b.high - b.low), min_width * b.low)) {
    const double middle = 0.5 * (b.low + lowest);
    (below(middle) <= 0 ? b.low : lowest) = middle;
  }
  return b;
}

}  // namespace traverse::modes
