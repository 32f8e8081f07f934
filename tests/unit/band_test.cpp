// Bands of several widths against Eigen's dense answers.
#include "../../src/modes/band.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace traverse::modes {
namespace {

struct Pencil {
  Band K, M;
  Eigen::MatrixXd dense_K, dense_M;
};

/// K and M diagonally dominant, so positive definite.
Pencil random_pencil(int size, int width) {
  std::mt19937 generator(static_cast<unsigned>(width));
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Pencil p{Band(size, width), Band(size, width), Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
  const auto fill = [&](Band& band, Eigen::MatrixXd& dense, double diagonal) {
    for (int i = 0; i < size; ++i) {
      for (int j = std::max(0, i - width); j <= i; ++j) {
        band.at(i, j) = number(generator) + (i == j ? diagonal * width : 0.0);
        dense(i, j) = dense(j, i) = band.at(i, j);
      }
    }
  };
  fill(p.K, p.dense_K, 4.0);
  fill(p.M, p.dense_M, 3.0);
  return p;
}

class BandOfWidth : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Modes, BandOfWidth, testing::Values(1, 2, 3, 5, 7, 15));

TEST_P(BandOfWidth, CountsEigenvalues) {
  const Pencil p = random_pencil(40, GetParam());
  const auto values =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(p.dense_K, p.dense_M).eigenvalues().eval();
  EXPECT_EQ(count_below(p.K, p.M, 0.0), 0);
  for (int i = 0; i + 1 < 40; ++i) EXPECT_EQ(count_below(p.K, p.M, 0.5 * (values[i] + values[i + 1])), i + 1);
}

TEST_P(BandOfWidth, MultipliesAndSolves) {
  const Pencil p = random_pencil(40, GetParam());
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
  Eigen::VectorXd y = Eigen::VectorXd::Ones(40);
  add_product(p.K, 2.0, x.data(), y.data());
  EXPECT_LT((y - (Eigen::VectorXd::Ones(40) + 2.0 * p.dense_K * x)).norm(), 1e-12 * y.norm());
  const Factor factor(p.K);
  EXPECT_TRUE(factor.positive());
  Eigen::VectorXd back = p.dense_K * x;
  factor.solve(back.data());
  EXPECT_LT((back - x).norm(), 1e-12 * x.norm());
}

TEST(Band, FactorKnowsWhatIsNotPositive) {
  Band K(2, 1);
  K.at(0, 0) = K.at(1, 1) = 1.0;
  K.at(1, 0) = 1.0;
  EXPECT_FALSE(Factor(K).positive());
}

}  // namespace
}  // namespace traverse::modes
