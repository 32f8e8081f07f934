// Which step follows which error, and which step leads to an end.
#include "integrate/step_size_control.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace traverse::integrate {
namespace {

constexpr double longest = 0.016;  // s
constexpr double endless = std::numeric_limits<double>::infinity();

TEST(StepSizeControl, GoesDownAsFarAsTheErrorAsks) {
  StepSizeControl one(longest);
  EXPECT_FALSE(one.judge(longest, 2.0));  // half the step: an error of 2/16
  EXPECT_DOUBLE_EQ(one.wanted(), longest / 2.0);
  StepSizeControl two(longest);
  EXPECT_FALSE(two.judge(longest, 20.0));  // 20/16 would still be too much
  EXPECT_DOUBLE_EQ(two.wanted(), longest / 4.0);
  StepSizeControl far(longest);
  EXPECT_FALSE(far.judge(longest, endless));
  EXPECT_DOUBLE_EQ(far.wanted(), longest / 16.0);
}

TEST(StepSizeControl, FallsBelowAStepOfAnyLength) {
  StepSizeControl ladder(longest);
  EXPECT_FALSE(ladder.judge(0.3 * longest, 1.5));
  EXPECT_DOUBLE_EQ(ladder.wanted(), longest / 8.0);  // a quarter would leave 0.7 of the tolerance
}

TEST(StepSizeControl, GoesUpAfterTwoCalmStepsOnARung) {
  StepSizeControl ladder(longest);
  ladder.judge(longest, 2.0);
  const double h = ladder.wanted();
  EXPECT_TRUE(ladder.judge(h, 0.02));
  EXPECT_TRUE(ladder.judge(h, 0.9));  // begins again
  EXPECT_TRUE(ladder.judge(h, 0.02));
  EXPECT_TRUE(ladder.judge(0.1 * h, 1e-9));  // shorter than wanted: says nothing
  EXPECT_DOUBLE_EQ(ladder.wanted(), h);
  EXPECT_TRUE(ladder.judge(h, 0.02));
  EXPECT_DOUBLE_EQ(ladder.wanted(), longest);
  EXPECT_TRUE(ladder.judge(longest, 0.0));
  EXPECT_TRUE(ladder.judge(longest, 0.0));
  EXPECT_DOUBLE_EQ(ladder.wanted(), longest);
}

// Errors just below the tolerance keep their rung: what half the step leaves is too much for the double.
TEST(StepSizeControl, DoesNotHop) {
  StepSizeControl ladder(longest);
  ladder.judge(longest, 1.6);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(ladder.judge(ladder.wanted(), 0.1));
  EXPECT_DOUBLE_EQ(ladder.wanted(), longest / 2.0);
}

TEST(StepSizeControl, TakesAJumpAsItIsAtItsLowestRung) {
  StepSizeControl ladder(longest);
  int tried = 1;
  while (!ladder.judge(ladder.wanted(), 5.0)) ++tried;
  EXPECT_LT(tried, 20);
  EXPECT_LT(ladder.wanted(), 1e-4 * longest);
}

TEST(StepSizeControl, StaysOnTheGridBetweenSamples) {
  StepSizeControl ladder(longest);
  EXPECT_DOUBLE_EQ(ladder.towards(3.0 * longest, endless), longest);
  EXPECT_DOUBLE_EQ(ladder.towards(1.25 * longest, endless), 0.25 * longest);  // then whole steps again
  EXPECT_EQ(ladder.towards(longest * (1.0 + 1e-12), endless), longest * (1.0 + 1e-12));
  EXPECT_DOUBLE_EQ(ladder.towards(3.0 * longest, 0.3 * longest), 0.25 * longest);  // an impact's limit
}

// Before an event off the grid: rungs, and what is left in one step or two equal ones.
TEST(StepSizeControl, EndsAtEventsWithOneOddLength) {
  StepSizeControl ladder(longest);
  double left = 3.3 * longest;
  EXPECT_DOUBLE_EQ(ladder.towards(left, endless), longest);
  left -= 2.0 * longest;
  EXPECT_DOUBLE_EQ(ladder.towards(left, endless), 0.65 * longest);
  left -= 0.65 * longest;
  EXPECT_EQ(ladder.towards(left, endless), left);
}

}  // namespace
}  // namespace traverse::integrate
