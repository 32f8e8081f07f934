// Random streams, quantiles and their intervals.
#include "results/study_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random_stream.hpp"

namespace traverse::results {
namespace {

// Table values: the median of 100 samples lies between the 40th and the 61st smallest with 95 % (Conover 1999); 0.98 of
// 1,000: 980 -+ 1.96 sqrt(1000 0.98 0.02), and a little skewed.
TEST(QuantileRanks, AreThoseOfTheBinomialLaw) {
  const RankInterval median = quantile_ranks(100, 0.5, 0.95);
  EXPECT_EQ(median.lower, 40u);
  EXPECT_EQ(median.upper, 61u);
  const RankInterval ten = quantile_ranks(10, 0.5, 0.95);  // 2 and 9: 97.9 %
  EXPECT_EQ(ten.lower, 2u);
  EXPECT_EQ(ten.upper, 9u);
  const RankInterval high = quantile_ranks(1000, 0.98, 0.95);
  EXPECT_NEAR(static_cast<double>(high.lower), 971.0, 1.0);
  EXPECT_NEAR(static_cast<double>(high.upper), 989.0, 1.0);
}

TEST(QuantileRanks, AreOpenWhereSamplesAreFew) {
  EXPECT_EQ(quantile_ranks(20, 0.98, 0.95).upper, 21u);
  EXPECT_EQ(quantile_ranks(5, 0.5, 0.95).lower, 0u);
  EXPECT_EQ(quantile_ranks(5, 0.5, 0.95).upper, 6u);
}

TEST(Quantile, LiesBetweenOrderStatistics) {
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 0.75), 3.0);
  EXPECT_EQ(quantile({1.0, 2.0, 4.0}, 1.0), 4.0);
}

// The interval holds the true quantile about as often as it says: of 400 samples of 50 each.
TEST(QuantileRanks, HoldTheQuantileAsOftenAsTheySay) {
  const RankInterval ranks = quantile_ranks(50, 0.8, 0.9);
  int held = 0;
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    const base::RandomStream stream(trial, "samples");
    std::vector<double> x;
    for (std::uint64_t i = 0; i < 50; ++i) x.push_back(stream.uniform(i));
    std::sort(x.begin(), x.end());
    held += x[ranks.lower - 1] <= 0.8 && 0.8 <= x[ranks.upper - 1] ? 1 : 0;
  }
  EXPECT_GT(held, 355);
  EXPECT_LT(held, 400);
}

TEST(RandomStream, HasTheMomentsOfItsLaw) {
  const base::RandomStream stream(1, "beam_mass");
  const int n = 100000;
  double mean = 0.0, square = 0.0, fourth = 0.0, uniform = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = stream.normal(static_cast<std::uint64_t>(i));
    mean += x / n;
    square += x * x / n;
    fourth += x * x * x * x / n;
    uniform += stream.uniform(static_cast<std::uint64_t>(i)) / n;
  }
  EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth, 3.0, 4.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(uniform, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / n));
}

TEST(RandomStream, NamesAndSeedsMakeStreamsOfTheirOwn) {
  const base::RandomStream a(1, "a"), b(1, "b"), again(1, "a"), other(2, "a");
  double with_b = 0.0, with_other = 0.0, shifted = 0.0;
  const int n = 10000;
  for (std::uint64_t i = 0; i < n; ++i) {
    EXPECT_EQ(a.normal(i), again.normal(i));
    with_b += a.normal(i) * b.normal(i) / n;
    with_other += a.normal(i) * other.normal(i) / n;
    shifted += a.normal(i) * a.normal(i + 1) / n;
  }
  for (const double correlation : {with_b, with_other, shifted}) EXPECT_NEAR(correlation, 0.0, 4.0 / std::sqrt(n));
}

}  // namespace
}  // namespace traverse::results
