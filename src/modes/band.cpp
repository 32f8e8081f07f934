#include "band.hpp"

#include <cmath>
#include <limits>

namespace traverse::modes {

int count_below(const Band& K, const Band& M, double sigma) {
  constexpr int w = Band::width;
  // Row i of L and its pivot, for the last rows only.
  std::array<std::array<double, w>, w + 1> L{};
  std::array<double, w + 1> d{};
  int negative = 0;
  for (int i = 0; i < K.size(); ++i) {
    const int first = std::max(0, i - w);
    auto& row = L[static_cast<std::size_t>(i % (w + 1))];
    double pivot = K.at(i, i) - sigma * M.at(i, i);
    const double size = std::abs(K.at(i, i)) + std::abs(sigma * M.at(i, i));
    for (int j = first; j < i; ++j) {
      double scaled = K.at(i, j) - sigma * M.at(i, j);  // L_ij d_j
      const auto& other = L[static_cast<std::size_t>(j % (w + 1))];
      for (int p = std::max(first, j - w); p < j; ++p) {
        scaled -= row[static_cast<std::size_t>(p % w)] * d[static_cast<std::size_t>(p % (w + 1))] *
                  other[static_cast<std::size_t>(p % w)];
      }
      const double l = scaled / d[static_cast<std::size_t>(j % (w + 1))];
      row[static_cast<std::size_t>(j % w)] = l;
      pivot -= l * scaled;
    }
    const double least = std::numeric_limits<double>::epsilon() * size;
    if (std::abs(pivot) < least * 1e-3) pivot = least * 1e-3;
    d[static_cast<std::size_t>(i % (w + 1))] = pivot;
    if (pivot < 0.0) ++negative;
  }
  return negative;
}

Bracket bracket_lowest(const Band& K, const Band& M, int most) {
  // The lowest eigenvalue is at most Rayleigh's quotient of a unit vector.
  double high = std::numeric_limits<double>::max();
  for (int i = 0; i < K.size(); ++i) high = std::min(high, K.at(i, i) / M.at(i, i));
  high *= 1.0 + 1e-6;
  double low = high;
  const double least = high * 1e-20;
  do {
    high = low;
    low = 0.25 * high;
    if (low < least) return {};
  } while (count_below(K, M, low) > 0);
  int inside = count_below(K, M, high);
  while (high > low * (1.0 + 1e-9) && (high > 1.05 * low || inside > most)) {
    const double middle = std::sqrt(low * high);
    const int below = count_below(K, M, middle);
    if (below == 0) {
      low = middle;
    } else {
      high = middle;
      inside = below;
    }
  }
  return {low, high};
}

}  // namespace traverse::modes
