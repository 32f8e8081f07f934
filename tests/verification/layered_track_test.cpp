// Rail, pads, sleepers, ballast and sub-ballast over a bridge and the ground: a published scene, the limit of a beam on
// a bed, and what has to hold for any arrangement of the layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/scene_run.hpp"
#include "support/small_track.hpp"

namespace traverse::test {
namespace {

double magnitude(const std::vector<double>& values) { return std::abs(peak(values).first); }

/// What is left of the forces along x and y over the weight of all that moves, kg m/s2.
void expect_balanced(Results& run, double weight) {
  const double left = magnitude(run("/balance/residual"));
  testing::Test::RecordProperty("residual_over_weight", text(left / weight));
  EXPECT_LT(left, 1e-9 * weight);
}

// R8 of the reference cases: the Manchester coach, Zhai's track, Xia's bridge at 120 km/h. The figures are a converged
// computation of its own; wheel forces are those on the bridge, where the start has died away. (Its rail sinks to
// 1.2686e-3 m under the first wheel; here it is 1.2645e-3, on meshes of 2 to 8 elements a bay.)
TEST(LayeredTrack, BallastedBridge) {
  Results run = run_scene("r8_ballasted_bridge", {{"ts_dt", "1e-3"}, {"track_elements_per_bay", "2"}});
  const double midspan = peak(run("/probes/deflection")).first;
  EXPECT_NEAR(midspan / -5.38333e-4, 1.0, 1e-3);
  RecordProperty("midspan_error", text(midspan / -5.38333e-4 - 1.0));
  double least = 1e9, greatest = 0.0;
  for (const char* number : {"1", "2", "3", "4"}) {
    const std::string vehicle = "/vehicles/0/";
    const std::vector<double> force = run(vehicle + "wheel_" + number + "/normal_force");
    const std::vector<double> x = run.column(vehicle + "wheelset_" + number + "/position", 0);
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (x[i] < 0.0 || x[i] > 50.0) continue;
      least = std::min(least, force[i]);
      greatest = std::max(greatest, force[i]);
    }
  }
  EXPECT_NEAR(least, 107950.0, 200.0);
  EXPECT_NEAR(greatest, 109820.0, 200.0);
  expect_balanced(run, 9.81 * (50 * 69000.0 + 44482.0));

  // Smooth at this step: half of it changes no wheel force on the bridge by more than 20 N.
  Results finer = run_scene("r8_ballasted_bridge", {{"ts_dt", "5e-4"}, {"track_elements_per_bay", "2"}});
  const std::vector<double> here = run("/vehicles/0/wheel_1/normal_force"),
                            there = finer("/vehicles/0/wheel_1/normal_force"),
                            x = run.column("/vehicles/0/wheelset_1/position", 0);
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (x[i] <= 0.0 || x[i] >= 50.0) continue;
    ASSERT_NEAR(here[i], there[i], 20.0) << x[i];
  }
}

// On a rigid bridge, with light sleepers on stiff ballast, the rail stands on a bed of k = pad/spacing.
constexpr const char* rigid_bridge = R"(
beam: {spans: 20.0, EI: 1.0e16, mass: 1.0e5}
support: {types: [clamped, clamped]}
track:
  rail: {EI: 1.32476e7, mass: 121.28}
  spacing: 0.1
  elements_per_bay: 1
  pad: {k: 1.0e7, c: 1.0e4}
  sleeper: {mass: 1.0}
  ballast: {mass: 1.0, k: 1.0e12}
  subballast: {k: 1.0e12}
  approach: 30.0
load: {forces: 2.0e5, positions: 10.0, speed: 0.0}
gravity: 9.81
output: {probes: [8.0, 10.0, 12.5]}
)";

TEST(LayeredTrack, StaticLimitIsTheBeamOnABed) {
  Results run = run_yaml(rigid_bridge, {{"scene_analysis", "static"}});
  const double k = 1e7 / 0.1, lambda = std::pow(k / (4 * 1.32476e7), 0.25);
  const auto exact = [&](double x) {
    return -2e5 * lambda / (2 * k) * std::exp(-lambda * x) * (std::cos(lambda * x) + std::sin(lambda * x));
  };
  const std::vector<double> rail = run("/rail/deflection");
  // Springs at 0.1 m instead of a bed: (lambda s)^4/720 of the deflection, and less than 1e-4 by the stiff layers.
  EXPECT_NEAR(rail[1] / exact(0.0), 1.0, 2e-4);
  EXPECT_NEAR(rail[0], exact(2.0), 2e-4 * std::abs(exact(0.0)));
  EXPECT_NEAR(rail[2], exact(2.5), 2e-4 * std::abs(exact(0.0)));
}

