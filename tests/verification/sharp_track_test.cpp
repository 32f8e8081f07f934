// Wheels on tracks sharper than themselves: the roll-over curve, rest in a valley, energy where points come and go.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double R = 0.46, mass = 1000.0, g = 9.81;

double range(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

// A wheelset that comes to a bump of 10 mm on 0.1 m at x = 1.
constexpr const char* sharp_bump = R"(
vehicle:
  axle:
    bodies: [axle]
    wheels: [wheel]
    drivers: [level]
    axle:  {mass: 1000.0, inertia: 100.0, position: [0.0, 0.46]}
    level: {body: axle, coordinate: phi}
    wheel: {body: axle, radius: 0.46, law: linear, stiffness: 2.0e9, damping: 1.0e6}
train: {vehicles: axle, positions: 0.85, speed: 0.02}
track: {profile: bump, bump: {start: 1.0, length: 0.1, height: 0.01}}
ts: {max_time: 20.0, dt: 2.0e-3}
output: {interval: 0.05}
)";

// The highest of the circles' centres that touch somewhere: the exact curve of a hard wheel.
double roll_over(double x) {
  const auto h = [](double s) {
    return s < 1.0 || s > 1.1 ? 0.0 : 0.005 * (1.0 - std::cos(2.0 * pi * (s - 1.0) / 0.1));
  };
  const auto e = [&](double s) { return h(s) + std::sqrt(R * R - (s - x) * (s - x)); };
  double best = x, step = 1e-3;
  for (double s = x - 0.2; s < x + 0.2; s += step)
    if (e(s) > e(best)) best = s;
  for (; step > 1e-9; step *= 0.3)
    for (double s : {best - step, best - 0.5 * step, best + 0.5 * step, best + step})
      if (e(s) > e(best)) best = s;
  return e(best);
}

TEST(SharpTrack, CentreFollowsTheRollOverCurve) {
  Results run = run_yaml(sharp_bump);
  const std::vector<double> x = run.column("/vehicles/0/axle/position", 0),
                            y = run.column("/vehicles/0/axle/position", 1);
  double worst = 0.0, top = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double exact = roll_over(x[i]) - mass * g / 2.0e9;
    worst = std::max(worst, std::abs(y[i] - exact));
    top = std::max(top, exact - R);
  }
  RecordProperty("worst_over_height", text(worst / 0.01));
  EXPECT_NEAR(top, 0.01, 1e-4);
  EXPECT_LT(worst, 0.002 * 0.01);
  EXPECT_NEAR(range(run("/vehicles/0/wheel/penetration")), 0.0, 2e-5);
}

// Without damping; one soft enough to overlap the valleys at the feet, one that leaves the ground.
TEST(SharpTrack, EnergyBalances) {
  for (const char* stiffness : {"5e6", "2e8"}) {
    for (const char* height : {"0.01", "0.002"}) {
      Results run = run_yaml(sharp_bump, {{"vehicle_axle_wheel_stiffness", stiffness},
                                          {"vehicle_axle_wheel_damping", "0"},
                                          {"track_bump_height", height},
                                          {"train_speed", "0.5"},
                                          {"ts_max_time", "0.8"},
                                          {"ts_dt", "1e-4"},
                                          {"output_interval", "0.01"}});
      const double scale = range(run("/energy/potential")) + range(run("/energy/kinetic"));
      RecordProperty(std::string("residual_over_scale_") + stiffness + "_" + height,
                     text(std::abs(peak(run("/energy/residual")).first) / scale));
      EXPECT_GT(scale, 5.0);
      EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 1e-4 * scale) << stiffness << " N/m, " << height << " m";
    }
  }
}

// The same bump on a bridge: as on the ground where the bridge hardly moves.
TEST(SharpTrack, OnABridge) {
  const std::string beam = "beam: {spans: 2.0, elements_per_span: 3, EI: 1.0e13, mass: 1.0e5}\n";
  const Values quick = {{"train_speed", "0.1"}, {"ts_max_time", "3"}, {"ts_dt", "1e-3"}, {"output_interval", "0.01"}};
  Results on_bridge = run_yaml(beam + sharp_bump, quick), on_ground = run_yaml(sharp_bump, quick);
  EXPECT_LT(relative_difference(on_bridge("/vehicles/0/axle/position"), on_ground("/vehicles/0/axle/position")), 1e-6);
  EXPECT_LT(
      relative_difference(on_bridge("/vehicles/0/wheel/normal_force"), on_ground("/vehicles/0/wheel/normal_force")),
      1e-2);
}

// A soft bridge: forces on it and on the wheel are the same, where the wheel touches it at two points.
TEST(SharpTrack, EnergyBalancesOnASoftBridge) {
  const std::string beam = "beam: {spans: 2.0, elements_per_span: 8, EI: 2.0e5, EA: 1.0e9, mass: 500.0}\n";
  Results run = run_yaml(beam + sharp_bump, {{"vehicle_axle_wheel_stiffness", "2e7"},
                                             {"vehicle_axle_wheel_damping", "0"},
                                             {"track_bump_height", "0.004"},
                                             {"train_speed", "0.5"},
                                             {"ts_max_time", "0.8"},
                                             {"ts_dt", "1e-4"},
                                             {"output_interval", "0.01"}});
  const double scale = range(run("/energy/potential")) + range(run("/energy/kinetic")) + range(run("/energy/strain"));
  RecordProperty("residual_over_scale", text(std::abs(peak(run("/energy/residual")).first) / scale));
  EXPECT_GT(scale, 5.0);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 1e-4 * scale);
}

// Held over the middle of a valley, h = sqrt(a^2 + (s x)^2): both sides carry, each W/(2 cos(angle)).
TEST(SharpTrack, AtRestInAValley) {
  const double a = 0.009, s = 0.3;
  std::string rows;
  for (int i = -300; i <= 300; ++i) {
    const double x = 0.002 * i;
    rows += text(x) + ", " + text(std::hypot(a, s * x)) + "\n";
  }
  const TemporaryFolder folder;
  const std::string file = folder.write("valley.csv", rows);
  std::string scene = sharp_bump;
  const std::string bump = "track: {profile: bump, bump: {start: 1.0, length: 0.1, height: 0.01}}\n";
  scene.erase(scene.find(bump), bump.size());
  Results run = run_yaml(scene, {{"track_profile", file},
                                 {"train_positions", "0"},
                                 {"train_speed", "0"},
                                 {"vehicle_axle_wheel_stiffness", "1e11"},
                                 {"ts_max_time", "0.002"},
                                 {"ts_dt", "1e-3"},
                                 {"output_interval", "1e-3"}});
  double low = 0.01, high = std::atan(s);  // h' = tan(angle) at x = R sin(angle)
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), x = R * std::sin(middle);
    (s * s * x / std::hypot(a, s * x) > std::tan(middle) ? low : high) = middle;
  }
  const std::vector<double> force = run("/vehicles/0/wheel/normal_force");
  RecordProperty("force_over_statics", text(force.back() * std::cos(low) / (mass * g)));
  for (double f : force) EXPECT_NEAR(f * std::cos(low) / (mass * g), 1.0, 1e-5);
}

}  // namespace
}  // namespace traverse::test
