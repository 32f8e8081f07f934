// Natural frequencies of a beam whose EI and mass vary smoothly along x, by Ritz' method with Legendre polynomials.
// There is no mesh, and the errors decrease exponentially with the number of terms.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace traverse::test {

struct RitzBeam {
  double length;
  std::function<double(double)> EI, mass;  // functions of x, polynomials of low degree
  int left, right;                         // held derivatives: 0 free, 1 deflection, 2 deflection and slope
};

/// The `count` lowest frequencies, rad/s, with the terms (1 + xi)^left (1 - xi)^right P_j(xi), j < terms, -1 <= xi
/// <= 1.
inline std::vector<double> ritz_frequencies(const RitzBeam& beam, int count, int terms = 24) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  struct Value {
    Real value, slope, curvature;
    Value operator*(const Value& o) const {
      return {value * o.value, slope * o.value + value * o.slope,
              curvature * o.value + 2 * slope * o.slope + value * o.curvature};
    }
  };
  const auto legendre = [](int degree, Real xi) {
    Value before{1, 0, 0}, now{xi, 1, 0};
    if (degree == 0) return before;
    for (int j = 1; j < degree; ++j) {  // (j + 1) P_(j+1) = (2 j + 1) xi P_j - j P_(j-1)
      const Value product = Value{xi, 1, 0} * now;
      const Real a = (2 * j + 1) / static_cast<Real>(j + 1), b = j / static_cast<Real>(j + 1);
      const Value next{a * product.value - b * before.value, a * product.slope - b * before.slope,
                       a * product.curvature - b * before.curvature};
      before = now;
      now = next;
    }
    return now;
  };
  const int points = terms + 8;  // exact for the products of two terms with EI and mass of degree 7
  const Real half = beam.length / 2;
  Matrix K = Matrix::Zero(terms, terms), M = K;
  for (int p = 0; p < points; ++p) {
    Real xi = std::cos(std::numbers::pi_v<Real> * (p + 0.75L) / (points + 0.5L));
    for (int i = 0; i < 10; ++i) xi -= legendre(points, xi).value / legendre(points, xi).slope;
    const Real slope = legendre(points, xi).slope, weight = 2 / ((1 - xi * xi) * slope * slope);
    Value ends{1, 0, 0};
    for (int i = 0; i < beam.left; ++i) ends = ends * Value{1 + xi, 1, 0};
    for (int i = 0; i < beam.right; ++i) ends = ends * Value{1 - xi, -1, 0};
    Eigen::Matrix<Real, Eigen::Dynamic, 1> v(terms), curvature(terms);
    for (int j = 0; j < terms; ++j) {
      const Value term = ends * legendre(j, xi);
      v(j) = term.value;
      curvature(j) = term.curvature / (half * half);
    }
    const double x = static_cast<double>((1 + xi) * half);
    M += weight * half * static_cast<Real>(beam.mass(x)) * v * v.transpose();
    K += weight * half * static_cast<Real>(beam.EI(x)) * curvature * curvature.transpose();
  }
  // In the inverted problem M x = mu (K + shift M) x the lowest frequencies are the most accurate.
  const Real shift = beam.EI(0.0) / (beam.mass(0.0) * std::pow(beam.length, 4));
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(M, K + shift * M, Eigen::EigenvaluesOnly);
  std::vector<double> omega;
  for (int i = 0; i < count; ++i) {
    const Real squared = 1 / solver.eigenvalues()(terms - 1 - i) - shift;
    omega.push_back(static_cast<double>(std::sqrt(std::max(squared, Real(0)))));
  }
  return omega;
}

}  // namespace traverse::test
