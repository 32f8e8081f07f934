// Scenes at the edge of what makes sense, which have to run, and to give what statics or a textbook says. Further ones:
// extremes_beam_test.cpp, extremes_steps_test.cpp, extremes_vehicle_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

Results run(const Workplace& workplace, std::vector<std::string> words = {}) {
  static int count = 0;
  const std::string file = "r" + std::to_string(++count) + ".h5";  // Results reads when asked
  words.insert(words.end(), {"-output_file", file});
  expect_success(workplace.run(words));
  return Results(workplace.path(file));
}

double lowest(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
double highest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Vertical support reactions of the beam in the row of an instant, upward on the beam.
double vertical_reaction(Results& results, std::size_t row) {
  const std::vector<double>& reactions = results("/supports/reaction");
  double sum = 0.0;
  for (std::size_t s = 0; s < 3; ++s) sum += reactions[9 * row + 3 * s + 1];
  return sum;
}

// At rest nothing moves, and the supports carry what stands on the beam.
TEST(Wheel, StandsOnNodesSupportsAndEnds) {
  const Workplace workplace(small_scene());
  for (const double x : {-3.0, 0.0, 1.7, 5.0, 20.0, 40.0, 41.0}) {
    SCOPED_TRACE(x);
    Results results =
        run(workplace, {"-train_positions", std::to_string(x), "-train_speed", "0", "-ts_max_time", "0.1"});
    const std::vector<double>& force = results("/vehicles/0/wheel/normal_force");
    EXPECT_NEAR(lowest(force), quarter_car_weight, 1e-6 * quarter_car_weight);
    EXPECT_NEAR(highest(force), quarter_car_weight, 1e-6 * quarter_car_weight);
    const double carried = x < 0.0 || x > 40.0 ? 0.0 : quarter_car_weight;
    for (const std::size_t row : {std::size_t{0}, force.size() - 1})
      EXPECT_NEAR(vertical_reaction(results, row), carried, 1e-6 * quarter_car_weight);
    const std::vector<double> deflection = results.column("/probes/deflection");
    EXPECT_NEAR(deflection.front(), deflection.back(), 1e-9);
  }
}

TEST(Wheel, StartsOnTheBridge) {
  const Workplace workplace(small_scene());
  Results results = run(workplace, {"-train_positions", "10"});
  const std::vector<double> deflection = results.column("/probes/deflection", 0);
  EXPECT_LT(deflection.front(), 0.0);  // in equilibrium, not dropped: the wheel's force begins at the weight
  EXPECT_NEAR(results("/vehicles/0/wheel/normal_force").front(), quarter_car_weight, 0.02 * quarter_car_weight);
  EXPECT_NEAR(results.time().back(), 30.0 / 40.0, 1e-12);
}

TEST(Wheel, TwoInOneElement) {
  const Workplace workplace(small_scene());
  Results results = run(
      workplace, {"-train_vehicles", "car*2", "-train_positions", "8,6", "-train_speed", "0", "-ts_max_time", "0.1"});
  EXPECT_NEAR(vertical_reaction(results, 0), 2.0 * quarter_car_weight, 1e-6 * quarter_car_weight);
  const double both = results.column("/probes/deflection", 0).front();
  double sum = 0.0;
  for (const char* x : {"8", "6"}) {
    Results one = run(workplace, {"-train_positions", x, "-train_speed", "0", "-ts_max_time", "0.1"});
    sum += one.column("/probes/deflection", 0).front();
  }
  // A linear beam: two wheels add up, but for the slope (5e-5), which moves the points of contact.
  EXPECT_NEAR(both, sum, 1e-5 * std::abs(sum));
  run(workplace, {"-train_vehicles", "car*2", "-train_positions", "4,3"});
}

TEST(Wheel, LeavesWithoutDampingAnywhere) {
  const Workplace workplace(small_scene());
  Results results = run(workplace, {"-vehicle_car_suspension_damping", "0", "-scene_tail", "1"});
  EXPECT_LT(std::abs(results("/energy/residual").back()), 1e-4 * peak(results("/energy/strain")).first);
}

// One cubic element a span, with the correction for forces between nodes, against twenty.
TEST(Beam, OneElementASpan) {
  const Workplace workplace(small_scene());
  Results coarse = run(workplace, {"-beam_elements_per_span", "1"});
  Results fine = run(workplace, {"-beam_elements_per_span", "20"});
  const double reference = peak(fine("/probes/deflection")).first;
  EXPECT_NEAR(peak(coarse("/probes/deflection")).first, reference, 0.05 * std::abs(reference));
}

TEST(Beam, ProbesOnSupports) {
  const Workplace workplace(small_scene());
  Results results = run(workplace, {"-output_probes", "0,20,40"});
  EXPECT_LT(std::abs(peak(results("/probes/deflection")).first), 1e-12);
}

TEST(Run, EmptyTrain) {
  const Workplace workplace(small_scene());
  expect_refusal(workplace, workplace.run({"-train_vehicles", ""}), {"ts_max_time"});
  Results results = run(workplace, {"-train_vehicles", "", "-ts_max_time", "0.1"});
  EXPECT_EQ(peak(results("/probes/deflection")).first, 0.0);
}

TEST(Run, ShorterThanAStep) {
  const Workplace workplace(small_scene());
  Results results = run(workplace, {"-ts_max_time", "1e-6"});
  EXPECT_DOUBLE_EQ(results.attribute("/summary", "end_time"), 1e-6);
  EXPECT_DOUBLE_EQ(results("/end/time")[0], 1e-6);
  EXPECT_EQ(results.time(), std::vector<double>{0.0});
}

TEST(Run, NoGravityAndNoContact) {
  const Workplace workplace(small_scene());
  Results results = run(workplace, {"-gravity", "0"});
  EXPECT_LT(peak(results("/probes/deflection")).first, 1e-12);
}

// Small swings of a point mass: T = 2 pi sqrt(l/g) (1 + a^2/16), a = 0.01 rad.
TEST(Mechanism, PendulumKeepsItsPeriod) {
  const Workplace workplace(R"(vehicle:
  pendulum:
    bodies: [bob]
    joints: [pin]
    bob: {mass: 1.0, inertia: 1.0e-9, position: [0.00999983, -0.99995], angle: 0.0}
    pin: {type: revolute, bodies: [ground, bob], point: [0.0, 0.0]}
scene: {start: given}
ts_max_time: 10.0
ts_dt: 0.01
output: {interval: 0.01}
)");
  Results results = run(workplace);
  const std::vector<double> t = results.time(), x = results.column("/vehicles/0/bob/position", 0);
  std::vector<double> zeros;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (x[i - 1] * x[i] < 0.0) zeros.push_back(t[i - 1] + (t[i] - t[i - 1]) * x[i - 1] / (x[i - 1] - x[i]));
  }
  ASSERT_GE(zeros.size(), 9U);
  const double period = 2.0 * (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
  EXPECT_NEAR(period, 2.0 * std::numbers::pi / std::sqrt(9.81) * (1.0 + 1e-4 / 16.0), 2e-6 * period);
}

TEST(Mechanism, VehicleOnRigidGround) {
  const Workplace workplace(std::string(quarter_car) + "ts_dt: 0.01\nts_max_time: 1.0\n");
  Results results = run(workplace);
  const std::vector<double>& force = results("/vehicles/0/wheel/normal_force");
  EXPECT_NEAR(lowest(force), quarter_car_weight, 1e-9 * quarter_car_weight);
  EXPECT_NEAR(
      results.column("/vehicles/0/body/position", 0).back() - results.column("/vehicles/0/body/position", 0).front(),
      40.0, 1e-9);
}

}  // namespace
}  // namespace traverse::test
