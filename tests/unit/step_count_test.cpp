// The counted steps of a run, against those counted by hand.
#include <gtest/gtest.h>

#include "integrate/step_size_control.hpp"

namespace traverse::integrate {
namespace {

TEST(StepCount, OfEqualIntervals) {
  const StepCount count = count_steps(1.0, 0.1, 0.03, {}, 12);  // 4 steps of 0.025 s in each
  EXPECT_DOUBLE_EQ(count.steps, 40.0);
  EXPECT_DOUBLE_EQ(count.lengths, 1.0);
}

TEST(StepCount, WithAnEndBetweenSamples) {
  const StepCount count = count_steps(1.05, 0.1, 0.03, {}, 12);  // 2 more steps of 0.025 s
  EXPECT_DOUBLE_EQ(count.steps, 42.0);
  EXPECT_DOUBLE_EQ(count.lengths, 1.0);
}

// From 0.2: 0.02 s in one step, then 0.08 s in 3 of 0.0267 s.
TEST(StepCount, WithAStop) {
  const StepCount count = count_steps(1.0, 0.1, 0.03, {0.22}, 12);
  EXPECT_DOUBLE_EQ(count.steps, 40.0);
  EXPECT_DOUBLE_EQ(count.lengths, 3.0);
}

// A stop at a sample and two at the same time are no further ends.
TEST(StepCount, WithStopsThatAreOne) {
  const StepCount count = count_steps(1.0, 0.1, 0.03, {0.1, 0.22, 0.22, 0.220001, 1.0, 3.0}, 12);
  EXPECT_DOUBLE_EQ(count.steps, 40.0);
  EXPECT_DOUBLE_EQ(count.lengths, 3.0);
}

// Rows every 0.01 s and steps of at most 0.004 s: 3 steps in each of 100 rows; samples every 0.5 s are rows.
TEST(StepCount, WithTheRowsOfATable) {
  std::vector<double> rows;
  for (int i = 0; i <= 100; ++i) rows.push_back(0.01 * i);
  const StepCount count = count_steps(1.0, 0.5, 0.004, rows, 12);
  EXPECT_DOUBLE_EQ(count.steps, 300.0);
  EXPECT_DOUBLE_EQ(count.lengths, 1.0);
}

// Lengths of 0.1, 0.09 and 0.08 s follow each other three times: three factorisations, or one each time if only two are
// kept.
TEST(StepCount, WithAFewStoredFactorisations) {
  std::vector<double> stops;
  for (int i = 0; i < 3; ++i)
    for (const double at : {0.1, 0.19, 0.27}) stops.push_back(0.27 * i + at);
  EXPECT_DOUBLE_EQ(count_steps(0.81, 0.81, 0.1, stops, 12).lengths, 3.0);
  EXPECT_DOUBLE_EQ(count_steps(0.81, 0.81, 0.1, stops, 2).lengths, 9.0);
  EXPECT_DOUBLE_EQ(count_steps(0.81, 0.81, 0.1, stops, 2).steps, 9.0);
}

TEST(StepCount, OfVeryManySamplesTakesNoTime) {
  EXPECT_DOUBLE_EQ(count_steps(1.0e6, 1.0e-3, 1.0e-3, {}, 12).steps, 1.0e9);
}

}  // namespace
}  // namespace traverse::integrate
