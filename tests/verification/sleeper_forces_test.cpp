// What sleepers carry: a train at rest stands on all pads, and a force in motion against a model that is assembled
// densely and integrated by another method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/curve.hpp"
#include "support/quarter_car.hpp"
#include "support/scene_run.hpp"
#include "support/short_bridge.hpp"

namespace traverse::test {
namespace {

std::string every_sleeper() {
  std::string stations;
  for (int i = 0; i <= 32; ++i) stations += (i > 0 ? "," : "") + std::to_string(-6.0 + 0.6 * i);
  return stations;
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

const std::string standing_train =
    short_bridge_scene + quarter_car_with(9000.0, 1200.0, 2e6, 2e4, "law: linear, stiffness: 1.0e9") + R"(
train: {vehicles: "car*3", positions: [7.9, 3.13, -2.0], speed: 0.0}
scene: {analysis: static}
)";

// At rest each sleeper is in equilibrium, and all of them together carry the train: whatever lies below them, and over
// gaps too.
TEST(SleeperForces, CarryAStandingTrain) {
  const Values gaps = {
      {"track_stretches", "hung"}, {"track_hung_from", "-3"}, {"track_hung_to", "6"}, {"track_hung_gap", "2e-4"}};
  const Values own_mass = {{"track_ballast_own_mass", "true"}, {"track_shear_k", "1.5e8"}};
  for (const Values& values : {Values{}, gaps, own_mass, own_mass + gaps,
                               Values{{"track_stretches", "weak"},
                                      {"track_weak_from", "2"},
                                      {"track_weak_to", "4"},
                                      {"track_weak_pad_k", "1e6"}}}) {
    Results run = run_yaml(standing_train, values + Values{{"output_sleepers", every_sleeper()}});
    const std::vector<double> pad = run("/track/sleepers/pad_force"), ballast = run("/track/sleepers/ballast_force");
    constexpr double weight = 3.0 * 9.81 * 10200.0 + 1e5;
    ASSERT_EQ(pad.size(), 33U);
    EXPECT_NEAR(sum_of(pad), weight, 1e-7 * weight);
    for (std::size_t i = 0; i < pad.size(); ++i) EXPECT_NEAR(pad[i], ballast[i], 1e-7 * weight) << i;
    EXPECT_GT(peak(pad).first, 1e4);
  }
}

// Without ballast the pads stand on bridge and ground themselves.
TEST(SleeperForces, WithoutBallast) {
  Results run = run_yaml(R"(
beam: {spans: 7.2, EI: 4.0e9, mass: 5000.0}
track: {rail: {EI: 1.3e7, mass: 121.0}, spacing: 0.6, pad: {k: 1.3e8}, sleeper: {mass: 251.0}, approach: 6.0}
load: {forces: [1.0e5, 8.0e4], positions: [5.05, -1.3], speed: 0.0}
scene: {analysis: static}
)",
                         {{"output_sleepers", every_sleeper()}});
  EXPECT_NEAR(sum_of(run("/track/sleepers/pad_force")), 1.8e5, 1e-7 * 1.8e5);
  EXPECT_THROW(run("/track/sleepers/ballast_force"), std::runtime_error);
}

// Before, on and behind the bridge, and where three sleepers hang, whose forces are stored with their gaps too.
TEST(SleeperForces, OfAMovingForceAgainstAnotherIntegration) {
  const std::vector<double> stations = {-1.8, 3.6, 4.2, 9.0};
  Results run = run_yaml(short_bridge_scene, {{"track_stretches", "hung"},
                                              {"track_hung_from", "-2.4"},
                                              {"track_hung_to", "-1.2"},
                                              {"track_hung_gap", "2e-4"},
                                              {"ts_dt", "1e-4"},
                                              {"ts_max_time", "0.42"},
                                              {"output_interval", "2e-3"},
                                              {"output_sleepers", "-1.8,3.5,4.2,9.1"}});
  ASSERT_EQ(run("/track/sleepers/x").size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(run("/track/sleepers/x")[i], stations[i], 1e-12);
  const DenseTrackModel m(by_hand(short_bridge(2), [](DenseSleeper& s) {
    if (within(s.x, -2.4, -1.2)) s.gap = 2e-4;
  }));
  constexpr double h = 2e-5, speed = 30.0;
  DenseNewmark motion(m.M, m.C, m.K, m.gaps, h);
  motion.start(m.K.llt().solve(1e5 * m.force_at(-5.0)), 1e5 * m.force_at(-5.0));
  const std::vector<double> time = run.time(), pad = run("/track/sleepers/pad_force"),
                            ballast = run("/track/sleepers/ballast_force");
  const TrackLayers& layers = zhai_layers;
  double worst_pad = 0.0, worst_ballast = 0.0, greatest = 0.0;
  std::size_t sample = 0;
  for (int i = 0; sample < time.size(); ++i) {
    if (i > 0) motion.step(1e5 * m.force_at(-5.0 + speed * i * h));
    if (i * h < time[sample] - 0.5 * h) continue;
    for (std::size_t j = 0; j < 4; ++j) {
      const int number = static_cast<int>(std::lround((stations[j] + 6.0) / 0.6));
      const Eigen::VectorXd sleeper = Eigen::VectorXd::Unit(m.size(), m.sleeper(number));
      const Eigen::VectorXd rail = Eigen::VectorXd::Unit(m.size(), m.rail(2 * number));
      const Eigen::VectorXd below =
          within(stations[j], 0.0, 7.2) ? m.bridge_at(stations[j]) : Eigen::VectorXd::Unit(m.size(), m.ballast(number));
      const auto pressed = [&](double k, double c, const Eigen::VectorXd& gap) {
        return k * gap.dot(motion.v) + c * gap.dot(motion.w);
      };
      const double in_pad = pressed(layers.pad_k, layers.pad_c, sleeper - rail);
      const double in_ballast = j == 0 ? motion.force[1] : pressed(layers.ballast_k, layers.ballast_c, below - sleeper);
      worst_pad = std::max(worst_pad, std::abs(pad[4 * sample + j] - in_pad));
      worst_ballast = std::max(worst_ballast, std::abs(ballast[4 * sample + j] - in_ballast));
      greatest = std::max(greatest, in_pad);
    }
    EXPECT_EQ(ballast[4 * sample], run("/track/hanging/force")[3 * sample + 1]);
    ++sample;
  }
  EXPECT_GT(greatest, 2e4);
  EXPECT_LT(worst_pad, 1e-3 * greatest);
  EXPECT_LT(worst_ballast, 1e-3 * greatest);
  RecordProperty("pad_error", text(worst_pad / greatest));
  RecordProperty("ballast_error", text(worst_ballast / greatest));
}

}  // namespace
}  // namespace traverse::test
