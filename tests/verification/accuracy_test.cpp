// The promise of `accuracy`: the errors of peaks stay below what the user wants, against runs that are refined far
// beyond, or the quantity is named as not promised.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/promised.hpp"
#include "support/quarter_car.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr std::array quantities = {"deflection", "acceleration", "moment", "wheel_force"};

std::string quarter_car(const std::string& wheel) { return quarter_car_with(18e3, 1200.0, 1.8e6, 2e4, wheel); }

struct Case {
  const char* name;
  std::string scene;
  bool acceleration = true;  // is promised
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::string one_span =
    "beam: {spans: 30.0, EI: 1.2e10, mass: 9000.0, damping_ratios: 0.03}\n"
    "support: {types: [pinned, roller]}\n";
const std::string car_on_tyre =
    quarter_car("law: linear, stiffness: 4.0e6") + "train: {vehicles: car, positions: 0.0, speed: 25.0}\n";
const std::string car_on_steel =
    quarter_car("law: hertz, stiffness: 3.6e10") + "train: {vehicles: car, positions: -1.0, speed: 60.0}\n";
// A mass on a stiff linear wheel: modes come and go in its force, so that few of them agree by chance.
const std::string mass_on_stiff_wheel =
    "beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0, damping_ratios: 0.01}\n"
    "support: {types: [pinned, roller]}\n"
    "vehicle:\n  mass:\n    bodies: [body]\n    wheels: [contact]\n    drivers: [level]\n"
    "    body: {mass: 14394.0, inertia: 1.0, position: [0.0, 0.1]}\n"
    "    contact: {body: body, radius: 0.1, law: linear, stiffness: 1.0e9}\n"
    "    level: {body: body, coordinate: phi}\n"
    "train: {vehicles: mass, positions: 0.0, speed: 59.7}\n";
const std::string forces = "load: {forces: 2.0e5*4, positions: [0.0, -3.0, -11.0, -14.0], speed: 60.0}\n";

class ErrorEstimate : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Accuracy, ErrorEstimate,
    testing::Values(Case{"tyre", one_span + car_on_tyre}, Case{"steel_wheel", one_span + car_on_steel},
                    Case{"three_spans_and_forces",
                         "beam: {spans: [30.0, 36.0, 30.0], EI: 2.0e10, mass: 1.0e4, damping_ratios: 0.02}\n"
                         "support: {types: [pinned, roller, roller, roller]}\nscene: {tail: 0.5}\n" +
                             forces},
                    Case{"undamped",
                         "beam: {spans: [25.0, 25.0], EI: 1.0e10, mass: 3000.0}\n"
                         "support: {types: [pinned, roller, roller]}\n" +
                             car_on_tyre,
                         false},
                    Case{"stiff_wheel", mass_on_stiff_wheel},
                    Case{"bump", one_span + car_on_tyre +
                                     "track: {profile: bump, bump: {start: 10.0, length: 1.5, height: 0.01}}\n"}),
    [](const auto& which) { return which.param.name; });

TEST_P(ErrorEstimate, IsKeptAtEveryAccuracy) {
  const Case& c = GetParam();
  const Results truth =
      run_yaml(c.scene, {{"ts_dt", "1e-4"}, {"beam_elements_per_span", "160"}, {"step_probes", "true"}});
  double work_before = 0.0;
  std::size_t promised_before = 0;
  for (const char* accuracy : {"1e-2", "1e-3", "1e-4"}) {
    const Results run = run_yaml(c.scene, {{"accuracy", accuracy}});
    const double wanted = std::stod(accuracy);
    std::size_t promised = 0;
    for (const std::string quantity : quantities) {
      if (!(peak_of(truth, quantity) > 0.0)) continue;  // no wheels, no wheel force in the summary
      const auto expectation = expected(run, quantity);
      const double error = std::abs(peak_of(run, quantity) / peak_of(truth, quantity) - 1.0);
      RecordProperty(quantity + "_" + accuracy, text(error));
      // The others settle late: over a bump, near a bridge's end, moments as the sum of all modes without damping.
      const double settled = quantity == "deflection" ? 0.0 : quantity == "moment" && !c.acceleration ? 5e-3 : 5e-4;
      if (wanted > settled) {
        EXPECT_EQ(expectation.has_value(), quantity != "acceleration" || c.acceleration) << quantity << " " << accuracy;
      }
      if (!expectation) continue;
      ++promised;
      EXPECT_LE(error, wanted) << quantity;
      EXPECT_LE(*expectation, wanted) << quantity;
    }
    const double work = run.attribute("/summary", "solves");
    if (promised >= promised_before && wanted < 5e-4) {  // at 1e-2 modes may do, whose solves are others
      EXPECT_GT(work, work_before) << accuracy;
    }
    work_before = work;
    promised_before = promised;
  }
}

