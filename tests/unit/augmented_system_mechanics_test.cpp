// The augmented equations of a mechanism against a dense solution, and the signs of its pivots.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "multibody/augmented_system.hpp"

namespace traverse::multibody {
namespace {

constexpr int bodies = 7, n = 3 * bodies, rows = 2 * (bodies - 1) + 1;

/// A tree of bodies, some coupled by springs, with two rows between neighbours and one row to the ground.
struct Example {
  AugmentedPattern pattern;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), Phi_q = Eigen::MatrixXd::Zero(rows, n);
  std::vector<int> kept;
  AugmentedSystem system;

  explicit Example(double stiffness) {
    pattern.bodies = bodies;
    pattern.pairs = {{0, 3}, {5, 1}, {2, ground}, {3, 4}};
    for (int i = 0; i < rows; ++i) {
      kept.push_back(i);
      const int body = i / 2;
      std::vector<int>& columns = pattern.rows.emplace_back();
      for (int c = 0; c < (i + 1 < rows ? 6 : 3); ++c) {
        columns.push_back(i + 1 < rows ? 3 * (c < 3 ? body / 2 : body + 1) + c % 3 : c);
        Phi_q(i, columns.back()) = std::sin(1.0 + 2.0 * i + 0.7 * c * c);
      }
    }
    system.plan(pattern);
    system.set_zero();
    const Eigen::VectorXd mass = Eigen::VectorXd::LinSpaced(n, 1.0, 4.0);
    K.diagonal() = 2.0 * mass;
    system.add_mass(mass, 2.0);
    for (int k = 0; k < static_cast<int>(pattern.pairs.size()); ++k) {
      PairMatrix A;
      for (int i = 0; i < 36; ++i) A.data()[i] = std::cos(3.0 * k + i);
      A = PairMatrix(stiffness * (A * A.transpose() + 0.1 * (A - A.transpose())));
      system.add_pair(k, A);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
          const int a = pattern.pairs[static_cast<std::size_t>(k)][static_cast<std::size_t>(i / 3)],
                    b = pattern.pairs[static_cast<std::size_t>(k)][static_cast<std::size_t>(j / 3)];
          if (a != ground && b != ground) K(3 * a + i % 3, 3 * b + j % 3) += A(i, j);
        }
    }
    system.set_constraints(Phi_q, kept);
  }
};

TEST(AugmentedSystem, DenseSolution) {
  Example example(0.5);
  ASSERT_TRUE(example.system.factor());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + rows, n + rows);
  whole << example.K, example.Phi_q.transpose(), example.Phi_q, Eigen::MatrixXd::Zero(rows, rows);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + rows);
  for (int i = 0; i < n; ++i) right[i] = std::sin(1.0 + i);
  Eigen::VectorXd x = right.head(n);
  example.system.solve(x);
  const Eigen::VectorXd exact = whole.partialPivLu().solve(right).head(n);
  EXPECT_LT((x - exact).norm(), 1e-12 * exact.norm());
  EXPECT_LT((example.Phi_q * x).norm(), 1e-12 * exact.norm());
}

TEST(AugmentedSystem, MatrixThatIsNotPositiveDefinite) { EXPECT_FALSE(Example(-50.0).system.factor()); }

}  // namespace
}  // namespace traverse::multibody
