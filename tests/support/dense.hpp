// Dense matrices and solutions of a beam without the program's solvers, for small beams on one rank.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "beam/beam.hpp"
#include "beam/nonlinear_points.hpp"
#include "support/rows.hpp"

namespace traverse::test {

inline Eigen::MatrixXd dense(Mat matrix) {
  const std::vector<std::vector<double>> rows = local_rows(matrix);
  Eigen::MatrixXd A(rows.size(), rows.size());
  for (Eigen::Index i = 0; i < A.rows(); ++i) A.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), A.cols());
  return A;
}

/// shift2 M + shift C* + K*; the rows and columns of held unknowns are empty.
inline Eigen::MatrixXd dense_operator(const beam::Beam& beam, double shift, double shift2) {
  return shift2 * dense(beam.mass()) + shift * dense(beam.damping()) + dense(beam.stiffness());
}

/// The inverse of A for the free unknowns; 0 for other unknowns.
inline Eigen::MatrixXd dense_inverse(const beam::Beam& beam, Eigen::MatrixXd A) {
  const Eigen::VectorXd scale = A.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (beam.fixed()[i] != 0) A(i, i) = 1.0;
  const Eigen::VectorXd s = scale.unaryExpr([](double d) { return d > 0.0 ? d : 1.0; });
  Eigen::MatrixXd inverse = (s.asDiagonal() * A * s.asDiagonal()).inverse();
  inverse = s.asDiagonal() * inverse * s.asDiagonal();
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    if (beam.fixed()[i] == 0) continue;
    inverse.row(i).setZero();
    inverse.col(i).setZero();
  }
  return inverse;
}

/// The vector whose product with the unknowns is the displacement at a point of the foundation.
inline Eigen::VectorXd dense_shape(const beam::Beam& beam, const beam::NonlinearPoint& point) {
  Eigen::VectorXd N = Eigen::VectorXd::Zero(beam.local_unknowns());
  const beam::NonlinearShape shape = beam::shape_of(beam.bridge(), point);
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
    if (shape.unknown[i] >= 0) N[shape.unknown[i]] += shape.shape[i];
  return N;
}

}  // namespace traverse::test
