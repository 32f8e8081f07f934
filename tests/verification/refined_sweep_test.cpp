// Speeds that a sweep adds by itself, and the speeds of resonance and cancellation that it predicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const char* const bridge = R"(
beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4}
support: {types: [pinned, roller]}
model: {modes: 3, damping_ratios: 0.01}
scene: {tail: 1.0}
output: {probes: [6.25, 12.5]}
)";

double largest(Results& run, const std::string& name) {
  const std::vector<double>& values = run("/sweep/" + name);
  return *std::max_element(values.begin(), values.end());
}

// Every 36 km/h, against every 0.01 km/h about the resonance of train A1 at 230 km/h.
TEST(RefinedSweep, FindsTheResonanceThatTheGridMisses) {
  Results coarse = run_yaml(bridge, {{"load_hslm_a", "1"}, {"sweep_speed", "32,92,10"}});
  Results dense = run_yaml(bridge, {{"load_hslm_a", "1"}, {"sweep_speed", "58,70,0.0025"}});
  const std::vector<std::string> names = {"peak_deflection", "peak_acceleration", "peak_moment"};
  EXPECT_LT(largest(coarse, "peak_deflection"), 0.7 * largest(dense, "peak_deflection")) << "the grid misses it";
  const auto missed = [&](const char* wanted) {
    Results fine = run_yaml(bridge, {{"load_hslm_a", "1"}, {"sweep_speed", "32,92,10"}, {"sweep_refine", wanted}});
    EXPECT_LE(fine.attribute("/summary", "peak_uncertainty"), std::stod(wanted));
    const std::vector<double>& speed = fine("/sweep/speed");
    const std::vector<double>& added = fine("/sweep/added");
    EXPECT_TRUE(std::is_sorted(speed.begin(), speed.end()));
    EXPECT_EQ(std::count(added.begin(), added.end(), 0.0), 7);
    EXPECT_EQ(static_cast<double>(std::count(added.begin(), added.end(), 1.0)),
              fine.attribute("/summary", "speeds_added"));
    EXPECT_LT(speed.size(), 80u);
    // What was added changes nothing in the runs that were asked for.
    for (std::size_t i = 0, given = 0; i < speed.size(); ++i)
      if (added[i] == 0.0) {
        EXPECT_EQ(fine("/sweep/peak_moment")[2 * i], coarse("/sweep/peak_moment")[2 * given]);
        ++given;
      }
    double worst = 0.0;
    for (const std::string& name : names) worst = std::max(worst, largest(dense, name) / largest(fine, name) - 1.0);
    return worst;
  };
  const double of_a_hundredth = missed("1e-2"), of_a_thousandth = missed("1e-3");
  EXPECT_LT(of_a_hundredth, 1e-2);
  EXPECT_LT(of_a_thousandth, 1e-3);
  RecordProperty("of a hundredth", text(of_a_hundredth));
  RecordProperty("of a thousandth", text(of_a_thousandth));
}

// What limits judge has its peak known too, of every train, and every train has run at every speed.
TEST(RefinedSweep, KnowsThePeaksOfJudgedQuantities) {
  const Values options = {{"limits", source_folder() + "/tests/data/limits_of_forces.yml"}, {"sweep_hslm_a", "1,9"}};
  Results fine = run_yaml(bridge, options + Values{{"sweep_speed", "60,72,3"}, {"sweep_refine", "2e-3"}});
  Results dense = run_yaml(bridge, options + Values{{"sweep_speed", "60,72,0.02"}, {"sweep_refine", "0"}});
  const auto greatest = [](Results& run, std::size_t train, std::size_t limit) {
    const std::size_t speeds = run("/sweep/speed").size(), limits = run("/verdicts/limit").size();
    double found = 0.0;
    for (std::size_t i = 0; i < speeds; ++i)
      found = std::fmax(found, run("/sweep/judged")[(train * speeds + i) * limits + limit]);
    return found;
  };
  for (std::size_t train = 0; train < 2; ++train)
    for (std::size_t limit = 0; limit < fine("/verdicts/limit").size(); ++limit) {
      const double wanted = greatest(dense, train, limit);
      EXPECT_LE(wanted, (1.0 + 2e-3) * greatest(fine, train, limit)) << train << " " << limit;
    }
  for (const double value : fine("/sweep/peak_deflection")) EXPECT_TRUE(std::isfinite(value));
}

// Limits are judged between the speeds too: one that the speeds given keep is broken at the resonance beside them.
TEST(RefinedSweep, NoVerdictTurnsWithTheStep) {
  const TemporaryFolder folder;
  const Values train = {{"load_hslm_a", "1"}, {"beam_elements_per_span", "8"}};
  const std::string scene = std::string(bridge) + "limits: " +
                            folder.write("limits.yml", "- {clause: A, quantity: amplification, value: 2.3}\n") + "\n";
  const auto found = [&](const Values& more) { return run_yaml(scene, train + more)("/verdicts/value")[0]; };
  const double dense = found({{"sweep_speed", "62,66,0.05"}, {"sweep_refine", "0"}});
  const Values coarse = {{"sweep_speed", "32,92,10"}};
  EXPECT_GT(dense, 2.3);
  EXPECT_LT(found(coarse + Values{{"sweep_refine", "0"}}), 2.3);
  EXPECT_GT(found(coarse), 2.3);
}

