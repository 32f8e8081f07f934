// Dips and welds on top of a rough track: the surface is the sum of both, in single runs and in those side by side.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/quarter_car.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/track/profile.hpp"

namespace traverse::test {
namespace {

const std::string quarter_car = quarter_car_with(9000.0, 1200.0, 2e6, 2e4, "law: linear, stiffness: 1.0e9") + R"(
train: {vehicles: car, positions: 0.0, speed: 30.0}
track: {profile: german_low, wavelengths: [3.0, 50.0]}
ts: {dt: 2.0e-4}
)";
const Values weld = {{"track_dips_x", "33"}, {"track_dips_length", "2"}, {"track_dips_depth", "2e-4"}};

/// Lines x,height of a smooth track from -1 to 60 m, a spline through which is 1e-9 m off.
std::string table_of(const track::Profile& profile) {
  std::string lines;
  for (int i = -100; i <= 6000; ++i) lines += fmt::format("{},{}\n", 0.01 * i, profile.at(0.01 * i).value);
  return lines;
}

TEST(Dips, OnARoughTrackAreTheirSum) {
  const TemporaryFolder folder;
  const track::Profile rough = track::Profile::rough(track::german(false), 3.0, 50.0, 0.0, 1);
  const std::string file = folder.write("sum.csv", table_of(rough.with({33.0, 2.0, 2e-4, false})));
  const Values times = {{"ts_max_time", "1.5"}, {"output_interval", "1e-3"}};
  const auto forces = [&](const Values& track) {
    return run_yaml(quarter_car, times + track)("/vehicles/0/wheel/normal_force");
  };
  const std::vector<double> both = forces(weld), alone = forces({}),
                            table = forces({{"track_profile", file}, {"track_profile_shape", "spline"}});
  const double error = relative_difference(both, table);
  RecordProperty("error", text(error));
  EXPECT_LT(error, 1e-5);
  EXPECT_GT(relative_difference(both, alone), 1e-2) << "the weld is felt";
}

// Every seed of a study has the dips.
TEST(Dips, OnEveryRoughTrackOfAStudy) {
  const std::string scene = quarter_car + R"(
beam: {spans: 20.0, EI: 8.0e9, mass: 5000.0, damping_ratios: 0.02}
support: {types: [pinned, roller]}
model: {modes: 6, vehicles: linear}
study: {vary: {track_seed: [1, 5]}}
output: {probes: 10.0}
)";
  const Values dips = {{"track_dips_x", "4,12"}, {"track_dips_length", "1,1.6"}, {"track_dips_depth", "1e-4"}};
  Results beside = run_yaml(scene, dips), each = run_yaml(scene, dips + Values{{"sweep_lanes", "0"}}),
          without = run_yaml(scene);
  for (const char* name : {"/study/greatest_wheel_force", "/study/least_wheel_force"}) {
    // Side by side contacts take the first power of slopes.
    EXPECT_LT(relative_difference(beside(name), each(name)), 5e-6) << name;
    for (const std::size_t run : {0U, 1U})
      EXPECT_GT(std::abs(beside(name)[run] - without(name)[run]), 1e-5 * without(name)[run]) << name;
  }
  EXPECT_NE(beside("/study/greatest_wheel_force")[0], beside("/study/greatest_wheel_force")[1]) << "tracks differ";
}

}  // namespace
}  // namespace traverse::test