// The acceleration low-passed at the frequency that counts.

const std::string low_passed = "acceleration_lowpass";
const Values of_low_passed = {{"accuracy_of", "deflection,acceleration_lowpass"}};
const std::string hertz_wheel_undamped =
    "beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0}\nsupport: {types: [pinned, roller]}\n" +
    quarter_car_with(5750.0, 1000.0, 1.595e6, 0.0, "law: hertz, stiffness: 3.642821671e10") +
    "train: {vehicles: car, positions: 0.0, speed: 27.8}\nscene: {tail: 0.5}\n";
const std::string coaches_damped =
    "beam: {spans: [30.0, 36.0], EI: 3.0e11, mass: 2.5e4, damping_ratios: 0.02}\n"
    "support: {types: [pinned, roller, roller]}\n"
    "vehicle: {coach: {file: " +
    source_folder() +
    "/options/vehicles/velaro.yml}}\n"
    "train: {vehicles: coach*2, speed: 70.0}\nscene: {tail: 0.5}\n";

struct LowPassedCase {
  const char* name;
  std::string scene;
};
void PrintTo(const LowPassedCase& c, std::ostream* out) { *out << c.name; }

class LowPassedPromise : public testing::TestWithParam<LowPassedCase> {};
INSTANTIATE_TEST_SUITE_P(Accuracy, LowPassedPromise,
                         testing::Values(LowPassedCase{"hertz_wheel_undamped", hertz_wheel_undamped},
                                         LowPassedCase{"coaches_damped", coaches_damped}),
                         [](const auto& which) { return which.param.name; });

// Against elements half as long and a quarter of the step.
TEST_P(LowPassedPromise, IsKept) {
  const LowPassedCase& c = GetParam();
  for (const char* accuracy : {"1e-2", "1e-3"}) {
    Results run = run_yaml(c.scene, of_low_passed + Values{{"accuracy", accuracy}});
    const double wanted = std::stod(accuracy);
    const auto expectation = expected(run, low_passed);
    ASSERT_TRUE(expectation) << accuracy;
    EXPECT_LE(*expectation, wanted);
    EXPECT_FALSE(expected(run, "acceleration"));  // nobody asks for it
    const double step = run.attribute("/summary", "acceleration_lowpass_interval");
    const Results truth =
        run_yaml(c.scene, {{"accuracy_of", "acceleration_lowpass"},
                           {"ts_dt", text(std::min(0.25 * step, 1e-4))},
                           {"beam_elements_per_span", "80"},
                           {"step_probes", "true"},
                           {"output_lowpass", text(run.attribute("/summary", "acceleration_lowpass_frequency"))}});
    const double error = std::abs(peak_of(run, low_passed) / peak_of(truth, low_passed) - 1.0);
    RecordProperty("error_" + std::string(accuracy), text(error));
    EXPECT_GT(peak_of(truth, low_passed), 0.0);
    EXPECT_LE(error, wanted) << accuracy;
  }
}

// Without damping the acceleration of all modes is no sum; what counts of it is. Where the run filters without being
// asked for the promise it is promised too.
TEST(Accuracy, LowPassedIsPromisedWhereTheRunHasIt) {
  const Results run = run_yaml(hertz_wheel_undamped, {{"accuracy", "1e-2"}, {"output_lowpass", "auto"}});
  EXPECT_FALSE(expected(run, "acceleration"));
  EXPECT_TRUE(expected(run, "deflection"));
  EXPECT_TRUE(expected(run, low_passed));
  const Results without = run_yaml(hertz_wheel_undamped, {{"accuracy", "1e-2"}});
  EXPECT_FALSE(expected(without, low_passed));
  EXPECT_TRUE(std::isnan(without.attribute("/summary", low_passed)));
}

// Where the acceleration drives the cost steps are longer when what counts of it is asked for instead.
TEST(Accuracy, LowPassedTakesLongerSteps) {
  for (const char* modes : {"0", "auto"}) {
    const Values way = {{"model_modes", modes}, {"accuracy", "1e-3"}};
    const Results raw = run_yaml(coaches_damped, way + Values{{"accuracy_of", "deflection,acceleration"}});
    const Results filtered = run_yaml(coaches_damped, way + of_low_passed);
    ASSERT_TRUE(expected(raw, "acceleration"));
    ASSERT_TRUE(expected(filtered, low_passed));
    EXPECT_LT(filtered.attribute("/summary", "steps"), 0.5 * raw.attribute("/summary", "steps")) << modes;
  }
}

