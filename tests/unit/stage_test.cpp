// Whatever takes long is told.
#include "results/stage.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace traverse::results {
namespace {

TEST(HeartbeatTest, TellsTheOuterAndTheInnerStage) {
  ::testing::internal::CaptureStdout();
  {
    const Heartbeat heartbeat(false, 0.01);
    const Stage outer("trial runs");
    const Stage inner("time steps");
    EXPECT_STREQ(Stage::now(), "trial runs");
    Stage::advance(0.25);
    const long before = Heartbeat::lines();
    while (Heartbeat::lines() < before + 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const std::string text = ::testing::internal::GetCapturedStdout();
  EXPECT_NE(text.find("trial runs, time steps: 25 %, 0 s so far"), std::string::npos) << text;
}

TEST(HeartbeatTest, IsSilentOutsideOfStages) {
  ::testing::internal::CaptureStdout();
  {
    const Heartbeat heartbeat(false, 0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace traverse::results
