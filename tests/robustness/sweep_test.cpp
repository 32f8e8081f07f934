// Sweeps that do not get to their end: one run fails, a signal comes, the input is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::size_t known(const std::vector<double>& values) {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
}

// An explicit method with a step far too long. The slowest run is the longest and dealt first.
TEST(SweepFails, ByOneRunThatIsNamed) {
  const Workplace workplace(std::string(two_spans) +
                            "load: {forces: 1.0e5}\nsweep: {speed: [20, 60, 20]}\nts_type: rk\nts_dt: 0.03\n");
  for (const int ranks : {1, 2}) {
    const Outcome outcome = workplace.run({"-output_file", "r.h5"}, ranks);
    EXPECT_NE(outcome.status, 0);
    const std::vector<std::string> lines = complaints(outcome);
    ASSERT_EQ(lines.size(), 1u) << outcome.err;
    EXPECT_NE(lines[0].find("the run at 20 m/s (72 km/h) failed: "), std::string::npos) << lines[0];
    EXPECT_EQ(Results(workplace.path("r.h5"))("/sweep/peak_deflection").size(), 6u) << "readable";
  }
}

TEST(SweepEnds, ByASignalWithWhatItHas) {
  const Workplace workplace(std::string(two_spans) +
                            "load: {forces: 1.0e5}\nsweep: {speed: [20, 60, 0.01]}\nts_dt: 1.0e-4\n");
  Child child(workplace.command({"-output_file", "r.h5"}), workplace.folder());
  const auto a_run_has_ended = [&] {
    const std::string shown = child.written("out");
    for (std::size_t at = 0; (at = shown.find(" of 4001 runs   ", at)) != std::string::npos; ++at) {
      const std::size_t begin = shown.find_last_of(" \n", at - 1) + 1;
      if (std::atoi(shown.substr(begin, at - begin).c_str()) > 0) return true;
    }
    return false;
  };
  ASSERT_TRUE(child.wait_until(a_run_has_ended, 300.0));
  child.kill(SIGTERM);
  const Outcome outcome = child.wait();
  EXPECT_EQ(outcome.status, 128 + SIGTERM) << outcome.err;
  EXPECT_NE(outcome.out.find("ended by signal 15"), std::string::npos) << outcome.out;
  const std::size_t runs = known(Results(workplace.path("r.h5"))("/sweep/peak_deflection")) / 2;
  EXPECT_GT(runs, 0u);
  EXPECT_LT(runs, 4001u);
}

// Before it begins: what it will take, and what would be quicker.
TEST(SweepCost, IsSaidBeforehand) {
  const Workplace workplace(std::string(two_spans) +
                            "load: {forces: 1.0e5}\nsweep: {speed: [20, 60, 0.01]}\nts_dt: 1.0e-4\n");
  Child child(workplace.command({"-output_file", "r.h5"}), workplace.folder());
  ASSERT_TRUE(
      child.wait_for("the sweep is computed by 4 elements a span and steps of 0.0001 s; estimated time ", 300.0));
  ASSERT_TRUE(child.wait_for("quicker: -model_modes ", 300.0));
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait(300.0).status, 128 + SIGTERM);
  const Outcome modes = workplace.run({"-output_file", "m.h5", "-model_modes", "4"}, 1, 300.0);
  expect_success(modes);
  EXPECT_EQ(modes.out.find("quicker:"), std::string::npos) << modes.out;
  EXPECT_NE(modes.out.find("4001 of 4001 runs by 4 modes"), std::string::npos) << modes.out;
}

TEST(SweepInput, IsCheckedForItsFastestRunToo) {
  const Workplace workplace(std::string(two_spans) +
                            "load: {forces: 1.0e5}\nsweep: {speed: [20, 80, 20]}\nts_dt: 0.05\n");
  expect_refusal(workplace, workplace.run(), {"ts_dt = 0.05", "at most 0.025 s"});
}

}  // namespace
}  // namespace traverse::test
