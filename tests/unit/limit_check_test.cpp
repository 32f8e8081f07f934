// Runs that are judged by limits, and the filtered peaks that these need.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "run/low_pass.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

constexpr double span = 20.0, EI = 1.0e10, mass = 1.0e4, speed = 40.0;
const char* const two_decks = R"(
beam: {spans: [20.0, 20.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 8}
beam_continuity: simply_supported
support: {types: [pinned, roller, roller]}
load: {forces: [1.0e5, 1.0e5], positions: [0.0, -9.0], speed: 40.0}
ts_dt: 1.0e-3
scene: {tail: 0.5}
output: {interval: 1.0e-3, probes: [10.0, 25.0]}
)";

double largest(const std::vector<double>& values) { return std::abs(peak(values).first); }

// The series at the stored samples is the filter's, and its peak is that of /summary; the frequency is the norm's.
TEST(DeckAcceleration, IsStoredWithItsPeak) {
  Results run = run_yaml(two_decks, {{"output_lowpass_series", "true"}, {"beam_elements_per_span", "16"}});
  const double f1 = std::numbers::pi / 2.0 * std::sqrt(EI / mass) / (span * span);
  const double counts = run.attribute("/summary", "acceleration_lowpass_frequency");
  EXPECT_NEAR(counts, 9.0 * f1, 1e-3 * 9.0 * f1);  // f3, of the distinct ones: each deck has its own
  double greatest = 0.0;
  for (const std::size_t probe : {0, 1}) {
    std::vector<double> series = run.column("/probes/acceleration", probe);
    run::LowPass(counts, 1e-3).apply(series);
    EXPECT_LT(relative_difference(run.column("/probes/acceleration_lowpass", probe), series), 1e-12);
    greatest = std::max(greatest, largest(series));
  }
  const double found = std::abs(run.attribute("/summary", "acceleration_lowpass"));
  EXPECT_GE(found, greatest * (1.0 - 1e-12));
  EXPECT_LE(found, greatest * 1.02);  // a parabola goes between the instants
}

// The peak does not depend on how seldom samples are stored, for steps are looked at between them.
TEST(DeckAcceleration, DoesNotDependOnWhatIsStored) {
  const auto found = [](const char* interval) {
    Results run = run_yaml(two_decks, {{"output_interval", interval}, {"output_lowpass", "30"}});
    return run.attribute("/summary", "acceleration_lowpass");
  };
  EXPECT_NEAR(found("0.05"), found("1e-3"), 1e-2 * std::abs(found("1e-3")));
}

/// The limits of a file as a run is judged by them.
Results judged(const std::string& limits, const Values& options = {}, const char* scene = two_decks) {
  const TemporaryFolder folder;
  Values all = {{"limits", folder.write("limits.yml", limits)}};
  all.insert(all.end(), options.begin(), options.end());
  return run_yaml(scene, all);
}

TEST(Verdicts, FollowFromWhatIsStored) {
  Results run = judged(
      "- {clause: A, quantity: deflection_over_span, value: 1/600}\n"
      "- {clause: B, quantity: unfiltered_deck_acceleration, value: 1.0e-3}\n"
      "- {clause: C, quantity: deck_acceleration, value: 3.5}\n"
      "- {clause: D, quantity: amplification, value: 2}\n"
      "- {clause: E, quantity: car_acceleration, value: 1}\n");
  const std::vector<double> value = run("/verdicts/value"), limit = run("/verdicts/limit"),
                            margin = run("/verdicts/margin"), time = run("/verdicts/time");
  ASSERT_EQ(value.size(), 5u);
  EXPECT_NEAR(value[0], std::abs(run.attribute("/summary", "deflection")) / span, 1e-15);
  EXPECT_DOUBLE_EQ(limit[0], 1.0 / 600.0);
  EXPECT_DOUBLE_EQ(margin[0], 1.0 - value[0] * 600.0);
  EXPECT_DOUBLE_EQ(time[0], run.attribute("/summary", "deflection_time"));
  EXPECT_DOUBLE_EQ(value[1], std::abs(run.attribute("/summary", "acceleration")));
  EXPECT_LT(margin[1], 0.0);
  EXPECT_DOUBLE_EQ(value[2], std::abs(run.attribute("/summary", "acceleration_lowpass")));
  EXPECT_DOUBLE_EQ(value[3], run.attribute("/summary", "amplification"));
  EXPECT_TRUE(std::isnan(value[4]) && std::isnan(margin[4]) && std::isnan(time[4]));  // there is no vehicle
}

