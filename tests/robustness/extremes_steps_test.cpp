// Steps, times and numbers far from any sensible ones.
#include <cstdlib>

#include "support/extremes.hpp"
#include "support/folders.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

// --- steps too long --------------------------------------------------------------------------------------------------

struct LongStep {
  const char* scene;
  double chosen;  // s, the step where it is left open
  std::vector<const char*> curves;
};
void PrintTo(const LongStep& c, std::ostream* out) { *out << c.scene; }

class AHundredTimesTheStep : public testing::TestWithParam<LongStep> {};
INSTANTIATE_TEST_SUITE_P(
    Step, AHundredTimesTheStep,
    testing::Values(LongStep{"r1_moving_force", 2e-4, {"/probes/deflection"}},
                    LongStep{"r2_sprung_mass", 5e-4, {"/probes/deflection", "/vehicles/0/spring/normal_force"}},
                    LongStep{"r4_hertz_wheel", 5e-4, {"/probes/deflection", "/vehicles/0/wheel/normal_force"}},
                    LongStep{"r6_three_spans", 5e-4, {"/probes/deflection"}},
                    LongStep{"three_span_half_car", 1e-3, {"/probes/deflection"}},
                    LongStep{"rail_on_pads", 5e-4, {"/probes/deflection", "/vehicles/0/wheel_1/normal_force"}},
                    LongStep{"coach_over_a_bump", 5e-4, {"/vehicles/0/wheel_1/normal_force"}},
                    LongStep{"freight_wagon", 5e-4, {"/vehicles/0/wheel_1/normal_force"}},
                    LongStep{"tapered_jib", 2e-3, {"/probes/deflection"}},
                    LongStep{"pendulum", 2e-3, {"/vehicles/0/bar/position"}}, LongStep{"slider_crank", 2e-4, {}},
                    LongStep{"r9_andrews", 1e-5, {}}, LongStep{"two_four_bars", 1e-2, {}},
                    LongStep{"forty_four_bars", 1e-2, {}}),
    [](const auto& which) { return std::string(which.param.scene); });

// Stored at the ends of steps, 1e-2 of the largest value: the order of what the peaks of R1 to R7 are known to.
TEST_P(AHundredTimesTheStep, IsRefusedOrRight) {
  const LongStep& c = GetParam();
  const std::string step = text(100.0 * c.chosen);
  const std::string message = refusal([&] {
    Results run = run_scene(c.scene, {{"ts_dt", step}, {"output_interval", step}});
    Results fine = run_scene(c.scene, {{"ts_dt", text(5.0 * c.chosen)}, {"output_interval", step}});
    ASSERT_FALSE(c.curves.empty()) << "ran to its end";
    for (const char* curve : c.curves) EXPECT_LT(difference(run, fine, curve), 1e-2) << curve;
  });
  RecordProperty("message", message);
  if (!message.empty()) {
    EXPECT_NE(message.find("ts_dt"), std::string::npos) << message;
  }
}

// R4 at 4 ms: the wheel on its contact, 1,000 rad/s, turns four times within a step, and what it does is left out. The
// forces between 0.98124 and 1.01654 of the weight keep to what the body does, and so does the bridge.
TEST(Step, LongForTheContact) {
  Results run = run_scene("r4_hertz_wheel", {{"ts_dt", "4e-3"}, {"output_interval", "4e-3"}});
  const double weight = 6750.0 * 9.81;
  EXPECT_NEAR(refined_peak(run.time(), run.column("/probes/deflection")).value, -2.8324443e-3, 1e-3 * 2.8324443e-3);
  EXPECT_NEAR(lowest(run("/vehicles/0/wheel/normal_force")), 0.98124 * weight, 5e-3 * weight);
  EXPECT_NEAR(highest(run("/vehicles/0/wheel/normal_force")), 1.01654 * weight, 5e-3 * weight);
}

