// Matrices of bridges whose spans are equal except for a few, and their solutions in long double.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "solve/block_tridiagonal.hpp"

namespace traverse::test {

/// Spans of elements of 3 m, A = shift^2 M + K. The unknowns of a node are deflection, rotation and, if there are
/// hinges, the rotation on the right of a hinge.
struct EqualSpans {
  int spans = 1000;
  int elements = 10;       // elements per span
  double shift = 0.0;      // 1/s
  int odd_span = -1;       // index of a span with four elements; -1: none
  bool elastic = false;    // every other pier is a spring
  int spans_to_hinge = 0;  // number of spans from hinge to hinge, near a pier; 0: no hinges
  double jitter = 0.0;     // largest relative change of every entry

  struct Matrix {
    solve::BlockTridiagonal A;
    std::vector<char> fixed;
  };

  Matrix matrix() const {
    const int block = spans_to_hinge > 0 ? 3 : 2;
    std::vector<int> piers = {0};
    for (int span = 0; span < spans; ++span) piers.push_back(piers.back() + (span == odd_span ? 4 : elements));
    const int nodes = piers.back() + 1;
    Matrix result{solve::BlockTridiagonal(block, nodes), std::vector<char>(static_cast<std::size_t>(nodes * block), 0)};
    std::vector<char> hinged(static_cast<std::size_t>(nodes), 0);
    for (int span = 0; span < spans && block == 3; ++span) {
      if (span % spans_to_hinge == 0 && span != odd_span) hinged[static_cast<std::size_t>(piers[span] + 2)] = 1;
    }
    for (int node = 0; node < nodes; ++node) {
      if (block == 3 && hinged[static_cast<std::size_t>(node)] == 0)
        result.fixed[static_cast<std::size_t>(3 * node + 2)] = 1;
      if (node + 1 < nodes) add_element(result.A, node, hinged[static_cast<std::size_t>(node)] != 0 ? 2 : 1);
    }
    for (int pier = 0; pier <= spans; ++pier) {
      const int node = piers[static_cast<std::size_t>(pier)];
      if (elastic && pier % 2 == 1) {
        result.A.diagonal[static_cast<std::size_t>(node * block * block)] += 2e9;
      } else {
        result.fixed[static_cast<std::size_t>(node * block)] = 1;
      }
    }
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> number(-jitter, jitter);
    for (int i = 0; i < nodes && jitter != 0.0; ++i) {
      double* D = result.A.diagonal.data() + i * block * block;
      double* U = result.A.upper.data() + i * block * block;
      for (int c = 0; c < block; ++c) {
        for (int r = 0; r <= c; ++r) D[r + c * block] = D[c + r * block] *= 1.0 + number(generator);
        for (int r = 0; r < block; ++r) U[r + c * block] *= 1.0 + number(generator);
      }
    }
    return result;
  }

 private:
  // Adds the element from `node`, whose rotation is its unknown number `rotation`, to the next node.
  void add_element(solve::BlockTridiagonal& A, int node, int rotation) const {
    constexpr double length = 3.0, EI = 2.5e10, mass = 1e4;
    Eigen::Matrix4d K, M;
    K << 12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4;
    M << 156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4;
    const Eigen::Vector4d scale(1.0, length, 1.0, length);
    const Eigen::Matrix4d E = scale.asDiagonal() *
                              (EI / (length * length * length) * K + shift * shift * mass * length / 420.0 * M) *
                              scale.asDiagonal();
    const int b = A.block, bb = b * b;
    const std::array<int, 2> left = {0, rotation}, right = {0, 1};
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        A.diagonal[static_cast<std::size_t>(node * bb + left[r] + left[c] * b)] += E(r, c);
        A.diagonal[static_cast<std::size_t>((node + 1) * bb + right[r] + right[c] * b)] += E(2 + r, 2 + c);
        A.upper[static_cast<std::size_t>(node * bb + left[r] + right[c] * b)] += E(r, 2 + c);
      }
    }
  }
};

/// The solution by elimination from left to right in long double.
inline std::vector<double> solution_in_long_double(const EqualSpans::Matrix& m, const std::vector<double>& load) {
  using Block = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  using Node = Eigen::Matrix<long double, Eigen::Dynamic, 1, 0, 3, 1>;
  const int b = m.A.block, nodes = m.A.nodes;
  const auto held = [&](int node, int i) { return m.fixed[static_cast<std::size_t>(node * b + i)] != 0; };
  std::vector<Block> inverse, upper;
  std::vector<Node> x;
  for (int node = 0; node < nodes; ++node) {
    Block D = Eigen::Map<const Eigen::MatrixXd>(m.A.diagonal.data() + node * b * b, b, b).cast<long double>();
    Block U = Eigen::Map<const Eigen::MatrixXd>(m.A.upper.data() + node * b * b, b, b).cast<long double>();
    for (int i = 0; i < b; ++i) {
      if (node + 1 < nodes && held(node + 1, i)) U.col(i).setZero();
      if (!held(node, i)) continue;
      D.row(i).setZero();
      D.col(i).setZero();
      U.row(i).setZero();
      D(i, i) = 1.0L;
    }
    Node y = Eigen::Map<const Eigen::VectorXd>(load.data() + node * b, b).cast<long double>();
    if (node > 0) {
      D -= upper.back().transpose() * inverse.back() * upper.back();
      y -= upper.back().transpose() * inverse.back() * x.back();
    }
    inverse.push_back(D.inverse());
    upper.push_back(U);
    x.push_back(y);
  }
  std::vector<double> result(load.size());
  for (int node = nodes - 1; node >= 0; --node) {
    const auto at = static_cast<std::size_t>(node);
    if (node + 1 < nodes) x[at] -= upper[at] * x[at + 1];
    x[at] = inverse[at] * x[at];
    for (int i = 0; i < b; ++i) result[static_cast<std::size_t>(node * b + i)] = static_cast<double>(x[at](i));
  }
  return result;
}

/// Numbers between -1 and 1 for the free unknowns.
inline std::vector<double> random_load(const std::vector<char>& fixed) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<double> load(fixed.size(), 0.0);
  for (std::size_t i = 0; i < load.size(); ++i) {
    if (fixed[i] == 0) load[i] = number(generator);
  }
  return load;
}

}  // namespace traverse::test
