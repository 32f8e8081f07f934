// The search for the intervals in which a sampled ratio does not exceed 1.
#include "study/interval_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace traverse::study {
namespace {

struct Searched {
  std::vector<double> value, ratio;
};

/// Samples of the curve at the first values and at all that the search adds.
Searched search(double from, double to, int points, double accuracy, const std::function<double(double)>& curve) {
  Searched searched;
  for (int i = 0; i < points; ++i) searched.value.push_back(from + (to - from) * i / (points - 1));
  while (true) {
    searched.ratio.clear();
    for (const double x : searched.value) searched.ratio.push_back(curve(x));
    const std::vector<double> more = values_to_add(searched.value, {searched.ratio}, accuracy);
    if (more.empty()) return searched;
    searched.value.insert(searched.value.end(), more.begin(), more.end());
    std::sort(searched.value.begin(), searched.value.end());
    if (searched.value.size() > 500) return searched;  // it does not end
  }
}

TEST(IntervalSearch, EndsAreKnownToTheAccuracyWithFewSamples) {
  const auto curve = [](double x) { return 2.0 / (x * x); };  // 1 at sqrt(2)
  const Searched found = search(0.5, 5.0, 9, 1e-6, curve);
  const std::vector<WithinInterval> intervals = intervals_within(found.value, found.ratio);
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_NEAR(intervals[0].from, std::sqrt(2.0), 1e-6 * std::sqrt(2.0));
  EXPECT_GE(intervals[0].from, std::sqrt(2.0));
  EXPECT_EQ(intervals[0].to, 5.0);
  EXPECT_FALSE(intervals[0].from_is_end);
  EXPECT_TRUE(intervals[0].to_is_end);
  EXPECT_LE(found.value.size(), 30U);  // bisection alone would need 20 more
}

TEST(IntervalSearch, AResonanceBetweenTwoSamplesIsFound) {
  const auto resonance = [](double x) {
    const double r = x / 3.1, zeta = 0.05;
    return 0.11 / std::hypot(1.0 - r * r, 2.0 * zeta * r);  // 1.1 at the peak, above 1 for 2.5 % on each side
  };
  const Searched found = search(1.0, 5.0, 17, 1e-4, resonance);
  const std::vector<WithinInterval> intervals = intervals_within(found.value, found.ratio);
  ASSERT_EQ(intervals.size(), 2U);
  for (const double end : {intervals[0].to, intervals[1].from}) EXPECT_NEAR(resonance(end), 1.0, 1e-2);
  EXPECT_LT(intervals[0].to, 3.1);
  EXPECT_GT(intervals[1].from, 3.1);
}

TEST(IntervalSearch, AKinkAndAJumpAreBracketed) {
  const auto kink = [](double x) { return std::max(0.9 + 0.1 * (x - 2.0), 1.0 + 5.0 * (x - 2.5)); };
  const std::vector<WithinInterval> of_kink = [&] {
    const Searched found = search(1.0, 4.0, 5, 1e-5, kink);
    return intervals_within(found.value, found.ratio);
  }();
  ASSERT_EQ(of_kink.size(), 1U);
  EXPECT_NEAR(of_kink[0].to, 2.5, 3e-5);
  const Searched jump = search(1.0, 4.0, 5, 1e-5, [](double x) { return x < 2.345678 ? 0.2 : 7.0; });
  const std::vector<WithinInterval> of_jump = intervals_within(jump.value, jump.ratio);
  ASSERT_EQ(of_jump.size(), 1U);
  EXPECT_NEAR(of_jump[0].to, 2.345678, 3e-5);
}

TEST(IntervalSearch, UnknownRatiosAreNotWithinTheBound) {
  const Searched found = search(1.0, 3.0, 5, 1e-3, [](double x) { return x < 2.2 ? 0.5 : std::nan(""); });
  const std::vector<WithinInterval> intervals = intervals_within(found.value, found.ratio);
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_NEAR(intervals[0].to, 2.2, 3e-3);
}

TEST(IntervalSearch, NoIntervalWhereTheBoundIsExceededEverywhere) {
  const Searched found = search(1.0, 3.0, 5, 1e-3, [](double x) { return 1.5 + 0.1 * x; });
  EXPECT_TRUE(intervals_within(found.value, found.ratio).empty());
  EXPECT_EQ(found.value.size(), 5U);
}

}  // namespace
}  // namespace traverse::study