// Two masses of the bridge, each with a resonance of its own.
TEST(RefinedStudy, FindsThePeakOfEveryCombination) {
  const Values options = {{"load_hslm_a", "1"}, {"study_vary_beam_mass", "1.5e4,2.0e4"}};
  Results fine = run_yaml(bridge, options + Values{{"study_vary_load_speed", "44,54,64,74"}, {"study_refine", "2e-3"}});
  Results dense = run_yaml(bridge, options + Values{{"sweep_speed", "50,68,0.02"}});
  double worst = 0.0;
  for (const char* mass : {"1.5e4", "2.0e4"}) {
    const auto greatest = [&](Results& study) {
      double found = 0.0;
      for (std::size_t run = 0; run < study("/study/beam_mass").size(); ++run)
        if (study("/study/beam_mass")[run] == std::stod(mass))
          found = std::max(found, study("/study/peak_acceleration")[2 * run + 1]);
      return found;
    };
    worst = std::max(worst, greatest(dense) / greatest(fine) - 1.0);
  }
  EXPECT_LT(worst, 2e-3);
  RecordProperty("of a study", text(worst));
  const std::vector<double>& shape = fine("/study/shape");
  EXPECT_EQ(shape[0], 2.0);
  EXPECT_GT(shape[1], 4.0);
  EXPECT_EQ(fine("/study/finished"), std::vector<double>(fine("/study/finished").size(), 1.0));
  EXPECT_EQ(fine.attribute("/summary", "speeds_added"), shape[1] - 4.0);
  EXPECT_LE(fine.attribute("/summary", "peak_uncertainty"), 2e-3);
}

// f1 = pi/2 sqrt(EI/m)/L^2; EN 1991-2's train A1 has coaches of 18 m.
TEST(Resonances, ArePredictedAndFound) {
  Results run = run_yaml(bridge, {{"sweep_hslm_a", "1,6"}, {"sweep_speed", "40,95,5"}, {"sweep_refine", "1e-3"}});
  const double f1 = 0.5 * std::numbers::pi * std::sqrt(3e10 / 1.5e4) / (25.0 * 25.0);
  const std::vector<double>& speed = run("/resonances/speed");
  double worst = 0.0;
  int first_ones = 0;
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (run("/resonances/mode")[i] != 1.0) continue;
    const double d = run("/resonances/hslm_a")[i] == 1.0 ? 18.0 : 23.0;
    EXPECT_EQ(run("/resonances/distance")[i], d);
    EXPECT_NEAR(speed[i], f1 * d / run("/resonances/order")[i], 1e-4 * speed[i]);
    if (run("/resonances/order")[i] != 1.0) continue;
    worst = std::max(worst, std::abs(run("/resonances/deflection_speed")[i] / speed[i] - 1.0));
    ++first_ones;
  }
  EXPECT_EQ(first_ones, 2) << "each with its peak";
  EXPECT_LT(worst, 0.02);
  RecordProperty("found over predicted", text(worst));
}

/// Of the free motion after one force has crossed without damping, the largest deflection at a probe over that while it
/// crosses; of the second mode by the difference of two probes, which the first one moves alike.
double left_behind(double speed, bool second) {
  Results run = run_yaml(bridge, {{"model_damping_ratios", "0"},
                                  {"model_modes", second ? "2" : "1"},
                                  {"output_probes", "6.25,18.75"},
                                  {"output_interval", "2e-3"},
                                  {"load_forces", "1e5"},
                                  {"load_speed", text(speed)}});
  const std::vector<double> left = run.column("/probes/deflection", 0), right = run.column("/probes/deflection", 1);
  double during = 0.0, after = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double value = std::abs(left[i] - (second ? 1.0 : -1.0) * right[i]);
    (run.time()[i] * speed < 25.0 ? during : after) = std::max(run.time()[i] * speed < 25.0 ? during : after, value);
  }
  return after / during;
}

TEST(Cancellations, LeaveTheSpanAtRest) {
  Results run = run_yaml(bridge, {{"load_forces", "1e5"}, {"sweep_speed", "30,120,45"}});
  const std::vector<double>& speed = run("/cancellations/speed");
  double worst = 0.0, beside = 1.0;
  ASSERT_GT(speed.size(), 5u);
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (run("/cancellations/mode")[i] > 2.0) continue;
    const bool second = run("/cancellations/mode")[i] == 2.0;
    if (second && run("/cancellations/half_waves")[i] > 10.0) continue;
    worst = std::max(worst, left_behind(speed[i], second));
    beside = std::min(beside, left_behind(1.05 * speed[i], second));
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_GT(beside, 1e-2) << "5 % beside there is motion";
  RecordProperty("left behind", text(worst));
}

}  // namespace
}  // namespace traverse::test
