// Exact frequencies of a uniform Timoshenko beam by the transfer of (v, theta, M, V) along it, without shape functions:
//   v' = theta - V/GA,  theta' = M/EI,  M' = V - rho I omega^2 theta,  V' = m omega^2 v
// At a crack theta jumps by M/k. All numbers are long double.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"

namespace traverse::test::exact {

struct UniformBeam {
  long double length, EI, GA, mass, rotary;  // GA 0: no shear deformation
  long double crack_at = 0.0L, crack_k = 0.0L;
};

using Transfer = Eigen::Matrix<long double, 4, 4>;

/// exp(A x) by Taylor's series over short pieces.
inline Transfer transfer(const UniformBeam& b, long double omega, long double x) {
  Transfer A = Transfer::Zero();
  A(0, 1) = 1.0L;
  A(0, 3) = b.GA > 0.0L ? -1.0L / b.GA : 0.0L;
  A(1, 2) = 1.0L / b.EI;
  A(2, 1) = -b.rotary * omega * omega;
  A(2, 3) = 1.0L;
  A(3, 0) = b.mass * omega * omega;
  constexpr int pieces = 64, terms = 16;
  A *= x / pieces;
  Transfer piece = Transfer::Identity(), term = Transfer::Identity(), whole = Transfer::Identity();
  for (int n = 1; n <= terms; ++n) {
    term = (term * A / static_cast<long double>(n)).eval();
    piece += term;
  }
  for (int i = 0; i < pieces; ++i) whole = (piece * whole).eval();
  return whole;
}

/// The two of v, theta, M, V that are zero at a support.
inline std::pair<int, int> vanishing(beam::Support s) {
  return {beam::fixes_vertical(s) ? 0 : 3, beam::fixes_rotation(s) ? 1 : 2};
}

/// The frequency determinant. Its 2 x 2 matrix transfers the non-zero quantities at the left end to the quantities that
/// are zero at the right end.
inline long double determinant(const UniformBeam& b, beam::Support left, beam::Support right, long double omega) {
  Transfer whole = transfer(b, omega, b.length);
  if (b.crack_k > 0.0L) {
    Transfer jump = Transfer::Identity();
    jump(1, 2) = 1.0L / b.crack_k;
    whole = transfer(b, omega, b.length - b.crack_at) * jump * transfer(b, omega, b.crack_at);
  }
  const auto [a0, a1] = vanishing(left);
  const auto [b0, b1] = vanishing(right);
  const int c0 = 3 - a0, c1 = 3 - a1;  // their partners: v and V, theta and M
  return whole(b0, c0) * whole(b1, c1) - whole(b0, c1) * whole(b1, c0);
}

/// The lowest non-zero frequencies, rad/s, searched in intervals that are small compared with their distances.
inline std::vector<double> frequencies(const UniformBeam& b, beam::Support left, beam::Support right, int count) {
  const long double step = 0.02L * std::sqrt(b.EI / b.mass) / (b.length * b.length);
  std::vector<double> found;
  long double low = 10.0L * step, at_low = determinant(b, left, right, low);
  while (static_cast<int>(found.size()) < count) {
    long double high = low + step;
    const long double at_high = determinant(b, left, right, high);
    if ((at_low < 0.0L) != (at_high < 0.0L)) {
      long double from = low, to = high;
      for (int i = 0; i < 60; ++i) {
        const long double middle = 0.5L * (from + to);
        ((determinant(b, left, right, middle) < 0.0L) == (at_low < 0.0L) ? from : to) = middle;
      }
      found.push_back(static_cast<double>(0.5L * (from + to)));
    }
    low = high;
    at_low = at_high;
  }
  return found;
}

}  // namespace traverse::test::exact
