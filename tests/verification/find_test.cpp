// Searches for the values of an option that keep a limit: their ends against runs of the scene alone, on both sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string bridge = R"(
beam: {spans: 20.0, EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02}
model: {modes: 3}
output: {probes: 10.0}
)";

/// The deflection of the scene alone at one value of an option, m.
double deflection(const std::string& scene, const Values& options) {
  return std::abs(run_yaml(scene, options).attribute("/summary", "deflection"));
}

TEST(Find, TheStiffnessAtWhichADeflectionHasAValue) {
  const std::string scene = bridge + "load: {forces: 1.0e5*3, positions: [0, -3, -20], speed: 40.0}\n";
  Results found = run_yaml(scene, {{"find_option", "beam_EI"},
                                   {"find_between", "2e9,5e10"},
                                   {"find_quantity", "peak_deflection"},
                                   {"find_equals", "2e-3"},
                                   {"find_accuracy", "1e-5"}});
  const std::vector<double> interval = found("/find/interval");
  ASSERT_EQ(interval.size(), 2U);
  EXPECT_EQ(interval[1], 5e10);
  EXPECT_EQ(found("/find/interval_at_end"), (std::vector<double>{0, 1}));
  // Peaks of a study are looked for at more instants than those of a run alone.
  EXPECT_NEAR(deflection(scene, {{"beam_EI", text(interval[0])}}), 2e-3, 2e-6);
  const std::vector<double>& value = found("/find/value");
  const std::vector<double>& ratio = found("/find/ratio");
  ASSERT_EQ(value.size(), ratio.size());
  EXPECT_TRUE(std::is_sorted(value.begin(), value.end()));
  const auto at = static_cast<std::size_t>(std::find(value.begin(), value.end(), interval[0]) - value.begin());
  ASSERT_GT(at, 0U);
  EXPECT_GT(ratio[at - 1], 1.0);
  EXPECT_LE(ratio[at], 1.0);
  EXPECT_LE(value[at] - value[at - 1], 1e-5 * value[at]);
}

// Values are added between others in each round, which changes the numbers of the scenes.
TEST(Find, RunsAreThoseOfAStudyOverTheSameValues) {
  const std::string scene = bridge + "load: {forces: 1.0e5*3, positions: [0, -3, -20]}\n";
  const Values speeds = {{"study_vary_load_speed", "25,40"}};
  Results found = run_yaml(scene, speeds + Values{{"find_option", "beam_EI"},
                                                  {"find_between", "2e9,5e10"},
                                                  {"find_quantity", "peak_acceleration"},
                                                  {"find_equals", "0.5"},
                                                  {"find_points", "3"}});
  std::string values;
  for (const double value : found("/find/value")) values += (values.empty() ? "" : ",") + text(value);
  ASSERT_GT(found("/find/value").size(), 12U);  // more than scenes are kept
  Results study = run_yaml(scene, Values{{"study_vary_beam_EI", values}} + speeds);
  EXPECT_EQ(found("/study/beam_EI"), study("/study/beam_EI"));
  EXPECT_EQ(found("/study/peak_acceleration"), study("/study/peak_acceleration"));
}

// Ten axles at 12 m: a resonance at v = f1 d = 47.1 m/s, f1 = 3.927 Hz, lies within the speeds.
TEST(Find, PermittedSpeedsOnBothSidesOfAResonance) {
  const std::string scene =
      bridge + "load: {forces: 1.0e5*10, positions: [0, -12, -24, -36, -48, -60, -72, -84, -96, -108]}\n";
  const Values search = {{"find_option", "load_speed"},
                         {"find_between", "129.6 km/h,60"},
                         {"find_quantity", "peak_deflection"},
                         {"find_equals", "3.5e-3"}};
  Results found = run_yaml(scene, search + Values{{"load_speed", "36"}});
  const std::vector<double> interval = found("/find/interval");
  ASSERT_EQ(interval.size(), 4U);
  EXPECT_EQ(interval[0], 36.0);
  EXPECT_LT(interval[1], 12.0 * 3.927);
  EXPECT_GT(interval[2], 12.0 * 3.927);
  EXPECT_EQ(interval[3], 60.0);
  for (const std::size_t end : {1, 2}) {
    const double outward = end == 1 ? 2e-3 : -2e-3;
    EXPECT_LE(deflection(scene, {{"load_speed", text(interval[end])}}), 3.5e-3 * (1.0 + 1e-3));
    EXPECT_GT(deflection(scene, {{"load_speed", text(interval[end] * (1.0 + outward))}}), 3.5e-3);
  }
}

TEST(Find, TrainsHaveAnswersOfTheirOwnAndOneForAll) {
  const std::string scene = bridge + "sweep: {hslm_a: [1, 5]}\nscene: {tail: 0.5}\nlimits: " + source_folder() +
                            "/tests/data/limits_of_forces.yml\n";
  Results found = run_yaml(scene, {{"find_option", "load_speed"},
                                   {"find_between", "30,60"},
                                   {"find_keep", "deck_acceleration"},
                                   {"find_points", "40"},
                                   {"find_accuracy", "1e-2"}});
  const std::size_t values = found("/find/value").size();
  const std::vector<double> ratio = found("/find/ratio");
  ASSERT_EQ(ratio.size(), 3 * values);
  for (std::size_t i = 0; i < values; ++i) EXPECT_EQ(ratio[2 * values + i], std::max(ratio[i], ratio[values + i]));
}

TEST(Find, TheAnswerDoesNotDependOnTheFirstValues) {
  const std::string scene = bridge + "load: {forces: 1.0e5*3, positions: [0, -3, -20], speed: 40.0}\n";
  const auto end = [&](const char* points) {
    Results found = run_yaml(scene, {{"find_option", "beam_mass"},
                                     {"find_between", "5e3,4e4"},
                                     {"find_quantity", "peak_acceleration"},
                                     {"find_equals", "1.0"},
                                     {"find_accuracy", "1e-5"},
                                     {"find_points", points}});
    return found("/find/interval");
  };
  const std::vector<double> few = end("9"), many = end("30");
  ASSERT_EQ(few.size(), many.size());
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_NEAR(few[i], many[i], 2e-5 * many[i]);
}

}  // namespace
}  // namespace traverse::test