// A sleeper is passed in 7.2 ms, within 1.4 steps. The bridge does not notice; of the wheel forces, 7 kN about 109 kN,
// a part is lost, which is said. Order 2 loses too much.
TEST(Step, LongForTheSleepers) {
  const Values fast = {{"train_speed", "83.33333333"}, {"output_interval", "5e-3"}};
  Results fine = run_scene("r8_ballasted_bridge", fast + Values{{"ts_dt", "5e-4"}});
  Results run = run_scene("r8_ballasted_bridge", fast + Values{{"ts_dt", "5e-3"}});
  EXPECT_LT(difference(run, fine, "/probes/deflection"), 1e-3);
  for (const char* wheel : {"wheel_1", "wheel_2", "wheel_3", "wheel_4"}) {
    const std::string force = std::string("/vehicles/0/") + wheel + "/normal_force";
    EXPECT_LT(difference(run, fine, force), 5e-2) << wheel;
  }
  const Workplace workplace("");
  std::vector<std::string> words = {"-options_file", source_folder() + "/options/scenes/r8_ballasted_bridge.yml"};
  words.insert(words.end(),
               {"-train_speed", "83.33333333", "-ts_dt", "5e-3", "-output_interval", "5e-3", "-output_file", "none"});
  const Outcome outcome = workplace.run(words);
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("long for the sleepers"), std::string::npos) << outcome.out;
  expect_refused(
      [&] {
        run_scene("r8_ballasted_bridge", fast + Values{{"ts_dt", "5e-3"}, {"ts_type", "genalpha"}});
      },
      {"energy does not balance", "smaller -ts_dt"});
}

// An explicit method beyond its limit, 1/50 of this step, multiplies what is wrong a thousandfold and more a step.
// Stored once a second, it is stopped within a few steps all the same.
TEST(Step, DivergenceIsStoppedWithinAFewSteps) {
  const std::string message = refusal([] {
    run_scene("r6_three_spans", {{"ts_type", "rk"}, {"ts_dt", "1e-3"}, {"output_interval", "1.0"}});
  });
  const std::size_t at = message.find("by t = ");
  ASSERT_NE(at, std::string::npos) << message;
  EXPECT_LT(std::atof(message.c_str() + at + 7), 0.025) << message;
  EXPECT_NE(message.find("smaller -ts_dt"), std::string::npos) << message;
}

// 0.114 s: the first period of these spans.
TEST(Step, LongForTheFirstPeriodIsNoted) {
  const Workplace workplace(small_scene());
  const auto noted = [&](const char* type, const char* step) {
    const Outcome outcome = workplace.run({"-ts_type", type, "-ts_dt", step, "-output_file", "none"});
    expect_success(outcome);
    return outcome.out.find("long for the first period") != std::string::npos;
  };
  EXPECT_TRUE(noted("genalpha", "0.01"));
  EXPECT_FALSE(noted("genalpha", "0.001"));
  EXPECT_TRUE(noted("esdirk4", "0.02"));
  EXPECT_FALSE(noted("esdirk4", "0.01"));
  expect_refusal(workplace, workplace.run({"-ts_dt", "0.03"}), {"ts_dt = 0.03", "first period", "at most"});
}

// Sixteen coaches on many spans with steps that end anywhere: what the drive does where wheels pass from span to span
// is known to a step only, and no reason to refuse the run.
TEST(Step, EndsAnywhereWithoutFalseAlarm) {
  EXPECT_EQ(refusal([] { run_scene("danyang_kunshan", {{"ts_max_time", "20"}}); }), "");
}

TEST(Step, LongForTheTracksWaves) {
  const auto over_a_bump = [](const char* step) {
    return run_scene(
        "coach_over_a_bump",
        {{"ts_dt", step}, {"output_interval", "2e-2"}, {"ts_max_time", "0.04"}, {"track_bump_length", "1"}});
  };
  EXPECT_EQ(refusal([&] { over_a_bump("1e-3"); }), "");
  expect_refused([&] { over_a_bump("2e-2"); }, {"ts_dt = 0.02", "shortest wave", "at most"});
}

// --- long runs -------------------------------------------------------------------------------------------------------

/// A beam of 25 m in two elements, without damping, that a force leaves to vibrate.
constexpr const char* ringing = R"(
beam: {spans: 25.0, elements_per_span: 2, EI: 8.323e9, mass: 2303.0}
support: {types: [pinned, roller]}
load: {forces: 1.0e5, speed: 100.0}
ts: {dt: 1.0e-3, max_time: 1000.0, type: genalpha, genalpha_radius: 1.0}
output: {interval: 0.25}
)";