TEST(LayeredTrack, MovingLimitIsTheBeamOnABed) {
  const Values moving = {{"load_speed", "100"}, {"ts_dt", "5e-4"}, {"output_interval", "1e-3"}};
  Results track = run_yaml(rigid_bridge, moving + Values{{"load_positions", "-25"}, {"ts_max_time", "0.45"}});
  Results bed = run_yaml(R"(
beam: {spans: 80.0, elements_per_span: 800, EI: 1.32476e7, mass: 121.28}
support: {types: free}
foundation: {vertical_bed: {k: 1.0e8, c: 1.0e5}}
load: {forces: 2.0e5, positions: 5.0}
output: {probes: [38.0, 40.0, 42.5]}
)",
                         moving + Values{{"ts_max_time", "0.45"}});
  // The sleepers' mass (10 kg/m) and the flexibility of their bed, 1e-5 of the pads'.
  EXPECT_LT(relative_difference(track("/rail/deflection"), bed("/probes/deflection")), 2e-3);
}

// Whatever layer is left out, the ground and the supports carry the load.
TEST(LayeredTrack, LayersMayBeLeftOut) {
  const std::string base = R"(
beam: {spans: [12.0, 15.0], EI: 2.0e9, mass: 3000.0, continuity: simply_supported}
track:
  rail: {EI: 1.32476e7, mass: 121.28}
  spacing: 0.6
  offset: 0.17
  pad: {k: 6.5e7, c: 7.5e4}
  sleeper: {mass: 251.0}
  approach: 12.0
load: {forces: [1.0e5, 1.0e5, 1.0e5], positions: [-5.0, 7.0, 12.0], speed: 0.0}
scene: {analysis: static}
)";
  const Values ballast = {{"track_ballast_k", "1.3775e8"}, {"track_ballast_mass", "531.4"}};
  const Values subballast = {{"track_subballast_k", "7.75e7"}};
  for (const Values& layers : {Values{}, ballast, subballast, ballast + subballast}) {
    Results run = run_yaml(base, layers);
    const double support = run.column("/balance/support", 1)[0], ground = run.column("/balance/foundation", 1)[0];
    EXPECT_NEAR(support + ground, 3e5, 1e-3);
    EXPECT_GT(ground, 0.9e5);  // the first force stands on the ground
    EXPECT_GT(support, 1.5e5);
    // The first layers are softer the more there are of them.
    EXPECT_LT(peak(run("/rail/deflection")).first, -1e-4);
  }
}

// Isolated spans whose joints lie anywhere between two sleepers, all forces and energies.
TEST(LayeredTrack, ForcesAndEnergyBalanceOnSeparateSpans) {
  const std::string scene = track_of(r8_layers, R"(
  elements_per_bay: 2
beam: {spans: [20.0, 13.3, 20.0], EI: 5.0e10, mass: 1.0e4, continuity: [simply_supported, continuous], damping_ratios: 0.02}
load: {forces: [1.5e5, 1.5e5], positions: [0.0, -3.0], speed: 60.0}
ts: {dt: 5.0e-4}
output: {interval: 0.005, probes: [10.0, 26.0, 43.0]}
)");
  std::vector<double> before;
  for (const char* offset : {"0", "0.15", "0.31", "0.59"}) {
    Results run = run_yaml(scene, {{"track_offset", offset}});
    expect_balanced(run, 9.81 * 53.3 * 1e4);
    // The bridge hardly feels where the sleepers stand.
    const std::vector<double> here = run("/probes/deflection");
    if (!before.empty()) {
      EXPECT_LT(relative_difference(here, before), 1e-2);
    }
    before = here;
  }
  // Forces that run over the rail's nodes every half bay need short steps: the residual falls with their fourth power.
  Results fine_steps = run_yaml(scene, {{"ts_dt", "1.25e-4"}});
  EXPECT_LT(magnitude(fine_steps("/energy/residual")), 1e-6 * magnitude(fine_steps("/energy/dissipated")));
  Results coarse = run_yaml(scene), fine = run_yaml(scene, {{"track_elements_per_bay", "4"}});
  EXPECT_LT(relative_difference(coarse("/probes/deflection"), fine("/probes/deflection")), 1e-4);
}

// Braked wheels pull the rail along, the rail the bridge, at 1.5 m above its axis, and the bridge its bearing.
TEST(LayeredTrack, BrakingOnRailAndBridge) {
  Results run = run_scene("braking_train", {{"train_vehicles", "wagon*2"},
                                            {"track_rail_EI", "1.3e7"},
                                            {"track_rail_EA", "3.2e9"},
                                            {"track_rail_mass", "121"},
                                            {"track_spacing", "0.6"},
                                            {"track_pad_k", "1e8"},
                                            {"track_pad_c", "5e4"},
                                            {"track_sleeper_mass", "250"},
                                            {"track_longitudinal_k", "1.2e7"},
                                            {"track_longitudinal_c", "1e5"},
                                            {"track_approach", "60"},
                                            {"ts_max_time", "2.5"}});
  expect_balanced(run, 9.81 * 120 * 2e4);
  EXPECT_LT(magnitude(run("/energy/residual")), 1e-6 * magnitude(run("/energy/kinetic")));
  // The wheels' force along x goes into the bearing and, over the rail, into the ground beside the bridge.
  const double bearing = magnitude(run("/foundation/longitudinal/force"));
  EXPECT_GT(bearing, 1e4);
  EXPECT_LT(bearing, 4 * 8000.0 / 0.46);
  EXPECT_GT(magnitude(run("/rail/axial_force")), 1e3);
}

}  // namespace
}  // namespace traverse::test
