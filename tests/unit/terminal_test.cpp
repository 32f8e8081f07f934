// What a user reads at the end of a run.
#include "results/terminal.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace traverse::results {
namespace {

template <class Print>
std::string printed(Print&& print) {
  ::testing::internal::CaptureStdout();
  print();
  std::fflush(stdout);
  return ::testing::internal::GetCapturedStdout();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(TerminalTest, SummaryEndsWithThePlaceOfTheResults) {
  Summary summary;
  summary.deflection = {-0.00421, 1.25, 40.0};
  summary.moment = {1.5e6, 1.0, 12.5};
  summary.amplification = 1.084;
  summary.least_wheel = "vehicle 3, rear_wheel";
  summary.least_wheel_force = 31200.0;
  summary.least_wheel_force_time = 2.5;
  summary.contact_losses = 2;
  summary.longest_loss = 0.012;
  summary.steps = 400;
  summary.wall_seconds = 2.0;
  const std::string text = printed([&] { print_summary(summary, "results/run.h5"); });
  EXPECT_TRUE(contains(text, "-4.21 mm")) << text;
  EXPECT_TRUE(contains(text, "x = 40 m, t = 1.25 s")) << text;
  EXPECT_TRUE(contains(text, "1500 kN m")) << text;
  EXPECT_TRUE(contains(text, "1.084")) << text;
  EXPECT_TRUE(contains(text, "31.2 kN")) << text;
  EXPECT_TRUE(contains(text, "vehicle 3, rear_wheel, t = 2.5 s")) << text;
  EXPECT_TRUE(contains(text, "the longest 12 ms")) << text;
  EXPECT_TRUE(contains(text, "5 ms a step")) << text;
  EXPECT_TRUE(text.ends_with("results  results/run.h5\n")) << text;
}

TEST(TerminalTest, SummaryLeavesOutWhatTheSceneHasNot) {
  const std::string text = printed([] { print_summary({}, "run.h5"); });
  EXPECT_FALSE(contains(text, "deflection")) << text;
  EXPECT_FALSE(contains(text, "wheel")) << text;
  EXPECT_TRUE(text.ends_with("results  run.h5\n")) << text;
}

TEST(TerminalTest, ModesArePrintedInHertz) {
  const std::string text = printed([] {
    print_modes(
        {.omega = {0.0, 31.41592653589793}, .motion = {modes::Motion::bending, modes::Motion::along}, .shape = {}},
        31.4159, 60.0, 0.5, 1e-3);
  });
  EXPECT_TRUE(contains(text, "rigid")) << text;
  EXPECT_TRUE(contains(text, "31.4159   along x")) << text;
  EXPECT_TRUE(contains(text, " 5 ")) << text;
  EXPECT_TRUE(contains(text, "a = 0.5 1/s, b = 0.001 s")) << text;
}

TEST(TerminalTest, DampedModesStandBesideTheUndampedOnes) {
  const double omega = 31.41592653589793;
  const modes::DampedModes same = {.lambda = {0.0, {-0.6 * omega, 0.8 * omega}},
                                   .motion = {modes::Motion::bending, modes::Motion::along},
                                   .shape = {}};
  const std::string text = printed([&] {
    print_modes({.omega = {0.0, omega}, .motion = {modes::Motion::bending, modes::Motion::along}, .shape = {}}, omega,
                60.0, 0.0, 0.0, same);
  });
  EXPECT_TRUE(contains(text, "damped (Hz)")) << text;
  EXPECT_TRUE(contains(text, "31.4159   along x                 4               0.6           18.8496   along x"))
      << text;
  EXPECT_FALSE(contains(text, "need not be")) << text;

  const modes::DampedModes overdamped = {
      .lambda = {0.0, -20.0, {-1.0, 40.0}},
      .motion = {modes::Motion::bending, modes::Motion::bending, modes::Motion::along},
      .shape = {}};
  const std::string more = printed([&] {
    print_modes({.omega = {0.0, omega}, .motion = {modes::Motion::bending, modes::Motion::along}, .shape = {}}, omega,
                60.0, 0.0, 0.0, overdamped);
  });
  EXPECT_TRUE(contains(more, " 1                20   overdamped")) << more;
  EXPECT_TRUE(contains(more, "   3                                      ")) << more;
  EXPECT_TRUE(contains(more, "a row need not be one mode")) << more;
}

TEST(TerminalTest, ShortRunsShowNoProgress) {
  using Clock = std::chrono::steady_clock;
  std::string text;
  const auto silent = [&] {  // in less time than the two seconds after which progress is shown
    const auto begin = Clock::now();
    text = printed([] {
      Progress progress(0.0, 1.0, false);
      for (int i = 1; i <= 100; ++i) progress.update(0.01 * i, i);
      progress.done();
    });
    return Clock::now() - begin < std::chrono::seconds(2);
  };
  while (!silent()) continue;  // again where something else held the machine up
  EXPECT_EQ(text, "");
}

}  // namespace
}  // namespace traverse::results