// The trapezoidal rule keeps the energy of a linear beam exactly; a million steps round it by about a thousand eps
// where the signs are random, by a million at worst. The longest test here.
TEST(LongRun, AMillionStepsKeepTheEnergy) {
  Results run = run_yaml(ringing);
  EXPECT_DOUBLE_EQ(run.time().back(), 1000.0);
  const std::vector<double>&kinetic = run("/energy/kinetic"), &strain = run("/energy/strain");
  const double left = kinetic[1] + strain[1];  // at 0.25 s the force has gone
  EXPECT_GT(left, 1.0);
  for (std::size_t i = 1; i < kinetic.size(); ++i) ASSERT_NEAR(kinetic[i] + strain[i], left, 1e-8 * left) << i;
  // Nor does the vibration die away or grow.
  const std::vector<double> deflection = run.column("/probes/deflection");
  const auto amplitude = [&](std::size_t from) {
    double largest = 0.0;
    for (std::size_t i = from; i < from + 400; ++i) largest = std::max(largest, std::abs(deflection[i]));
    return largest;
  };
  EXPECT_NEAR(amplitude(deflection.size() - 401), amplitude(1), 0.02 * amplitude(1));
}

// 100,000 s before the bridge: t and x there are rounded to 1.5e-11, and times of samples and events, too. The same
// crossing, 100 km later.
TEST(LongRun, CrossingAfterAHundredThousandSeconds) {
  const std::string scene = std::string(two_spans) + quarter_car + "ts_dt: 1.0\noutput: {interval: 1.0}\n";
  const Values slow = {{"train_speed", "1.0"}};
  Results near = run_yaml(scene, slow + Values{{"train_positions", "-10"}, {"ts_max_time", "50"}});
  Results far =
      run_yaml(scene, slow + Values{{"train_positions", "-1e5"}, {"ts_max_time", "100040"}, {"ts_type", "esdirk4"}});
  const std::vector<double> t = far.time();
  ASSERT_EQ(t.size(), 100041U);
  for (std::size_t i = 0; i < t.size(); ++i) ASSERT_EQ(t[i], static_cast<double>(i));
  const std::vector<double> here = near.column("/probes/deflection"), there = far.column("/probes/deflection");
  const std::vector<double>&force = near("/vehicles/0/wheel/normal_force"),
        &later = far("/vehicles/0/wheel/normal_force");
  const double largest = std::abs(peak(here).first);
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_NEAR(there[i + 99990], here[i], 1e-9 * largest) << i;
    EXPECT_NEAR(later[i + 99990], force[i], 1e-9 * quarter_car_weight) << i;
  }
}

// --- numbers ---------------------------------------------------------------------------------------------------------

// What overflows in a product is no quantity, and denormals are 0: where that is not possible, both are refused by
// name, before anything is computed.
TEST(Numbers, TooSmallAndTooLarge) {
  const auto refused = [](const char* name, const char* value) {
    expect_refused([&] { run_yaml(small_scene(), {{name, value}}); }, {std::string(name) + " = " + value, "allowed: "});
  };
  for (const char* name :
       {"beam_EI", "beam_mass", "beam_spans", "ts_dt", "ts_max_time", "output_interval", "vehicle_car_body_mass",
        "vehicle_car_axle_inertia", "vehicle_car_wheel_stiffness", "vehicle_car_wheel_radius"})
    for (const char* value : {"4.9e-324", "1e-310", "1e300", "1.7e308"}) refused(name, value);
  for (const char* name : {"gravity", "scene_tail", "train_positions", "train_speed", "foundation_vertical_bed_k",
                           "vehicle_car_suspension_stiffness", "vehicle_car_suspension_damping",
                           "vehicle_car_body_angle", "contact_tolerance"})
    for (const char* value : {"1e300", "1.7e308"}) refused(name, value);
  for (const char* name : {"gravity", "scene_tail", "vehicle_car_suspension_damping", "vehicle_car_body_angle"}) {
    const auto peak = [&](const char* value) {
      return run_yaml(small_scene(), {{name, value}}).attribute("/summary", "greatest_wheel_force");
    };
    EXPECT_EQ(peak("1e-310"), peak("0")) << name;
  }
  expect_refused([] { run_yaml(small_scene(), {{"beam_rayleigh", "0,1e300"}}); }, {"beam_rayleigh = ", "allowed: "});
  expect_refused(
      [] {
        run_yaml(small_scene(), {{"load_forces", "1e300"}, {"load_speed", "1"}});
      },
      {"load_forces = 1e300", "allowed: "});
}

TEST(Numbers, TimesThatRoundingHides) {
  expect_refused([] { run_yaml(small_scene(), {{"ts_max_time", "1e-20"}}); }, {"ts_max_time = 1e-20", "at least"});
  expect_refused([] { run_yaml(small_scene(), {{"output_interval", "1e-20"}}); }, {"output_interval = 1e-20", "above"});
  expect_refused([] { run_yaml(small_scene(), {{"ts_dt", "1e-20"}}); }, {"ts_dt = 1e-20", "above"});
}

}  // namespace
}  // namespace traverse::test
