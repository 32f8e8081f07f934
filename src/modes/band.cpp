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

double highest_quotient(const Band& K, const Band& M) {
  double highest = 0.0;
  for (int i = 0; i < K.size(); ++i) highest = std::max(highest, K.at(i, i) / M.at(i, i));
  return highest;
}

Bracket bracket_lowest(const Band& K, const Band& M) {
  // The lowest eigenvalue is at most Rayleigh's quotient of a unit vector.
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

Bracket narrow(Bracket b, int most, double narrowest, const std::function<int(double)>& below) {
  int inside = below(b.high);
  while (b.high > b.low * (1.0 + narrowest) && (b.high > 1.05 * b.low || inside > most)) {
    const double middle = std::sqrt(b.low) * std::sqrt(b.high);
    const int there = below(middle);
    if (there <= 0) {
      b.low = middle;
    } else {
      b.high = middle;
      inside = there;
    }
  }
  // Low close to the lowest one, as seen from the others in the bracket.
  double lowest = b.high;
  while (inside > 1 && lowest - b.low > std::max(0.1 * (b.high - b.low), narrowest * b.low)) {
    const double middle = 0.5 * (b.low + lowest);
    (below(middle) <= 0 ? b.low : lowest) = middle;
  }
  return b;
}

}  // namespace traverse::modes
