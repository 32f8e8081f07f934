// trains, loads, speeds below 0 and tables of speeds: what scenes become, and what is refused.
#include "scene_helpers.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::scene {
namespace {

using test::any_contains;

const std::string two_trains = beam_yaml + vehicle_yaml +
                               "trains: [up, down]\nup: {vehicles: car*2, spacing: 10, speed: 30}\n"
                               "down: {vehicles: car, speed: -25}\n";

TEST(SceneTrains, SeveralAreNumberedThrough) {
  const Scene s = scene_of(two_trains);
  ASSERT_EQ(s.train.courses.size(), 2u);
  EXPECT_EQ(s.train.courses[0].name, "up");
  EXPECT_EQ(s.train.courses[1].first, 2u);
  EXPECT_EQ(s.train.vehicles, (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(s.vehicles[1].name, "car") << "the same vehicle, mirrored";
  EXPECT_EQ(s.train.speed, 30.0);
  EXPECT_TRUE(s.train.driven());
  const std::vector<double> down = wheels_at_start(s, 2);
  EXPECT_NEAR(*std::min_element(down.begin(), down.end()), 80.0, 1e-12) << "the front wheel at the right end";
  EXPECT_TRUE(any_contains(s.notes, "runs: up at 30 m/s to the right; down at 25 m/s to the left"));
  EXPECT_TRUE(any_contains(s.notes, "parallel tracks"));
}

TEST(SceneTrains, OneAloneStaysAsItIs) {
  const Scene s = scene_of(beam_yaml + vehicle_yaml + "train: {vehicles: car, speed: 30}\n");
  EXPECT_TRUE(s.train.courses.empty());
  EXPECT_TRUE(s.train.driven());
  const Scene named = scene_of(beam_yaml + vehicle_yaml + "trains: up\nup: {vehicles: car, speed: 30}\n");
  EXPECT_TRUE(named.train.driven());
}

TEST(SceneTrains, LoadsRunEitherWay) {
  const Scene s = scene_of(beam_yaml + "loads: [a, b]\na: {forces: 1e5, speed: 20}\nb: {hslm_a: 1, speed: -30}\n");
  ASSERT_EQ(s.load.courses.size(), 2u);
  EXPECT_EQ(s.load.positions[0], 0.0);
  EXPECT_EQ(s.load.positions[1], 80.0);
  EXPECT_GT(s.load.positions[2], 80.0) << "further axles follow on the right";
}

TEST(SceneTrains, WhatStandsOnTheBridgeAtTheStartIsSaid) {
  const auto notes = [](const std::string& more) { return scene_of(beam_yaml + more).notes; };
  EXPECT_PRED2(any_contains, notes("load: {forces: 1e5*4, positions: [80, 30, 0, -9], speed: 20}\n"),
               "on the bridge at the start: 1 force; the run begins in the static equilibrium under them");
  EXPECT_PRED2(any_contains, notes(vehicle_yaml + "train: {vehicles: car, speed: 20, positions: 40}\n"),
               "on the bridge at the start: 1 wheel;");
  EXPECT_PRED2(any_contains, notes("load: {distributed: [1, 4, 1e4], speed: 20}\n"), "1 force;");
  EXPECT_PRED2(any_contains, notes("load: {forces: 1e5, speed: 0}\nts: {max_time: 1}\n"), "1 force;") << "at rest";
  EXPECT_FALSE(any_contains(notes("load: {forces: 1e5*2, positions: [0, -9], speed: 20}\n"), "at the start"));
  EXPECT_FALSE(any_contains(notes("load: {forces: 1e5, positions: 80, speed: -20}\n"), "at the start"));
}

TEST(SceneTrains, WhatIsRefused) {
  const test::TemporaryFolder folder;
  const std::string brake = folder.write("brake.csv", "0,20\n2,0\n"), both = folder.write("both.csv", "0,20\n2,-1\n");
  const auto refused = [](const std::string& more) {
    return test::message_of([&] { scene_of(beam_yaml + vehicle_yaml + more); });
  };
  const std::string train = "train: {vehicles: car, speed_file: " + brake;
  EXPECT_TRUE(test::contains(refused("trains: [up, beam]\nup: {vehicles: car, speed: 3}\n"), "group of options"));
  EXPECT_TRUE(test::contains(refused("trains: [up, x]\nup: {vehicles: car, speed: 3}\n"), "PETSc"));
  EXPECT_TRUE(test::contains(refused("trains: [up, up]\nup: {vehicles: car, speed: 3}\n"), "two options"));
  EXPECT_TRUE(test::contains(refused("trains: [up]\nup: {speed: 3}\n"), "up_vehicles: missing"));
  EXPECT_TRUE(test::contains(refused("trains: [up]\nup: {vehicles: car}\n"), "up_speed is missing"));
  EXPECT_TRUE(test::contains(refused("trains: [up]\ntrain: {speed: 3}\nup: {vehicles: car}\n"), "train_speed"));
  EXPECT_TRUE(test::contains(refused(train + ", speed: 3}\n"), "either this or train_speed"));
  EXPECT_TRUE(test::contains(refused(train + ", drive: free}\n"), "train_drive free"));
  EXPECT_TRUE(test::contains(refused("train: {vehicles: car, speed_file: " + both + "}\n"), "both signs"));
  EXPECT_TRUE(test::contains(refused("train: {vehicles: car, speed: 3, speed_over: position}\n"), "train_speed_file"));
  EXPECT_TRUE(test::contains(refused(train + "}\nsweep: {speed: [20, 30, 5]}\n"), "constant speed"));
  EXPECT_TRUE(test::contains(
      refused(two_trains.substr(beam_yaml.size() + vehicle_yaml.size()) + "scene: {analysis: envelope}\n"),
      "one train or load"));
  EXPECT_TRUE(test::contains(refused(two_trains.substr(beam_yaml.size() + vehicle_yaml.size()) +
                                     "track: {rail: {EI: 1e7, mass: 120}, spacing: 0.6, pad: {k: 6e7}}\n"),
                             "further rails"));
}

}  // namespace
}  // namespace traverse::scene
