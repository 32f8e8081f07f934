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
  EXPECT_FALSE(one.evaluate(longest, 2.0));  // half the step: an error of 2/16
  EXPECT_DOUBLE_EQ(one.allowed_step(), longest / 2.0);
  StepSizeControl two(longest);
  EXPECT_FALSE(two.evaluate(longest, 20.0));  // 20/16 would still be too much
  EXPECT_DOUBLE_EQ(two.allowed_step(), longest / 4.0);
  StepSizeControl far(longest);
  EXPECT_FALSE(far.evaluate(longest, endless));
  EXPECT_DOUBLE_EQ(far.allowed_step(), longest / 16.0);
}

TEST(StepSizeControl, FallsBelowAStepOfAnyLength) {
  StepSizeControl ladder(longest);
  EXPECT_FALSE(ladder.evaluate(0.3 * longest, 1.5));
  EXPECT_DOUBLE_EQ(ladder.allowed_step(), longest / 8.0);  // a quarter would leave 0.7 of the tolerance
}

TEST(StepSizeControl, GoesUpAfterTwoCalmStepsOnARung) {
  StepSizeControl ladder(longest);
  ladder.evaluate(longest, 2.0);
  const double h = ladder.allowed_step();
  EXPECT_TRUE(ladder.evaluate(h, 0.02));
  EXPECT_TRUE(ladder.evaluate(h, 0.9));  // begins again
  EXPECT_TRUE(ladder.evaluate(h, 0.02));
  EXPECT_TRUE(ladder.evaluate(0.1 * h, 1e-9));  // shorter than wanted: says nothing
  EXPECT_DOUBLE_EQ(ladder.allowed_step(), h);
  EXPECT_TRUE(ladder.evaluate(h, 0.02));
  EXPECT_DOUBLE_EQ(ladder.allowed_step(), longest);
  EXPECT_TRUE(ladder.evaluate(longest, 0.0));
  EXPECT_TRUE(ladder.evaluate(longest, 0.0));
  EXPECT_DOUBLE_EQ(ladder.allowed_step(), longest);
}

// Errors just below the tolerance keep their rung: what half the step leaves is too much for the double.
TEST(StepSizeControl, DoesNotHop) {
  StepSizeControl ladder(longest);
  ladder.evaluate(longest, 1.6);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(ladder.evaluate(ladder.allowed_step(), 0.1));
  EXPECT_DOUBLE_EQ(ladder.allowed_step(), longest / 2.0);
}

TEST(StepSizeControl, TakesAJumpAsItIsAtItsLowestRung) {
  StepSizeControl ladder(longest);
  int tried = 1;
  while (!ladder.evaluate(ladder.allowed_step(), 5.0)) ++tried;
  EXPECT_LT(tried, 20);
  EXPECT_LT(ladder.allowed_step(), 1e-4 * longest);
}

TEST(StepSizeControl, StaysOnTheGridBetweenSamples) {
  StepSizeControl ladder(longest);
  EXPECT_DOUBLE_EQ(ladder.next_step(3.0 * longest, endless), longest);
  EXPECT_DOUBLE_EQ(ladder.next_step(1.25 * longest, endless), 0.25 * longest);  // then whole steps again
  EXPECT_EQ(ladder.next_step(longest * (1.0 + 1e-12), endless), longest * (1.0 + 1e-12));
  EXPECT_DOUBLE_EQ(ladder.next_step(3.0 * longest, 0.3 * longest), 0.25 * longest);  // an impact's limit
}

// Before an event off the grid: rungs, and what is left in one step or two equal ones.
TEST(StepSizeControl, EndsAtEventsWithOneOddLength) {
  StepSizeControl ladder(longest);
  double left = 3.3 * longest;
  EXPECT_DOUBLE_EQ(ladder.next_step(left, endless), longest);
  left -= 2.0 * longest;
  EXPECT_DOUBLE_EQ(ladder.next_step(left, endless), 0.65 * longest);
  left -= 0.65 * longest;
  EXPECT_EQ(ladder.next_step(left, endless), left);
}

}  // namespace
}  // namespace traverse::integrate
