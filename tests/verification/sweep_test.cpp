// Sweeps: the trains of EN 1991-2 against another program's peaks, and every run of a sweep as it is alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const std::string stations =
    "1.25,2.5,3.75,5,6.25,7.5,8.75,10,11.25,12.5,13.75,15,16.25,17.5,18.75,20,21.25,22.5,23.75";

// Deflections by 2e-4 and at the same speed. Accelerations by 3e-3 where they are looked for along the whole beam, as
// there: the largest of A2 is 2.5 % above that of midspan.
TEST(Sweep, HslmTrainsAgainstAnotherProgram) {
  const auto list = read_table(source_folder() + "/tests/data/hslm_peaks.csv");
  Results run = run_scene("hslm_sweep", {{"output_probes", stations}});
  const std::vector<double>& speed = run("/sweep/speed");
  ASSERT_EQ(speed.size(), 131u);
  ASSERT_EQ(run("/sweep/peak_deflection").size(), 10u * 131u * 19u);
  double errors[2] = {0.0, 0.0};
  for (std::size_t train = 0; train < 10; ++train) {
    const auto largest = [&](const std::string& name) {
      const auto begin = run(name).begin() + static_cast<std::ptrdiff_t>(train * 131 * 19);
      const auto at = std::max_element(begin, begin + 131 * 19);
      return std::pair(*at, 3.6 * speed[static_cast<std::size_t>(at - begin) / 19]);
    };
    const auto [deflection, at] = largest("/sweep/peak_deflection");
    EXPECT_NEAR(at, list[train][2], 0.1) << "A" << train + 1;
    errors[0] = std::max(errors[0], std::abs(1e3 * deflection / list[train][1] - 1.0));
    errors[1] = std::max(errors[1], std::abs(largest("/sweep/peak_acceleration").first / list[train][3] - 1.0));
  }
  RecordProperty("deflections", text(errors[0]));
  RecordProperty("accelerations", text(errors[1]));
  EXPECT_LT(errors[0], 3e-4);
  EXPECT_LT(errors[1], 3e-3);
}

const char* const scene = R"(
beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}
support: {types: [pinned, roller, roller]}
scene: {tail: 0.5}
output: {probes: [10.0, 31.0]}
)";

/// Peaks of a sweep's run and of the same scene alone. A run's own lie between its samples, so near them as `bound`.
void expect_run(Results& sweep, std::size_t run, Results& alone, double bound, double summary_bound) {
  for (const char* name : {"deflection", "acceleration", "moment"}) {
    for (std::size_t p = 0; p < 2; ++p) {
      const double swept = sweep(std::string("/sweep/peak_") + name)[2 * run + p];
      const double single = std::abs(peak(alone.column(std::string("/probes/") + name, p)).first);
      EXPECT_NEAR(swept, single, bound * single) << name << " at probe " << p << " of run " << run;
    }
    const auto& peaks = sweep(std::string("/sweep/peak_") + name);
    const double alone_peak = std::abs(alone.attribute("/summary", name));
    EXPECT_NEAR(std::max(peaks[2 * run], peaks[2 * run + 1]), alone_peak, summary_bound * alone_peak) << name;
  }
}

TEST(Sweep, RunsAreThoseOfTheScenesAlone) {
  const Values options = {{"ts_dt", "2e-3"}, {"output_interval", "4e-3"}};
  Results sweep = run_yaml(scene, options + Values{{"sweep_speed", "30,50,10"}, {"sweep_hslm_a", "2,7"}});
  EXPECT_EQ(sweep("/sweep/hslm_a"), (std::vector<double>{2.0, 7.0}));
  EXPECT_EQ(sweep("/sweep/speed"), (std::vector<double>{30.0, 40.0, 50.0}));
  std::size_t run = 0;
  for (const char* train : {"2", "7"})
    for (const char* speed : {"30", "40", "50"}) {
      Results alone = run_yaml(scene, options + Values{{"load_hslm_a", train}, {"load_speed", speed}});
      expect_run(sweep, run, alone, 1e-2, 1e-12);
      const double deflection = std::abs(alone.attribute("/summary", "deflection"));
      const double amplification =
          std::max(sweep("/sweep/amplification")[2 * run], sweep("/sweep/amplification")[2 * run + 1]);
      EXPECT_GE(amplification * (1.0 + 1e-9), alone.attribute("/summary", "amplification"));
      EXPECT_GT(deflection, 0.0);
      ++run;
    }
}

