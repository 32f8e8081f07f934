// Random symmetric positive definite block tridiagonal matrices, the same on every rank, whole and as slices.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "solve/block_tridiagonal.hpp"

namespace traverse::test {

/// Numbers between -1 and 1 from a seed.
inline Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(generator); });
}

/// G G^T + shift*I with a random lower block bidiagonal matrix G. The entries of the inverse decay faster for a larger
/// shift.
inline Eigen::MatrixXd random_spd(int block, int nodes, double shift, unsigned seed) {
  Eigen::MatrixXd G = random_matrix(block * nodes, block * nodes, seed);
  for (int row = 0; row < nodes; ++row) {
    for (int column = 0; column < nodes; ++column) {
      if (column != row && column != row - 1) G.block(row * block, column * block, block, block).setZero();
    }
  }
  return G * G.transpose() + shift * Eigen::MatrixXd::Identity(G.rows(), G.cols());
}

/// Cuts the connection between node and node + 1.
inline void disconnect(Eigen::MatrixXd& A, int block, int node) {
  A.block(node * block, (node + 1) * block, block, block).setZero();
  A.block((node + 1) * block, node * block, block, block).setZero();
}

/// Nodes [begin, begin + nodes) of a whole block tridiagonal matrix.
inline solve::BlockTridiagonal slice(const Eigen::MatrixXd& A, int block, int begin, int nodes) {
  solve::BlockTridiagonal result(block, nodes);
  const Eigen::Index whole = A.rows() / block;
  for (int i = 0; i < nodes; ++i) {
    const Eigen::Index row = (begin + i) * block;
    Eigen::Map<Eigen::MatrixXd>(result.diagonal.data() + i * block * block, block, block) =
        A.block(row, row, block, block);
    if (begin + i + 1 == whole) continue;
    Eigen::Map<Eigen::MatrixXd>(result.upper.data() + i * block * block, block, block) =
        A.block(row, row + block, block, block);
  }
  return result;
}

/// The solution of the whole system, in which rows and columns of fixed unknowns are replaced by those of the identity
/// matrix.
inline Eigen::MatrixXd dense_solution(Eigen::MatrixXd A, const std::vector<char>& fixed, const Eigen::MatrixXd& b) {
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] == 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    A.row(row).setZero();
    A.col(row).setZero();
    A(row, row) = 1.0;
  }
  return A.llt().solve(b);
}

/// Marks about one unknown in four.
inline std::vector<char> random_fixed(int unknowns, unsigned seed) {
  const Eigen::MatrixXd numbers = random_matrix(unknowns, 1, seed);
  std::vector<char> fixed;
  for (double number : numbers.col(0)) fixed.push_back(number > 0.5 ? 1 : 0);
  return fixed;
}

}  // namespace traverse::test
