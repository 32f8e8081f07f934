// Peaks are of curves that converge: with each halving of the step they change less, where wheels and forces enter and
// leave, pass hinges and separate spans, and stand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string wheel = R"(
vehicle:
  car:
    bodies: [axle]
    drivers: [level]
    wheels: [wheel]
    axle: {mass: 5000.0, inertia: 100.0, position: [0.0, 0.5]}
    level: {body: axle, coordinate: phi}
    wheel: {body: axle, radius: 0.5, law: linear, stiffness: 2.0e6}
scene: {tail: 0.1}
)";
const std::string beam = "EI: 5.0e9, mass: 3000.0, elements_per_span: 10, damping_ratios: [0.03, 0.03]";

struct Case {
  const char* name;
  std::string scene;
  // A load that enters at an elastic bearing accelerates the beam's end without bound, as much as steps and mesh allow.
  bool has_acceleration = true;
};

std::string on(const std::string& spans, const std::string& supports, const std::string& loads) {
  return fmt::format("beam: {{{}, {}}}\nsupport: {{{}}}\n{}", spans, beam, supports, loads);
}

const std::string to_the_right = wheel + "train: {vehicles: car, speed: 20.0, positions: -0.5}\n";
const std::string to_the_left = wheel + "train: {vehicles: car, speed: -20.0, positions: 20.5}\n";
const std::string forces = "load: {forces: [1.0e5, 1.0e5], positions: [-1.0, -4.3], speed: 61.0}\nscene: {tail: 0.2}\n";

class PeakConvergence : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Scenes, PeakConvergence,
    testing::Values(Case{"LeavesASoftEnd", on("spans: 20.0", "types: [pinned, roller], stiffness: [0, 5.0e7]",
                                              to_the_right + "output: {probes: [10.0, 19.3]}\n")},
                    Case{"LeavesASoftEndToTheLeft", on("spans: 20.0", "types: [pinned, roller], stiffness: [5.0e7, 0]",
                                                       to_the_left + "output: {probes: [0.7, 10.0]}\n")},
                    Case{"EntersASoftEnd",
                         on("spans: 20.0", "types: [pinned, roller], stiffness: [5.0e7, 0]",
                            to_the_right + "output: {probes: [0.7, 10.0]}\n"),
                         false},
                    Case{"PassesAHinge", on("spans: [20.0, 20.0], hinges: 26.0", "types: [pinned, roller, roller]",
                                            to_the_right + "output: {probes: [10.0, 25.3, 26.0, 33.0]}\n")},
                    Case{"PassesASeparateSpan",
                         on("spans: [20.0, 20.0], continuity: simply_supported", "types: [pinned, roller, roller]",
                            to_the_right + "output: {probes: [10.0, 20.0, 33.1]}\n")},
                    Case{"ForcesPass",
                         on("spans: 20.0", "types: [pinned, roller]", forces + "output: {probes: [0.0, 3.1, 10.0]}\n")},
                    Case{"ForcesPassSoftEnds",
                         on("spans: 20.0", "types: [pinned, roller], stiffness: [5.0e7, 5.0e7]",
                            forces + "output: {probes: [3.1, 10.0]}\n"),
                         false},
                    Case{"WheelsStand",
                         on("spans: 20.0", "types: [pinned, roller]",
                            wheel + "train: {vehicles: [car, car], positions: [10.0, 6.0], speed: 0.0}\n" +
                                "load: {forces: 1.0e5, positions: -1.0, speed: 61.0}\n" +
                                "ts: {max_time: 0.5}\noutput: {probes: [3.1, 10.0]}\n")}),
    [](const auto& set) { return set.param.name; });

/// The peaks and the least and greatest shear of each probe.
std::vector<std::pair<std::string, double>> peaks_of(const Case& c, double step) {
  Results run = run_yaml(c.scene, {{"ts_dt", fmt::format("{}", step)}, {"output_interval", "0.02"}});
  std::vector<std::pair<std::string, double>> peaks;
  for (const char* name : {"deflection", "acceleration", "moment", "shear"})
    if (c.has_acceleration || std::string(name) != "acceleration")
      peaks.emplace_back(name, run.attribute("/summary", name));
  if (c.scene.find("train") != std::string::npos)
    for (const char* name : {"greatest_wheel_force", "least_wheel_force"})
      peaks.emplace_back(name, run.attribute("/summary", name));
  for (const char* name : {"/envelope/moment", "/envelope/shear"})
    for (std::size_t i = 0; i < run(name).size(); ++i) peaks.emplace_back(fmt::format("{} {}", name, i), run(name)[i]);
  return peaks;
}

TEST_P(PeakConvergence, WithTheStep) {
  constexpr double settled = 1e-3;  // relative to the peak: smaller changes need not become smaller
  const auto rough = peaks_of(GetParam(), 2e-3), fine = peaks_of(GetParam(), 1e-3), finest = peaks_of(GetParam(), 5e-4);
  for (std::size_t i = 0; i < finest.size(); ++i) {
    const double first = std::abs(fine[i].second - rough[i].second);
    const double second = std::abs(finest[i].second - fine[i].second);
    EXPECT_LE(second, std::max(0.7 * first, settled * std::abs(finest[i].second)))
        << finest[i].first << ": " << rough[i].second << ", " << fine[i].second << ", " << finest[i].second;
  }
}

constexpr double P = 5000.0 * 9.81, L = 22.0;  // N, m

/// Wheels stand on a simple beam at these positions: the shear at the probes at 2, 8, 11 and 15 m, at every instant.
void expect_shear_at_rest(const std::string& vehicles, const std::string& positions, std::array<double, 4> exact) {
  for (const char* model : {"full", "linear"}) {
    Results run =
        run_yaml("beam: {spans: 22.0, EI: 1.6e9, mass: 700.0, elements_per_span: 8, damping_ratios: 0.01}\n" + wheel +
                     fmt::format("train: {{vehicles: [{}], positions: [{}], speed: 0.0}}\n", vehicles, positions) +
                     "ts: {max_time: 0.4, dt: 5.0e-3}\noutput: {interval: 0.02, probes: [2.0, 8.0, 11.0, 15.0]}\n",
                 {{"model_vehicles", model}});
    for (std::size_t p = 0; p < exact.size(); ++p) {
      for (const double shear : run.column("/probes/shear", p)) EXPECT_NEAR(shear, exact[p], 1e-4 * P) << model << p;
      EXPECT_NEAR(run("/envelope/shear")[2 * p], exact[p], 1e-4 * P) << model << p;
      EXPECT_NEAR(run("/envelope/shear")[2 * p + 1], exact[p], 1e-4 * P) << model << p;
    }
  }
}

// By symmetry the deck is level at the middle, and the wheel touches it exactly at the probe: it counts as left of it.
TEST(ShearAtRest, IsThatOnTheRightOfAWheelAtTheProbe) {
  expect_shear_at_rest("car, car, car", "11.0, 4.0, 18.0", {1.5 * P, 0.5 * P, -0.5 * P, -0.5 * P});
}

// The deck slopes under a wheel whose centre is above the probe: the wheel touches it 0.05 mm beside the probe, where
// the deck is higher. The probe is at a node, so that this is another element than on its other side.
TEST(ShearAtRest, IsThatOnTheSideOfTheContactPoint) {
  const double left = P * (11.0 + 18.0) / L, middle = left - P, right = middle - P;
  expect_shear_at_rest("car, car", "11.0, 4.0", {left, middle, middle, right});
  expect_shear_at_rest("car, car", "11.0, 18.0", {-right, -right, -middle, -middle});
}

}  // namespace
}  // namespace traverse::test
