// Dynamic amplification is over the greatest static deflection under all that passes. Speeds are so low, or bridges so
// stiff, that the dynamic deflection is the static one: 1 is true whatever passes.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr double P = 9.81e4, L = 30.0, EI = 2.0e10;

/// m: what a force at x deflects a simple span by at its middle.
double by_force(double x) {
  const double a = std::min(x, L - x);
  return a <= 0.0 ? 0.0 : P * a * (3.0 * L * L - 4.0 * a * a) / (48.0 * EI);
}

std::string vehicle(const std::string& name, double velocity) {
  const std::string v = std::to_string(velocity);
  return "  " + name + ":\n    bodies: [body]\n    wheels: [wheel]\n    drivers: [level]\n" +
         "    body: {mass: 1.0e4, inertia: 1.0, position: [0.0, 0.46], velocity: [" + v + ", 0.0, 0.0]}\n" +
         "    level: {body: body, coordinate: phi}\n" +
         "    wheel: {body: body, radius: 0.46, law: linear, stiffness: 1.0e8}\n";
}

std::string bridge() {
  return "beam: {spans: 30.0, EI: 2.0e10, mass: 1.0, elements_per_span: 12}\nsupport: {types: [pinned, roller]}\n";
}

std::string two_vehicles(double first, double second, const std::string& train) {
  return bridge() + "vehicle:\n" + vehicle("first", first) + vehicle("second", second) + "train: {" + train + "}\n";
}

void expect_static(Results& run, double deflection) {
  EXPECT_NEAR(run.attribute("/summary", "static_deflection"), deflection, 2e-5 * deflection);
  EXPECT_NEAR(run.attribute("/summary", "amplification"), 1.0, 0.02);
}

const Values slowly = {{"ts_dt", "1e-3"}, {"ts_max_time", "4"}, {"output_interval", "0.01"}};

TEST(Amplification, OfVehiclesThatMeetOnTheBridge) {
  Results run = run_yaml(
      two_vehicles(10.0, -10.0, "vehicles: [first, second], positions: [-5.0, 35.0], speed: 0.0, drive: free"), slowly);
  expect_static(run, 2.0 * by_force(15.0));
}

// They meet at its end, where one of them leaves it.
TEST(Amplification, OfVehiclesThatMeetBesideTheMiddle) {
  Results run =
      run_yaml(two_vehicles(10.0, -10.0, "vehicles: [first, second], positions: [-5.0, 65.0], speed: 0.0, drive: free"),
               slowly + Values{{"ts_max_time", "7"}});
  expect_static(run, by_force(15.0));
}

TEST(Amplification, OfAVehicleThatOvertakes) {
  Results run = run_yaml(
      two_vehicles(20.0, 10.0, "vehicles: [first, second], positions: [-25.0, -5.0], speed: 0.0, drive: free"), slowly);
  expect_static(run, 2.0 * by_force(15.0));
}

TEST(Amplification, OfVehiclesInARow) {
  Results run = run_yaml(two_vehicles(0.0, 0.0, "vehicles: [first, second], positions: [-1.0, -7.0], speed: 10.0"),
                         slowly + Values{{"ts_max_time", "6"}});
  double worst = 0.0;
  for (double x = 0.0; x <= L; x += 0.01) worst = std::max(worst, by_force(x) + by_force(x + 6.0 > L ? 0.0 : x + 6.0));
  expect_static(run, worst);
}

TEST(Amplification, OfForcesThatOvertakeAVehicle) {
  Results run = run_yaml(bridge() + "vehicle:\n" + vehicle("first", 0.0) +
                             "train: {vehicles: first, positions: -5.0, speed: 10.0}\nload: {forces: 9.81e4, "
                             "positions: -25.0, speed: 20.0}\n",
                         slowly);
  expect_static(run, 2.0 * by_force(15.0));
}

// A start that is given says nothing of the weights: this wheel is drawn just above the bridge.
TEST(Amplification, OfAVehicleInAStateThatIsGiven) {
  Results run = run_yaml(bridge() + "vehicle:\n" + vehicle("first", 0.0) +
                             "train: {vehicles: first, positions: -1.0, speed: 10.0}\nscene: {start: given}\n",
                         slowly);
  EXPECT_NEAR(run.attribute("/summary", "static_deflection"), by_force(15.0), 2e-5 * by_force(15.0));
  EXPECT_GT(run.attribute("/summary", "amplification"), 1.0);
}

// Between nodes too, with the bridge's own weight, by elements and by modes.
TEST(Amplification, OfForcesAtAStationBetweenNodes) {
  const std::string text = bridge() + "load: {forces: [9.81e4, 9.81e4], positions: [0.0, -6.0], speed: 5.0}\n";
  const Values options = {{"beam_elements_per_span", "2"}, {"output_probes", "11"}, {"beam_mass", "1000"},
                          {"beam_self_weight", "true"},    {"ts_dt", "2e-3"},       {"output_interval", "0.02"}};
  const double b = 11.0, q = 9810.0;
  const auto by_force_at = [&](double x) {
    if (x <= 0.0 || x >= L) return 0.0;
    const double a = std::min(x, b), far = L - std::max(x, b);
    return P * a * far * (L * L - a * a - far * far) / (6.0 * L * EI);
  };
  double worst = 0.0;
  for (double x = 0.0; x <= L + 6.0; x += 0.01) worst = std::max(worst, by_force_at(x) + by_force_at(x - 6.0));
  const double exact = worst + q * b * (L * L * L - 2.0 * L * b * b + b * b * b) / (24.0 * EI);
  Results elements = run_yaml(text, options);
  Results modes = run_yaml(text, options + Values{{"model_modes", "4"}});
  EXPECT_NEAR(elements.attribute("/summary", "static_deflection"), exact, 1e-5 * exact);
  EXPECT_NEAR(modes.attribute("/summary", "static_deflection"), exact, 1e-5 * exact);
  EXPECT_NEAR(elements.attribute("/summary", "amplification"), 1.0, 0.02);
  for (const char* count : {"0", "4"}) {
    Results sweep = run_yaml(text, options + Values{{"sweep_speed", "5,10,5"}, {"model_modes", count}});
    EXPECT_NEAR(sweep("/sweep/peak_deflection")[0] / sweep("/sweep/amplification")[0], exact, 1e-5 * exact) << count;
  }
}

}  // namespace
}  // namespace traverse::test
