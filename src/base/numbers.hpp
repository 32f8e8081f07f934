// Conversion to int of ratios of user values, which may exceed the range of int, and the scalar product of arrays.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace traverse::base {

/// x truncated to an integer and limited to [-most, most]; `most` for NaN.
inline int whole(double x, int most = std::numeric_limits<int>::max()) {
  if (!(x < most)) return most;
  return x > -most ? static_cast<int>(x) : -most;
}

/// a^T b; b has as many numbers as a.
inline double dot(const std::vector<double>& a, const double* b) {
  const auto size = static_cast<Eigen::Index>(a.size());
  return Eigen::Map<const Eigen::VectorXd>(a.data(), size).dot(Eigen::Map<const Eigen::VectorXd>(b, size));
}

}  // namespace traverse::base