// By modes the peaks are looked for between samples too; statics comes from the same influence lines.
TEST(Sweep, ByModes) {
  const Values options = {{"model_modes", "6"}, {"beam_self_weight", "true"}};
  Results sweep = run_yaml(scene, options + Values{{"sweep_speed", "40,60,20"}, {"load_hslm_a", "5"}});
  std::size_t run = 0;
  for (const char* speed : {"40", "60"}) {
    Results alone =
        run_yaml(scene, options + Values{{"load_hslm_a", "5"}, {"load_speed", speed}, {"output_interval", "2e-4"}});
    expect_run(sweep, run, alone, 1e-3, 1e-3);
    const bool first = std::abs(alone.attribute("/summary", "deflection_place") - 10.0) < 1e-9;
    const double amplification = sweep("/sweep/amplification")[2 * run + (first ? 0 : 1)];
    EXPECT_NEAR(amplification, alone.attribute("/summary", "amplification"), 1e-3 * amplification);
    if (std::stod(speed) == sweep.attribute("/summary", "deflection_speed")) {
      EXPECT_NEAR(sweep.attribute("/summary", "amplification"), amplification, 1e-12);
      EXPECT_NEAR(sweep.attribute("/summary", "static_deflection"), alone.attribute("/summary", "static_deflection"),
                  1e-3 * sweep.attribute("/summary", "static_deflection"));
    }
    ++run;
  }
  EXPECT_EQ(sweep.attribute("/sweep", "modes"), 6.0);
  EXPECT_EQ(sweep.attribute("/sweep", "elements_per_span"), 6.0);
}

// With a limit of it the low-passed acceleration is promised of every run, instead of the acceleration if that is asked
// for: by elements and modes under forces, by modes with a train.
TEST(SweepLowPassed, IsPromisedOfEveryRun) {
  const TemporaryFolder folder;
  const Values limited = {
      {"limits", folder.write("limits.yml", "- {clause: A, quantity: deck_acceleration, value: 3.5}\n")},
      {"accuracy_of", "deflection,acceleration_lowpass"},
      {"sweep_refine", "0"},
      {"scene_tail", "0.3"}};
  const std::string bridge =
      "beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}\n"
      "support: {types: [pinned, roller]}\n";
  const std::string forces = bridge +
                             "load: {forces: 1.7e5*6, positions: [0,-3,-18,-21,-36,-39]}\n"
                             "sweep: {speed: [40.0, 100.0, 3.0]}\n";
  const std::string train = bridge + "vehicle: {coach: {file: " + source_folder() +
                            "/options/vehicles/velaro.yml}}\n"
                            "train: {vehicles: coach*2}\nsweep: {speed: [60.0, 84.0, 6.0]}\n";
  for (const std::string& yaml : {forces, train}) {
    Results fine = run_yaml(
        yaml,
        limited +
            Values{{"ts_dt", "5e-4"}, {"beam_elements_per_span", "60"}, {"model_modes", "0"}, {"step_probes", "true"}});
    for (const char* modes : {"0", "auto"}) {
      Results run = run_yaml(yaml, limited + Values{{"accuracy", "1e-2"}, {"model_modes", modes}});
      EXPECT_LT(run.attribute("/summary", "expected_error_acceleration_lowpass"), 1.25e-2) << modes;
      EXPECT_TRUE(std::isnan(run.attribute("/summary", "expected_error_acceleration"))) << modes;
      EXPECT_TRUE(std::string(modes) == "auto" || run.attribute("/sweep", "modes") == 0.0);
      const auto &found = run("/sweep/judged"), &exact = fine("/sweep/judged");
      ASSERT_EQ(found.size(), exact.size());
      double worst = 0.0;
      for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
      RecordProperty((yaml == forces ? "forces_by_" : "train_by_") + std::string(modes), text(worst));
      EXPECT_LT(worst, 1e-2) << modes;
    }
  }
}

// What is chosen at some speeds serves all, by elements and, where these do as well, by modes: every peak of every run
// is within the accuracy of what fine elements give.
class SweepAccuracy : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Sweep, SweepAccuracy, testing::Values("1e-2", "1e-3"));

// At 299 km/h the passing forces cancel the free vibration of the first mode, so that higher modes are a large part of
// the small accelerations.
TEST(Sweep, EstimatesErrorsByModesNearACancellationSpeed) {
  const std::string bridge =
      "beam: {spans: 28.0, EI: 2.6e11, mass: 1.9e4, damping_ratios: 0.0101}\n"
      "support: {types: [pinned, roller]}\n"
      "sweep: {speed: [260 km/h, 300 km/h, 2 km/h], hslm_a: [1]}\n"
      "scene: {tail: 2.0}\n";
  Results fine = run_yaml(bridge, {{"model_modes", "24"}, {"beam_elements_per_span", "128"}});
  Results run = run_yaml(bridge, {{"accuracy", "1e-2"}});
  for (const char* name : {"deflection", "acceleration", "moment"}) {
    const auto &found = run(std::string("/sweep/peak_") + name), &exact = fine(std::string("/sweep/peak_") + name);
    ASSERT_EQ(found.size(), 21u);
    double worst = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
    EXPECT_LT(worst, run.attribute("/summary", std::string("expected_error_") + name)) << name;
  }
}

