// A rail of few elements a sleeper bay under wheels: between its nodes it bends as a beam does, at rest exactly, and
// under moving wheels so nearly that two elements a bay do what eight did. So does a bridge, where that is asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/promised.hpp"
#include "support/quarter_car.hpp"
#include "support/scene_run.hpp"
#include "support/small_track.hpp"

namespace traverse::test {
namespace {

// The bridge's own Rayleigh damping makes its accelerations settle.
std::string on_track(const std::string& wheel) {
  return quarter_car_with(1.35e4, 1800.0, 2.4e6, 2e4, wheel) + track_of(r8_layers, R"(
  approach: 12.0
beam: {spans: 18.0, EI: 5.0e10, mass: 1.2e4, damping_ratios: 0.02}
support: {types: [pinned, roller]}
train: {vehicles: car, positions: -3.0, speed: 80.0}
)");
}
constexpr double slope_left_out = 1e-9;  // m
const std::string hertz = "law: hertz, stiffness: 1.721e11";

double wheel_height(const std::string& scene, const std::string& elements, const std::string& x) {
  Results run = run_yaml(
      scene,
      {{"track_elements_per_bay", elements}, {"train_positions", x}, {"ts_max_time", "1e-4"}, {"ts_dt", "1e-4"}});
  return run.column("/vehicles/0/axle/position", 1)[0];
}

// Elements of an unloaded rail are exact at their nodes: with twelve a bay the wheel stands on one of these. Without
// what the others bend between theirs it would stand up to 1.3e-5 m higher on one element a bay, 4e-7 m on three. The
// slope of that, 3e-5 at most, is left out of the direction of the contact: R theta^2/2.
TEST(RailBetweenNodes, AWheelAtRestSinksAsTheBeamDoes) {
  for (const std::string& wheel : {hertz, std::string("law: linear, stiffness: 2.0e9")}) {
    const std::string scene = on_track(wheel);
    for (const char* x : {"-3.0", "-2.95", "-2.85", "-2.8", "-2.7", "-2.55", "5.65"}) {
      const double exact = wheel_height(scene, "12", x);
      for (const char* elements : {"1", "2", "3"})
        EXPECT_NEAR(wheel_height(scene, elements, x), exact, slope_left_out) << x << " m, " << elements;
    }
  }
}

// From the first step on: at the start the bridge is at rest beside a rail that moves.
std::vector<double> moving(Results& run, const std::string& quantity) {
  const std::vector<double>& all = run(quantity);
  return {all.begin() + 1, all.end()};
}

TEST(RailBetweenNodes, TwoElementsABayFollowAMovingWheel) {
  const std::string scene = on_track(hertz);
  const auto run = [&](const char* elements) {
    return run_yaml(scene, {{"track_elements_per_bay", elements}, {"ts_dt", "2.5e-4"}, {"output_interval", "2.5e-4"}});
  };
  Results one = run("1"), two = run("2"), fine = run("12");
  const std::string force = "/vehicles/0/wheel/normal_force", acceleration = "/probes/acceleration";
  for (const std::string& quantity : {force, acceleration}) {
    const std::vector<double> exact = moving(fine, quantity);
    const double of_one = relative_difference(moving(one, quantity), exact);
    const double of_two = relative_difference(moving(two, quantity), exact);
    RecordProperty(quantity.substr(quantity.rfind('/') + 1), text(of_two));
    EXPECT_LT(of_one, 5e-3) << quantity;
    EXPECT_LT(of_two, 6e-4) << quantity;
    EXPECT_GT(std::log2(of_one / of_two), 1.9) << quantity;
  }
}

// What a whole bay's rail stores under the wheel, F^2 h^3/(384 EI), comes and goes bay by bay, 138 times a second.
TEST(RailBetweenNodes, ItsEnergyComesBack) {
  Results run = run_yaml(on_track(hertz), {{"track_elements_per_bay", "1"}, {"ts_dt", "1.25e-4"}});
  const double weight = 9.81 * (1.35e4 + 1800.0), stored = weight * weight * 0.216 / (384 * 1.32476e7);
  const double residual = std::abs(peak(run("/energy/residual")).first);
  RecordProperty("residual_over_stored", text(residual / stored));
  EXPECT_LT(residual, 1e-2 * stored);
}

// The rail's deflection begins to move with the wheel: steps that pass over the contact's vibration see none.
TEST(RailBetweenNodes, TheStartStirsNoContact) {
  const std::string scene = on_track(hertz);
  const auto run = [&](const char* step) { return run_yaml(scene, {{"ts_dt", step}, {"output_interval", "1e-3"}}); };
  Results coarse = run("5e-4"), fine = run("6.25e-5");
  const double error =
      relative_difference(coarse("/vehicles/0/wheel/normal_force"), fine("/vehicles/0/wheel/normal_force"));
  RecordProperty("error", text(error));
  EXPECT_LT(error, 6e-4);
}

// `accuracy` finds out that few elements do.
TEST(RailBetweenNodes, AccuracyTakesFewElements) {
  const std::string scene = on_track(hertz);
  Results fine = run_yaml(scene, {{"track_elements_per_bay", "8"}, {"ts_dt", "1.25e-4"}, {"step_probes", "true"}});
  testing::internal::CaptureStdout();
  Results run = run_yaml(scene, {{"accuracy", "1e-3"}});
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("accuracy 0.001: 4 elements a sleeper bay"), std::string::npos) << said;
  for (const std::string quantity : {"deflection", "acceleration", "moment", "wheel_force"}) {
    const std::string name = quantity == "wheel_force" ? "greatest_wheel_force" : quantity;
    const double true_error = std::abs(run.attribute("/summary", name) / fine.attribute("/summary", name) - 1.0);
    EXPECT_LE(run.attribute("/summary", "expected_error_" + quantity), 1e-3) << quantity;
    EXPECT_LE(true_error, 1e-3) << quantity;
    RecordProperty(quantity, text(true_error));
  }
}

// Without what its elements bend under it, a mass on a stiff wheel is thrown up at each node of a bridge, too.
TEST(BridgeBetweenNodes, SixteenElementsCarryAStiffWheel) {
  const std::string scene =
      "beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0, damping_ratios: 0.01}\nsupport: {types: [pinned, roller]}\n"
      "vehicle:\n  car:\n    bodies: [body]\n    wheels: [wheel]\n    drivers: [level]\n"
      "    body: {mass: 14394.0, inertia: 1.0, position: [0.0, 0.1]}\n"
      "    wheel: {body: body, radius: 0.1, law: linear, stiffness: 1.0e9}\n"
      "    level: {body: body, coordinate: phi}\ntrain: {vehicles: car, speed: 59.7}\n";
  const auto run = [&](const char* elements, const char* seats) {
    return run_yaml(
        scene,
        {{"beam_elements_per_span", elements}, {"contact_seats", seats}, {"ts_dt", "2.5e-4"}, {"step_probes", "true"}});
  };
  const Results fine = run("256", "false"), with = run("16", "true"), without = run("16", "false");
  for (const char* quantity : {"wheel_force", "acceleration"}) {
    const auto error = [&](const Results& coarse) {
      return std::abs(peak_of(coarse, quantity) / peak_of(fine, quantity) - 1.0);
    };
    RecordProperty(quantity, text(error(with)));
    EXPECT_LT(error(with), 3e-4) << quantity;
    EXPECT_GT(error(without), 3e-3) << quantity;
  }
}

}  // namespace
}  // namespace traverse::test
