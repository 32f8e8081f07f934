// Orders of convergence of whole runs, in time for each integrator and in space.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

// --- in time

// A half car on Hertz contact. It starts on the bridge from equilibrium and stays within one element, where the
// running surface is smooth: a wheel that passes a kink, or even a node (where the curvature jumps), would pull every
// method below its order.
constexpr const char* smooth = R"(
beam: {spans: 50.0, elements_per_span: 4, EI: 6.0e10, mass: 5000.0, damping_ratios: [0.02, 0.02]}
support: {types: [pinned, roller]}
vehicle:
  half_car:
    bodies:  [car, front_axle, rear_axle]
    joints:  [front_guide, rear_guide]
    springs: [front_suspension, rear_suspension]
    wheels:  [front_wheel, rear_wheel]
    car:              {mass: 17735.0, inertia: 1.47e5, position: [0.0, 1.5]}
    front_axle:       {mass: 1500.0, inertia: 100.0, position: [2.0, 0.5]}
    rear_axle:        {mass: 1000.0, inertia: 100.0, position: [-2.0, 0.5]}
    front_guide:      {type: prismatic, bodies: [car, front_axle], point: [2.0, 1.0], axis: [0.0, 1.0]}
    rear_guide:       {type: prismatic, bodies: [car, rear_axle], point: [-2.0, 1.0], axis: [0.0, 1.0]}
    front_suspension: {bodies: [car, front_axle], from: [2.0, 1.5], to: [2.0, 0.5], stiffness: 2.47e6, damping: 3.0e4}
    rear_suspension:  {bodies: [car, rear_axle], from: [-2.0, 1.5], to: [-2.0, 0.5], stiffness: 4.23e6, damping: 4.0e4}
    front_wheel:      {body: front_axle, radius: 0.5, law: hertz, stiffness: 1.0e9}
    rear_wheel:       {body: rear_axle, radius: 0.5, law: hertz, stiffness: 1.0e9}
train: {vehicles: half_car, positions: 15.5, speed: 30.0}
ts: {max_time: 0.05}
output: {interval: 0.05, probes: [12.5, 20.0, 25.0, 37.5]}
)";

// What has changed from start to end, one vector a quantity: they have different units.
std::vector<std::vector<double>> change(const Values& options, double step) {
  static const std::vector<std::string> quantities = {"/probes/deflection",
                                                      "/probes/velocity",
                                                      "/vehicles/0/car/position",
                                                      "/vehicles/0/car/velocity",
                                                      "/vehicles/0/front_axle/position",
                                                      "/vehicles/0/front_axle/velocity",
                                                      "/vehicles/0/rear_axle/position",
                                                      "/vehicles/0/rear_axle/velocity",
                                                      "/energy/dissipated",
                                                      "/energy/work"};
  Results run = run_yaml(smooth, options + Values{{"ts_dt", text(step)}});
  EXPECT_EQ(run.time().size(), 2u);
  std::vector<std::vector<double>> result;
  for (const std::string& name : quantities) {
    const std::vector<double> both = run(name);
    const std::size_t n = both.size() / 2;
    std::vector<double> difference(n);
    for (std::size_t i = 0; i < n; ++i) difference[i] = both[n + i] - both[i];
    result.push_back(std::move(difference));
  }
  return result;
}

// The worst quantity's error.
double error(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& exact) {
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, relative_difference(a[i], exact[i]));
  return worst;
}

struct Method {
  const char* name;
  Values options;
  double order, step;  // the longest of three steps, each half the one before
};
void PrintTo(const Method& method, std::ostream* out) { *out << method.name; }

// Orders as the methods' authors give them; for arkimex 3, 4 those of Kennedy and Carpenter 2003 (Appl. Numer. Math.
// 44, 139-181).
class OrderInTime : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(
    Convergence, OrderInTime,
    testing::Values(Method{"bdf", {{"ts_type", "bdf"}, {"ts_bdf_order", "2"}}, 2.0, 5e-4},
                    Method{"arkimex_3", {{"ts_type", "arkimex"}, {"ts_arkimex_type", "3"}}, 3.0, 2.5e-4},
                    Method{"arkimex_4", {{"ts_type", "arkimex"}, {"ts_arkimex_type", "4"}}, 4.0, 2e-3},
                    Method{"esdirk4", {{"ts_type", "esdirk4"}}, 4.0, 2e-3},
                    Method{"genalpha", {{"ts_type", "genalpha"}, {"ts_genalpha_radius", "0.8"}}, 2.0, 1e-3},
                    Method{"rk_4", {{"ts_type", "rk"}, {"ts_rk_type", "4"}}, 4.0, 1e-3}),
    [](const auto& which) { return which.param.name; });

TEST_P(OrderInTime, AsItsAuthorsSay) {
  const Method& method = GetParam();
  static const auto exact = change({{"ts_type", "arkimex"}, {"ts_arkimex_type", "4"}}, 6.25e-5);
  double before = 0.0;
  for (int halving = 0; halving < 3; ++halving) {
    const double step = method.step / std::pow(2.0, halving);
    const double now = error(change(method.options, step), exact);
    RecordProperty("error_" + std::to_string(halving), text(now));
    if (halving > 0) {
      EXPECT_NEAR(std::log2(before / now), method.order, 0.25) << "from step " << 2.0 * step << " s";
    }
    before = now;
  }
}

// --- in space

// Cubic elements have order 4 for smooth loads; a concentrated force inside an element leaves out that element's own
// fixed-end deflection, F h^3 xi^3 (1 - xi)^3/(3 EI), which makes it 3. How far the wheel stands from a node at the
// instant of largest error differs from mesh to mesh, so pairs scatter and the whole row is asserted.
TEST(OrderInSpace, SprungMass) {
  auto curve_of = [](int elements) {
    return run_scene(
        "r2_sprung_mass",
        {{"beam_elements_per_span", std::to_string(elements)}, {"ts_dt", "5e-4"}, {"output_interval", "5e-4"}});
  };
  Results exact = curve_of(96);
  const std::vector<double> deflection = exact.column("/probes/deflection");
  const double largest = refined_peak(exact.time(), deflection).value;
  EXPECT_NEAR(largest, -2.40731635e-3, 1e-5 * 2.40731635e-3);  // R2 of reference_cases_test.cpp
  double first = 0.0, last = 0.0, peak_first = 0.0, peak_last = 0.0;
  for (int elements = 6; elements <= 48; elements *= 2) {
    Results run = curve_of(elements);
    const double previous = last;
    last = relative_difference(run.column("/probes/deflection"), deflection);
    peak_last = std::abs(refined_peak(run.time(), run.column("/probes/deflection")).value / largest - 1.0);
    RecordProperty("error_" + std::to_string(elements), text(last));
    RecordProperty("peak_error_" + std::to_string(elements), text(peak_last));
    if (elements == 6) {
      first = last;
      peak_first = peak_last;
    } else {
      EXPECT_GT(std::log2(previous / last), 2.5) << elements << " elements";
    }
  }
  EXPECT_GT(std::log2(first / last) / 3.0, 3.0);
  EXPECT_GT(std::log2(peak_first / peak_last) / 3.0, 3.0);
  EXPECT_LT(peak_last, 1e-6);
}

}  // namespace
}  // namespace traverse::test