TEST_P(SweepAccuracy, HoldsInEveryRun) {
  const std::string one_span =
      "beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}\n"
      "support: {types: [pinned, roller]}\n"
      "load: {forces: 1.7e5*16, positions: [0,-3,-18,-21,-36,-39,-54,-57,-72,-75,-90,-93,-108,-111,-126,-129]}\n"
      "sweep: {speed: [28.0, 100.0, 3.6]}\n";
  Results fine = run_yaml(one_span, {{"ts_dt", "5e-4"}, {"beam_elements_per_span", "80"}, {"step_probes", "true"}});
  for (const char* modes : {"0", "auto"}) {
    testing::internal::CaptureStdout();
    Results run = run_yaml(one_span, {{"accuracy", GetParam()}, {"model_modes", modes}});
    const std::string said = testing::internal::GetCapturedStdout();
    const bool by_modes = said.find("modes instead of the elements") != std::string::npos;
    if (std::string(GetParam()) == "1e-2") {  // at 1e-3 accelerations at low speed are not promised
      EXPECT_EQ(by_modes, std::string(modes) == "auto") << said;
      EXPECT_EQ(run.attribute("/sweep", "modes") > 0.0, by_modes);
      EXPECT_EQ(std::isnan(run.attribute("/sweep", "time_step")), by_modes) << "modes are exact in time";
      for (const char* name : {"deflection", "acceleration", "moment"}) {
        const double expected = run.attribute("/summary", std::string("expected_error_") + name);
        EXPECT_GT(expected, 0.0) << name;
        EXPECT_LT(expected, 1e-2 * 1.25) << name;
      }
    }
    for (const char* name : {"deflection", "acceleration", "moment"}) {
      const auto &found = run(std::string("/sweep/peak_") + name), &exact = fine(std::string("/sweep/peak_") + name);
      ASSERT_EQ(found.size(), 21u);
      double worst = 0.0;
      for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
      RecordProperty(std::string(name) + "_by_" + modes, text(worst));
      EXPECT_LT(worst, std::stod(GetParam())) << name << " by " << modes;
    }
  }
}

// A damper at midspan couples the modes, which does not keep a sweep from taking them.
TEST(Sweep, FindsCoupledModesThatDo) {
  const std::string damped =
      "beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}\n"
      "support: {types: [pinned, roller]}\n"
      "foundation: {vertical: {x: 12.5, c: 2.0e5}}\n"
      "load: {forces: 1.7e5*8, positions: [0,-3,-18,-21,-36,-39,-54,-57]}\n"
      "sweep: {speed: [28.0, 100.0, 3.6]}\n";
  Results fine = run_yaml(damped, {{"ts_dt", "5e-4"}, {"beam_elements_per_span", "80"}, {"step_probes", "true"}});
  Results run = run_yaml(damped, {{"accuracy", "1e-2"}});
  EXPECT_GT(run.attribute("/sweep", "modes"), 0.0);
  for (const char* name : {"/sweep/peak_deflection", "/sweep/peak_acceleration", "/sweep/peak_moment"}) {
    const std::vector<double>&found = run(name), &exact = fine(name);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-2 * exact[i]) << name << i;
  }
}

TEST(Sweep, VehiclesHaveTheirLeastWheelForce) {
  const std::string coaches =
      std::string("options_file: " + source_folder() + "/options/scenes/three_span_train.yml\n") +
      "train_vehicles: coach\nscene_tail: 0\n";
  const Values options = {{"ts_dt", "5e-3"}, {"ts_type", "bdf"}, {"beam_elements_per_span", "8"}};
  Results sweep = run_yaml(coaches, options + Values{{"sweep_speed", "60,80,20"}});
  const auto& least = sweep("/sweep/least_wheel_force");
  ASSERT_EQ(least.size(), 2u);
  Results alone = run_yaml(coaches, options + Values{{"train_speed", "80"}});
  EXPECT_NEAR(least[1], alone.attribute("/summary", "least_wheel_force"), 1e-9 * least[1]);
  const double greatest = sweep("/sweep/greatest_wheel_force")[1];
  EXPECT_NEAR(greatest, alone.attribute("/summary", "greatest_wheel_force"), 1e-9 * greatest);
  EXPECT_EQ(sweep.attribute("/summary", "least_wheel_force"), *std::min_element(least.begin(), least.end()));
  EXPECT_EQ(sweep.attribute("/summary", "runs"), 2.0);
  EXPECT_TRUE(std::isnan(sweep.attribute("/summary", "steps"))) << "runs are no steps";
  EXPECT_TRUE(std::isnan(sweep.attribute("/", "steps")));
}

