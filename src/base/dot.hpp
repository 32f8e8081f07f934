// The scalar product of long vectors.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace traverse::base {

/// a^T b; b has as many numbers as a.
inline double dot(const std::vector<double>& a, const double* b) {
  const auto size = static_cast<Eigen::Index>(a.size());
  return Eigen::Map<const Eigen::VectorXd>(a.data(), size).dot(Eigen::Map<const Eigen::VectorXd>(b, size));
}

}  // namespace traverse::base