// Where the filter does not know what follows nothing is promised.
TEST(Accuracy, LowPassedIsNotPromisedAtTheEndOfARun) {
  const std::string ends_early = one_span + "load: {forces: 2.0e5, speed: 40.0}\nts: {max_time: 0.12}\n";
  const Results run = run_yaml(ends_early, of_low_passed + Values{{"accuracy", "1e-2"}});
  EXPECT_GT(peak_of(run, low_passed), 0.0);
  EXPECT_FALSE(expected(run, low_passed));
}

// What the user has fixed stays, and says so where it is too coarse.
TEST(Accuracy, FixedMeshIsNotPromised) {
  const std::string scene = one_span + car_on_tyre;
  const Results coarse = run_yaml(scene, {{"accuracy", "1e-3"}, {"beam_elements_per_span", "2"}});
  EXPECT_FALSE(expected(coarse, "acceleration"));
  const Results fine = run_yaml(scene, {{"accuracy", "1e-3"}, {"beam_elements_per_span", "40"}});
  EXPECT_TRUE(expected(fine, "acceleration"));
}

// A step of EI is met by nodes: errors of the mesh fall as fast as without it.
TEST(Accuracy, StepOfStiffnessFarFromTheStart) {
  const TemporaryFolder folder;
  const std::string table = folder.write("EI.csv", "0, 1.32e11\n67.9, 1.32e11\n67.9, 4.27e10\n77, 4.27e10\n");
  const std::string scene = "beam: {spans: [38.5, 38.5], EI: " + table +
                            ", mass: 8751.8, damping_ratios: 0.03}\n"
                            "support: {types: [pinned, roller, roller]}\n" +
                            quarter_car_with(36.9e3, 5350.0, 1.16e6, 2.7e4, "law: hertz, stiffness: 9.4e10") +
                            "train: {vehicles: car, positions: 0.0, speed: 22.3}\n";
  const Results truth =
      run_yaml(scene, {{"ts_dt", "1e-3"}, {"beam_elements_per_span", "120"}, {"step_probes", "true"}});
  const Results run = run_yaml(scene, {{"accuracy", "1e-2"}});
  ASSERT_TRUE(expected(run, "acceleration"));
  EXPECT_LE(std::abs(peak_of(run, "acceleration") / peak_of(truth, "acceleration") - 1.0), 1e-2);
}

/// A scene file without the step that it gives.
std::string without_step(const std::string& name) {
  std::ifstream file(source_folder() + "/options/scenes/" + name + ".yml");
  std::string text, line;
  while (std::getline(file, line))
    if (line.find("  dt:") == line.npos && line.find("  interval:") == line.npos && line != "output:")
      text += line + "\n";
  return text;
}

// Where there is no bridge, positions and joint forces are promised: Andrews' mechanism against its published end.
TEST(Accuracy, OfMechanisms) {
  const std::string andrews = without_step("r9_andrews");
  std::vector<double> steps;
  for (const char* accuracy : {"1e-3", "1e-9"}) {
    Results run = run_yaml(andrews, {{"accuracy", accuracy}, {"output_interval", "3e-4"}});
    const auto expectation = expected(run, "position");
    ASSERT_TRUE(expectation) << accuracy;
    EXPECT_TRUE(expected(run, "joint_force")) << accuracy;
    const std::vector<double> crank = run("/vehicles/0/k1/position"), arm = run("/vehicles/0/k7/position");
    const double error =
        std::max(std::abs(crank.back() - 15.81077119629904), std::abs(arm.back() - 1.048080741042263)) / 15.8;
    RecordProperty(std::string("position_") + accuracy, text(error));
    EXPECT_LT(error, std::stod(accuracy));
    EXPECT_LE(*expectation, std::stod(accuracy));
    steps.push_back(run.attribute("/summary", "steps"));
  }
  EXPECT_LT(steps[0], 1500.0);
  EXPECT_LT(steps[0], steps[1]);
}

// Forces of a contact that bounces are pulses, which no step settles.
TEST(Accuracy, OfBounces) {
  const Results run = run_yaml(without_step("bouncing_ball"), {{"accuracy", "1e-2"}});
  EXPECT_TRUE(expected(run, "position"));
  EXPECT_FALSE(expected(run, "contact_force"));
}

// With mesh and step given there is nothing to choose, and nothing is promised.
TEST(Accuracy, NothingOpenNothingPromised) {
  const Results run = run_yaml(one_span + car_on_tyre, {{"ts_dt", "1e-3"}, {"beam_elements_per_span", "10"}});
  for (const char* quantity : quantities) EXPECT_FALSE(expected(run, quantity)) << quantity;
}

}  // namespace
}  // namespace traverse::test
