// Long random symmetric positive definite block tridiagonal matrices in slices, with a seed for the numbers of each
// node, and common functions of the tests of the solver's windows.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "solve/block_tridiagonal.hpp"

namespace traverse::test {

/// Nodes [begin, begin + nodes) of `whole` nodes of G G^T + shift*I with a lower block bidiagonal matrix G. The entries
/// of the inverse decay faster for a larger shift; with 10 they are below 1e-15 after 20 nodes.
inline solve::BlockTridiagonal random_band(int block, int begin, int nodes, int whole, double shift) {
  const auto random = [&](int node, bool below) -> Eigen::MatrixXd {
    if (node < 0 || node >= whole || (below && node == 0)) return Eigen::MatrixXd::Zero(block, block);
    std::mt19937 generator(static_cast<unsigned>(2 * node + (below ? 1 : 0)));
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    return Eigen::MatrixXd::NullaryExpr(block, block, [&] { return number(generator); });
  };
  solve::BlockTridiagonal result(block, nodes);
  for (int i = 0; i < nodes; ++i) {
    const Eigen::MatrixXd own = random(begin + i, false);
    const Eigen::MatrixXd below = random(begin + i, true);
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * block * block;
    Eigen::Map<Eigen::MatrixXd>(result.diagonal.data() + at, block, block) =
        own * own.transpose() + below * below.transpose() + shift * Eigen::MatrixXd::Identity(block, block);
    Eigen::Map<Eigen::MatrixXd>(result.upper.data() + at, block, block) = own * random(begin + i + 1, true).transpose();
  }
  return result;
}

/// A*x of a whole matrix.
inline Eigen::VectorXd product(const solve::BlockTridiagonal& A, const Eigen::VectorXd& x) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(x.size());
  const int n = A.block;
  for (int i = 0; i < A.nodes; ++i) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * n * n;
    const Eigen::Map<const Eigen::MatrixXd> diagonal(A.diagonal.data() + at, n, n);
    const Eigen::Map<const Eigen::MatrixXd> upper(A.upper.data() + at, n, n);
    result.segment(i * n, n) += diagonal * x.segment(i * n, n);
    if (i + 1 == A.nodes) continue;
    result.segment(i * n, n) += upper * x.segment((i + 1) * n, n);
    result.segment((i + 1) * n, n) += upper.transpose() * x.segment(i * n, n);
  }
  return result;
}

/// Copies a right-hand side into x in its calls, and counts the requests for each node.
class CopyingFiller final : public solve::RhsCallback {
 public:
  CopyingFiller(Eigen::VectorXd from, int block) : from_(std::move(from)), block_(block) {
    x.setConstant(from_.size(), std::numeric_limits<double>::quiet_NaN());
    times.assign(static_cast<std::size_t>(from_.size() / block), 0);
  }
  void fill(std::ptrdiff_t first, std::ptrdiff_t past) override {
    longest = std::max(longest, past - first);
    for (std::ptrdiff_t node = first; node < past; ++node) ++times.at(static_cast<std::size_t>(node));
    x.segment(first * block_, (past - first) * block_) = from_.segment(first * block_, (past - first) * block_);
  }

  Eigen::VectorXd x;       // NaN where nothing was written
  std::vector<int> times;  // number of requests for each node
  std::ptrdiff_t longest = 0;

 private:
  Eigen::VectorXd from_;
  int block_;
};

/// Numbers between -1 and 1 at the nodes [first, past), zero at the others of [begin, begin + nodes).
inline Eigen::VectorXd load_at(int block, int begin, int nodes, int first, int past) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes) * block);
  for (int i = 0; i < nodes * block; ++i) {
    const int node = begin + i / block;
    if (first <= node && node < past) result[i] = std::sin(1.0 + 7.0 * (begin * block + i));
  }
  return result;
}

}  // namespace traverse::test