// A force that creeps over two decks: P L^2/(9 sqrt(3) EI) at the right end when it is L/sqrt(3) from the left end of
// the last deck, and P L^2/(16 EI), its slope at midspan, is exceeded by no more than that.
TEST(Verdicts, RotationsAtEndsAndJointsAreThoseOfStatics) {
  const double P = 1.0e5, most = P * span * span / (9.0 * std::sqrt(3.0) * EI);
  Results run = judged(
      "- {clause: A, quantity: end_rotation, value: 6.5e-3}\n"
      "- {clause: B, quantity: joint_rotation, value: 1.0e-2}\n",
      {{"load_forces", "1e5"},
       {"load_positions", "0"},
       {"load_speed", "0.5"},
       {"ts_dt", "0.01"},
       {"output_interval", "0.05"},
       {"output_lowpass", "none"}});
  for (const double value : run("/verdicts/value")) EXPECT_NEAR(value, most, 1e-2 * most);
}

// A wheel that a driven body holds at rest loses nothing; its car does not move up or down on rigid ground.
TEST(Verdicts, OfVehicles) {
  Results run = judged(
      "- {clause: A, quantity: wheel_unloading, value: 0.6}\n"
      "- {clause: B, quantity: car_acceleration, value: 1}\n"
      "- {clause: C, quantity: contact_loss, value: 1e-3}\n"
      "- {clause: D, quantity: deck_acceleration, value: 3.5}\n",
      {{"ts_max_time", "0.3"}}, R"(
vehicle:
  car:
    bodies: [axle]
    wheels: [wheel]
    axle:  {mass: 1000.0, inertia: 100.0, position: [0.0, 0.5]}
    wheel: {body: axle, radius: 0.5, law: linear, stiffness: 1.0e8}
track: {profile: bump, bump: {start: 1.0, length: 2.0, height: 0.002}}
train: {vehicles: car, positions: 0.0, speed: 20.0}
ts_dt: 2.0e-4
output_interval: 2.0e-4
)");
  const std::vector<double> value = run("/verdicts/value");
  const std::vector<double> force = run.column("/vehicles/0/wheel/normal_force");
  const std::vector<double> motion = run("/vehicles/0/axle/acceleration");
  double up = 0.0;
  for (std::size_t i = 1; i < motion.size(); i += 3) up = std::max(up, std::abs(motion[i]));
  // Between steps the force is of fourth degree.
  const auto middle = std::min_element(force.begin(), force.end());
  double least = *middle;
  for (double s = -1.0; s < 1.0; s += 1e-4) {
    double sum = 0.0;
    for (int i = -2; i <= 2; ++i) {
      double weight = 1.0;
      for (int j = -2; j <= 2; ++j)
        if (j != i) weight *= (s - j) / (i - j);
      sum += weight * middle[i];
    }
    least = std::min(least, sum);
  }
  EXPECT_NEAR(value[0], 1.0 - least / force.front(), 1e-9);
  EXPECT_GT(value[0], 0.1);
  EXPECT_NEAR(value[1], up, 1e-9 * up);
  EXPECT_DOUBLE_EQ(value[2], 0.0);
  EXPECT_TRUE(std::isnan(value[3]));  // no bridge
}

TEST(Verdicts, BadFilesAreRefused) {
  EXPECT_THROW(judged("- {clause: A, quantity: nothing, value: 1}\n"), InputError);
  EXPECT_THROW(run_yaml(two_decks, {{"limits", "/no/such/file.yml"}}), InputError);
  EXPECT_THROW(run_yaml(two_decks, {{"output_lowpass", "-3"}}), InputError);
  EXPECT_THROW(run_yaml(two_decks, {{"output_lowpass", "low"}}), InputError);
}

}  // namespace
}  // namespace traverse::test