/// A tuned mass damper that stands at midspan, and forces that cross.
const std::string damper =
    "beam: {spans: 26, EI: 5.0e10, mass: 1.5e4, damping_ratios: 0.01, elements_per_span: 8}\n"
    "vehicle:\n  tmd:\n    bodies: [foot, mass]\n    joints: [guide]\n    springs: [spring]\n    wheels: [w]\n"
    "    foot: {mass: 10, inertia: 1, position: [0, 0.3]}\n    mass: {mass: 5850, inertia: 500, position: [0, 0.8]}\n"
    "    guide: {type: prismatic, bodies: [foot, mass], point: [0, 0.3], axis: [0, 1]}\n"
    "    spring: {bodies: [foot, mass], from: [0, 0.3], to: [0, 0.8], stiffness: 3.8e6, damping: 3.0e4}\n"
    "    w: {body: foot, radius: 0.3, law: two_sided, stiffness: 1.0e9, damping: 1.0e3}\n"
    "train: {vehicles: tmd, positions: 13, speed: 0}\nscene: {tail: 0.3}\noutput: {probes: 13}\nts: {dt: 1.0e-3}\n"
    "load: {forces: [2.0e5, 2.0e5, 2.0e5, 2.0e5], positions: [0, -20, -40, -60]}\n";

// What stands, stands: a sweep and a study vary the speed of what moves, as a single run does.
TEST(Sweep, LeavesAVehicleThatStands) {
  Results sweep = run_yaml(damper, {{"sweep_speed", "60,70,10"}}),
          study = run_yaml(damper, {{"study_vary_load_speed", "60,70"}}),
          both = run_yaml(damper, {{"study_vary_vehicle_tmd_mass_mass", "2000,5850"}, {"sweep_speed", "60,70,10"}}),
          other = run_yaml(damper, {{"load_speed", "70"}, {"study_vary_vehicle_tmd_mass_mass", "2000,5850"}});
  for (const std::size_t i : {0U, 1U}) {
    const std::string speed = i == 0 ? "60" : "70";
    const double alone = std::abs(run_yaml(damper, {{"load_speed", speed}}).attribute("/summary", "deflection"));
    EXPECT_NEAR(sweep("/sweep/peak_deflection")[i], alone, 1e-9 * alone);
    EXPECT_NEAR(study("/study/peak_deflection")[i], alone, 1e-9 * alone);
    EXPECT_NEAR(both("/study/peak_deflection")[2 * i + 1], alone, 1e-9 * alone);
  }
  EXPECT_TRUE(contains(message_of([] {
                         run_yaml(damper, {{"sweep_speed", "60,70,10"}, {"load_speed", "0"}});
                       }),
                       ": nothing moves"));
  EXPECT_NEAR(other("/study/peak_deflection")[1], sweep("/sweep/peak_deflection")[1], 1e-9);
}

// A machine that stands beside no moving load is a scene for a study, too.
TEST(Sweep, AStudyOfWhatStands) {
  const std::string machine =
      "beam: {spans: 10, EI: 1.0e9, mass: 2000, damping_ratios: 0.02, elements_per_span: 4}\n"
      "vehicle:\n  m:\n    bodies: [b]\n    drivers: [level]\n    wheels: [w]\n    actuators: [force]\n"
      "    b: {mass: 500, inertia: 10, position: [0, 0.5]}\n    level: {body: b, coordinate: phi}\n"
      "    w: {body: b, radius: 0.5, law: two_sided, stiffness: 1.0e7}\n    force: {body: b, force: [0, 1.0e3]}\n"
      "train: {vehicles: m, positions: 5, speed: 0}\nts: {max_time: 0.2, dt: 1.0e-3}\nscene: {start: given}\n";
  Results study = run_yaml(machine, {{"study_vary_vehicle_m_b_mass", "500,800"}});
  const double alone = std::abs(run_yaml(machine, {{"vehicle_m_b_mass", "800"}}).attribute("/summary", "deflection"));
  EXPECT_NEAR(study("/study/peak_deflection")[1], alone, 1e-9 * alone);
}

}  // namespace
}  // namespace traverse::test
