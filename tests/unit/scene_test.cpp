// read_scene: what a scene's options become, and what is refused.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene_helpers.hpp"
#include "support/folders.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::scene {
namespace {

using test::any_contains;

TEST(SceneBeam, ReadsAndFillsIn) {
  const Scene s = scene_of(beam_yaml + "load: {forces: 1e5, speed: 30}\n");
  ASSERT_TRUE(s.beam);
  EXPECT_EQ(s.beam->spans, (std::vector<double>{25.0, 30.0, 25.0}));
  EXPECT_EQ(s.beam->elements, (std::vector<int>(3, 10)));
  EXPECT_EQ(s.beam->supports.front(), beam::Support::pinned);
  EXPECT_EQ(s.beam->supports.back(), beam::Support::roller);
  EXPECT_FALSE(s.beam->axial);
  EXPECT_EQ(s.output.probes, (std::vector<double>{12.5, 40.0, 67.5}));
  EXPECT_EQ(s.output.file, "results/scene.h5");
  EXPECT_TRUE(s.mesh_open);
  EXPECT_EQ(s.gravity, 9.81);
}

TEST(SceneBeam, ElementsFollowFromTheAccuracy) {
  const auto elements = [](const std::string& accuracy) {
    return scene_with({{"accuracy", accuracy}}).beam->elements.front();
  };
  EXPECT_EQ(elements("1e-1"), 4);
  EXPECT_EQ(elements("1e-3"), 10);
  EXPECT_EQ(elements("1e-4"), 18);
  EXPECT_EQ(elements("1e-7"), 100);
  EXPECT_EQ(scene_with({{"beam_elements_per_span", "2,3,4"}}).beam->elements, (std::vector<int>{2, 3, 4}));
}

TEST(SceneBeam, TablesInFiles) {
  const test::TemporaryFolder folder;
  const std::string good = folder.write("ei.csv", "0, 8e9\n40, 9e9\n40, 10e9\n80, 10e9\n");
  const Scene s = scene_with({{"beam_EI", good}});
  EXPECT_DOUBLE_EQ(s.beam->EI.at(20.0, 10.0), 8.5e9);
  EXPECT_DOUBLE_EQ(s.beam->EI.at(40.0, 50.0), 10e9);
  EXPECT_PRED2(contains, refused_with("beam_EI", folder.write("bad.csv", "0 1\n80 -1\n")), "above 1e-07");
  EXPECT_PRED2(contains, refused_with("beam_EI", folder.write("down.csv", "0 1\n80 1\n40 1\n")), "down.csv");
}

TEST(SceneBeam, Foundation) {
  const Scene s = scene_of(beam_yaml +
                           "foundation:\n  vertical: {x: [5.0, 10.0], k: 1e7, c: [1e4, 2e4]}\n"
                           "  vertical_bed: {k: 1e7}\n  rotational: {x: [0, 80], k: 1e9}\n"
                           "load: {forces: 1e5, speed: 30}\n");
  const beam::Foundation& f = s.beam->foundation;
  ASSERT_EQ(f.vertical.size(), 2u);
  EXPECT_EQ(f.vertical[1].k, 1e7);
  EXPECT_EQ(f.vertical[1].c, 2e4);
  ASSERT_TRUE(f.vertical_bed);
  EXPECT_EQ(f.vertical_bed->c.maximum(), 0.0);
  EXPECT_EQ(f.rotational.size(), 2u);
  EXPECT_TRUE(f.longitudinal.empty());
}

TEST(SceneBeam, FoundationsThatAreNotLinear) {
  const Scene s = scene_of(R"(
beam: {spans: [40.0, 40.0], EI: 8.33e9, mass: 2303.0, continuity: simply_supported, hinges: 20.0}
foundation:
  vertical: {x: [5.0, 40.0, 40.0, 40.0], k: 1e7, gap: [0, 1e-3, 0, 0], one_sided: [true, false, false, true], side: [right, right, left, both]}
  vertical_bed: {k: 1e7, one_sided: true, gap: 1e-3, cubic: 1e9}
  rotational: {x: 20.0, cubic: 1e9, side: left}
load: {forces: 1e5, speed: 30}
)");
  const beam::Foundation& f = s.beam->foundation;
  ASSERT_EQ(f.vertical.size(), 5u);
  const bool one_sided[] = {true, false, false, true, true}, left[] = {false, false, true, true, false};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(f.vertical[i].law.one_sided, one_sided[i]);
    EXPECT_EQ(f.vertical[i].from_left, left[i]);
    EXPECT_EQ(f.vertical[i].law.gap, i == 1 ? 1e-3 : 0.0);
    EXPECT_EQ(f.vertical[i].k, 1e7);
    EXPECT_EQ(f.vertical[i].law.nonlinear(), i != 2);
  }
  EXPECT_TRUE(f.vertical_bed->law.one_sided);
  EXPECT_EQ(f.vertical_bed->law.gap, 1e-3);
  EXPECT_EQ(f.vertical_bed->law.cubic, 1e9);
  EXPECT_EQ(f.rotational.at(0).law.cubic, 1e9);
  EXPECT_TRUE(f.rotational[0].from_left);
  EXPECT_TRUE(f.nonlinear());
  const beam::Foundation small = beam::linearised(*s.beam).foundation;
  EXPECT_FALSE(small.nonlinear());
  EXPECT_FALSE(small.vertical_bed);
  EXPECT_EQ(small.vertical[0].k, 1e7);
  EXPECT_EQ(small.vertical[1].k, 0.0);
}

TEST(SceneBeam, Refusals) {
  EXPECT_PRED2(contains, refused_with("foundation_vertical_k", "1e7"), "foundation_vertical_x");
  EXPECT_PRED2(contains, refused_with("foundation_vertical_x", "5"), "foundation_vertical_k");
  EXPECT_PRED2(contains, refused_with("output_probes", "81"), "from 0 to 80 m");
  EXPECT_PRED2(contains, refused_with("support_types", "pinned,roller"), "one, or 4");
  EXPECT_PRED2(contains, refused_with("beam_elements_per_span", "1,2"), "one, or 3");
  EXPECT_PRED2(contains, refused_with("beam_damping_frequencies", "1,2"), "beam_damping_ratios");
  EXPECT_PRED2(contains, refused("beam: {spans: 25, EI: 1e9}\nload: {forces: 1, speed: 1}\n"), "beam_mass is missing");
  EXPECT_PRED2(contains, refused("beam: {EI: 1e9}\n"), "beam_spans");
  EXPECT_PRED2(contains, refused(beam_yaml + "beam_rayleigh: [0.1, 0]\nbeam_damping_ratios: 0.02\n"), "either");
}

TEST(SceneTrain, PositionsAndSpacing) {
  EXPECT_EQ(
      scene_with({{"train_vehicles", "car*3"}, {"train_positions", "-5"}, {"train_spacing", "10,20"}}).train.positions,
      (std::vector<double>{-5.0, -15.0, -35.0}));
  EXPECT_EQ(scene_with({{"train_vehicles", "car*3"}, {"vehicle_car_length", "12"}}).train.positions,
            (std::vector<double>{-0.5, -12.5, -24.5}));
  EXPECT_PRED2(contains, refused_with("train_positions", "1,2"), "one per vehicle");
  EXPECT_PRED2(contains, message_of([] { scene_with({{"train_vehicles", "car*3"}}); }), "train_spacing: missing");
  EXPECT_PRED2(contains, refused_with("train_vehicles", "cat"), "did you mean car?");
  EXPECT_PRED2(contains, refused(beam_yaml + vehicle_yaml), "train_speed is missing");
  EXPECT_EQ(scene_of(beam_yaml + vehicle_yaml + "train_speed: 3\n").train.vehicles.size(), 1u)
      << "the one vehicle defined is the train";
}

TEST(SceneTrain, OneTypeForEqualVehicles) {
  const Scene s = scene_with({{"train_vehicles", "car*8"}, {"train_spacing", "10"}});
  EXPECT_EQ(s.vehicles.size(), 1u);
  EXPECT_EQ(s.train.vehicles, (std::vector<int>(8, 0)));
}

// 2N + 14 axles, from the first to the last 375.5 to 398.5 m: power cars 3-11-3 m, 3.525 m to the outer bogies,

// bogies shared by two coaches (EN 1991-2, table 8.4 and figure 8.12).

TEST(SceneLoad, HslmTrains) {
  struct Type {
    int coaches;
    double length, bogie, force;
  };
  constexpr Type types[] = {{18, 18, 2.0, 170e3}, {17, 19, 3.5, 200e3}, {16, 20, 2.0, 180e3}, {15, 21, 3.0, 190e3},
                            {14, 22, 2.0, 170e3}, {13, 23, 2.0, 180e3}, {13, 24, 2.0, 190e3}, {12, 25, 2.5, 190e3},
                            {11, 26, 2.0, 210e3}, {11, 27, 2.0, 210e3}};
  for (int train = 1; train <= 10; ++train) {
    const Scene s = scene_of(beam_yaml + "load: {speed: 30, hslm_a: " + std::to_string(train) + "}\n");
    const auto [coaches, length, bogie, force] = types[train - 1];
    const double to_shared = length - 1.7625 - 1.5 * bogie;
    std::vector<double> gaps = {3.0, 11.0, 3.0, 3.525, bogie, to_shared};
    for (int i = 0; i < coaches; ++i) gaps.insert(gaps.end(), {bogie, length - bogie});
    gaps.insert(gaps.end(), {bogie, to_shared, bogie, 3.525, 3.0, 11.0, 3.0});
    const std::vector<double>& x = s.load.positions;
    ASSERT_EQ(x.size(), static_cast<std::size_t>(2 * coaches + 14));
    ASSERT_EQ(x.size(), gaps.size() + 1);
    EXPECT_EQ(s.load.forces, (std::vector<double>(x.size(), force)));
    EXPECT_EQ(x.front(), 0.0);
    for (std::size_t i = 0; i < gaps.size(); ++i) EXPECT_NEAR(x[i] - x[i + 1], gaps[i], 1e-9) << train << ", " << i;
    EXPECT_NEAR(-x.back(), 37.525 + (coaches + 2) * length, 1e-9) << train;
    EXPECT_GE(-x.back(), 375.5);
    EXPECT_LE(-x.back(), 398.55);
  }
  // A1 by hand: D = 18, d = 2; power car, end coach's bogie, the first bogie between coaches
  const Scene a1 = scene_of(beam_yaml + "load: {speed: 30, hslm_a: 1, positions: -2}\n");
  const double by_hand[] = {-2.0, -5.0, -16.0, -19.0, -22.525, -24.525, -37.7625, -39.7625, -55.7625};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(a1.load.positions[static_cast<std::size_t>(i)], by_hand[i], 1e-9);
  EXPECT_NEAR(a1.load.positions.back(), -2.0 - 397.525, 1e-9);
}

TEST(SceneLoad, ForcesAndRefusals) {
  const Scene s = scene_of(beam_yaml + "load: {forces: 2e5, positions: [0, -3], speed: 30}\n");
  EXPECT_EQ(s.load.forces, (std::vector<double>{2e5, 2e5}));
  EXPECT_PRED2(contains, refused("load: {forces: 1, speed: 1}\n"), "beam_spans");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: [1, 2], speed: 1}\n"), "load_positions: missing");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: [1, 2], positions: [1, 2, 3], speed: 1}\n"),
               "one, or 3 (one per position)");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: 1}\n"), "load_speed is missing");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: 1, hslm_a: 3, speed: 1}\n"), "either");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: 1, speed: 0}\n"), "load_speed is 0");
}

// x of a file of axles grows forward, or backward as distances behind the first axle do.
TEST(SceneLoad, AxlesOfAFileEitherWay) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("axles.csv", "0, 220e3\n2.1, 210e3\n4.5, 90e3\n"),
                    load = beam_yaml + "load: {speed: 30, file: " + file;
  const Scene forward = scene_of(load + "}\n"), backward = scene_of(load + ", file_x: backward}\n");
  EXPECT_EQ(forward.load.positions, (std::vector<double>{-4.5, -2.4, 0.0}));
  EXPECT_PRED2(any_contains, forward.unusual, "the force of 90 kN in the last row is in front");
  EXPECT_EQ(backward.load.positions, (std::vector<double>{-0.0, -2.1, -4.5}));
  EXPECT_FALSE(any_contains(backward.unusual, "in front"));
  const std::string behind = folder.write("behind.csv", "0, 220e3\n-2.1, 210e3\n");
  EXPECT_FALSE(any_contains(scene_of(beam_yaml + "load: {speed: 30, file: " + behind + "}\n").unusual, "in front"));
}

// What is no error and seldom meant has a word: a bridge without damping, a rough track that begins at the bridge.
TEST(SceneSense, WordsOnWhatIsLeftOut) {
  const std::string load = "load: {forces: 1e5, speed: 30}\n";
  EXPECT_PRED2(any_contains, scene_of(beam_yaml + load).unusual, "damping: none is given");
  EXPECT_FALSE(any_contains(scene_of(beam_yaml + load + "beam_damping_ratios: 0.01\n").unusual, "damping"));
  const Scene rough = scene_with({{"track_profile", "iso8608_B"}});
  EXPECT_PRED2(any_contains, rough.unusual, "the roughness begins at the first wheel");
  EXPECT_PRED2(any_contains, rough.unusual, "-train_positions -10");
  EXPECT_FALSE(
      any_contains(scene_with({{"track_profile", "iso8608_B"}, {"train_positions", "-100"}}).unusual, "rough"));
  EXPECT_PRED2(contains, refused(beam_yaml), "nothing moves over the bridge");
}

// Limits on the deck are judged along all of it, behind the stations that the scene names.
TEST(SceneOutput, LimitsOnTheDeckAddProbes) {
  const test::TemporaryFolder folder;
  const std::string deck = folder.write("deck.yml", "- {clause: A, quantity: deck_acceleration, value: 3.5}\n"),
                    ends = folder.write("ends.yml", "- {clause: A, quantity: end_rotation, value: 3.5}\n");
  const std::string scene = beam_yaml + "load: {forces: 1e5, speed: 30}\noutput: {probes: [40.0, 1.0]}\n";
  const std::vector<double> probes = scene_of(scene + "limits: " + deck + "\n").output.probes;
  ASSERT_EQ(probes.size(), 1U + 3U * 9U);  // 40 m is a tenth of a span, too
  EXPECT_EQ(std::vector<double>(probes.begin(), probes.begin() + 3), (std::vector<double>{40.0, 1.0, 2.5}));
  EXPECT_EQ(scene_of(scene + "limits: " + ends + "\n").output.probes.size(), 2U);
  EXPECT_EQ(scene_of(scene + "limits: " + deck + "\noutput_probes_spacing: 100\n").output.probes.size(), 6U);
}

TEST(SceneTrack, Profiles) {
  EXPECT_TRUE(scene_with({}).profile.level());
  const Scene bump = scene_with({{"track_profile", "bump"},
                                 {"track_bump_start", "10"},
                                 {"track_bump_length", "1"},
                                 {"track_bump_height", "0.01"}});
  EXPECT_DOUBLE_EQ(bump.profile.at(10.5).value, 0.01);
  const Scene rough = scene_with({{"track_profile", "iso8608_B"}, {"train_positions", "-20"}});
  EXPECT_EQ(rough.profile.at(-19.5).value, 0.0);
  EXPECT_NE(rough.profile.at(5.0).value, 0.0);
  for (const char* name : {"german_low", "german_high", "fra_1", "fra_6"}) {
    const Scene rails = scene_with({{"track_profile", name}, {"train_positions", "-20"}});
    EXPECT_EQ(rails.profile.at(-19.5).value, 0.0);
    EXPECT_NE(rails.profile.at(5.0).value, 0.0);
    const Scene short_waves = scene_with({{"track_profile", name}, {"track_wavelengths", "1, 3"}});
    EXPECT_LT(std::abs(short_waves.profile.at(55.0).value), 0.01);
    EXPECT_NE(short_waves.profile.at(55.0).value, scene_with({{"track_profile", name}}).profile.at(55.0).value);
  }
  const test::TemporaryFolder folder;
  const std::string ramp = folder.write("ramp.csv", "-400, 20\n0, 0\n100, 0\n");
  EXPECT_DOUBLE_EQ(scene_with({{"track_profile", ramp}}).profile.at(-200.0).value, 10.0);
  EXPECT_NEAR(scene_with({{"track_profile", ramp}, {"track_profile_shape", "spline"}}).profile.at(-200.0).value, 7.0,
              1e-12);
  EXPECT_PRED2(any_contains, scene_with({{"track_profile_shape", "spline"}}).notes,
               "track_profile_shape has no effect");
  EXPECT_PRED2(contains, refused_with("track_profile", "fra_7"), "fra_1 to fra_6");
  EXPECT_PRED2(contains, refused_with("track_profile", "german_medium"), "german_low (rails), german_high (rails)");
  EXPECT_PRED2(any_contains, scene_with({{"track_wavelengths", "1, 3"}}).notes, "track_wavelengths has no effect");
  EXPECT_PRED2(any_contains, scene_with({{"track_bump_start", "10"}}).notes, "track_bump_start has no effect");
  EXPECT_PRED2(contains, refused_with("track_profile", "iso8608_F"), "iso8608_A to iso8608_E");
  EXPECT_PRED2(contains, refused_with("track_profile", "bumpy"), "allowed: none, bump");
  EXPECT_PRED2(contains, refused_with("track_profile", "no.csv"), "no such file");
  EXPECT_PRED2(contains, refused_with("track_pad_k", "1e7"), "needs track_rail_EI");
}

TEST(SceneModel, AxialOnlyWhereItMatters) {
  const auto axial = [](std::initializer_list<std::pair<std::string, std::string>> values) {
    return scene_with(values).beam->axial;
  };
  EXPECT_FALSE(axial({}));
  EXPECT_FALSE(axial({{"beam_EA", "1e10"}}));
  EXPECT_FALSE(axial({{"vehicle_car_wheel_friction", "0.3"}})) << "no EA";
  EXPECT_TRUE(axial({{"beam_EA", "1e10"}, {"vehicle_car_wheel_friction", "0.3"}}));
  EXPECT_TRUE(axial({{"beam_EA", "1e10"}, {"train_drive", "free"}}));
  EXPECT_TRUE(axial({{"beam_EA", "1e10"}, {"scene_analysis", "modes"}}));
  EXPECT_TRUE(axial({{"beam_EA", "1e10"}, {"foundation_longitudinal_bed_k", "1e6"}}));
  EXPECT_TRUE(axial({{"beam_EA", "1e10"}, {"model_axial", "true"}}));
  EXPECT_FALSE(axial({{"beam_EA", "1e10"}, {"vehicle_car_wheel_friction", "0.3"}, {"model_axial", "false"}}));
  EXPECT_PRED2(contains, refused_with("model_axial", "true"), "needs beam_EA");
  EXPECT_PRED2(contains, refused_with("foundation_longitudinal_bed_k", "1"), "need beam_EA");
  EXPECT_PRED2(any_contains, scene_with({}).notes, "axial unknowns: none");
}

TEST(SceneModel, ModesUnderVehicles) {
  EXPECT_EQ(scene_with({{"model_modes", "5"}}).model.modes, 5);
  EXPECT_FALSE(scene_with({{"model_modes", "5"}}).exact_in_time());
  const std::vector<std::string> notes = scene_with({{"model_modes", "5"}, {"model_window", "1e-3"}}).notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note == "model_window has no effect: with modes the bridge has no parts that could be excluded";
  }));
  EXPECT_NO_THROW(scene_with({{"model_modes", "5"}, {"ts_type", "genalpha"}}));
  EXPECT_PRED2(contains, refused(vehicle_yaml + train_yaml + "ts_max_time: 1\nmodel_modes: 5\n"), "needs a beam");
}

TEST(SceneModel, Window) {
  EXPECT_EQ(scene_with({}).model.window_tolerance, -1.0);
  EXPECT_EQ(scene_with({{"model_window", "0"}}).model.window_tolerance, 0.0);
  EXPECT_EQ(scene_with({{"model_window", "1e-4"}}).model.window_tolerance, 1e-4);
  for (const char* wrong : {"2", "-1e-3", "near", "1e-4x"})
    EXPECT_PRED2(contains, refused_with("model_window", wrong), "allowed: a number from 0 to 0.1, or auto");
}

TEST(SceneSweep, SpeedsAndTrains) {
  const Scene s = scene_of(beam_yaml + "sweep: {speed: [27.7777778, 100, 0.5555556], hslm_a: [3, 1]}\n");
  ASSERT_TRUE(s.sweep);
  EXPECT_EQ(s.sweep->speeds.size(), 131u) << "a step rounded to seven digits still meets the last speed";
  EXPECT_NEAR(s.sweep->speeds.back(), 100.0, 1e-4);
  EXPECT_EQ(s.sweep->trains, (std::vector<int>{3, 1}));
  ASSERT_EQ(s.sweep->loads.size(), 2u);
  EXPECT_EQ(s.sweep->loads[1].forces.size(), 50u);
  EXPECT_EQ(scene_with({{"sweep_speed", "10,26,5"}}).sweep->speeds, (std::vector<double>{10, 15, 20, 25}));
  EXPECT_EQ(scene_of(beam_yaml + "load: {speed: 30}\nsweep: {hslm_a: 4}\n").sweep->trains, (std::vector<int>{4}));
  const std::vector<double> speeds = scene_with({{"sweep_speed", "36 km/h,90km/h,5 m/s"}}).sweep->speeds;
  ASSERT_EQ(speeds.size(), 4U);
  EXPECT_NEAR(speeds[0], 10.0, 1e-14);
  EXPECT_NEAR(speeds[3], 25.0, 1e-14);
  EXPECT_PRED2(contains, refused_with("sweep_speed", "36 mph,90,5"), "'36 mph' is not a finite number");
  EXPECT_PRED2(contains, refused_with("sweep_speed", "20,10,5"), "from is above to");
  EXPECT_PRED2(contains, refused_with("sweep_speed", "10,20"), "3 numbers");
  EXPECT_PRED2(contains, refused_with("sweep_speed", "50,60,70"), "the step of 70 m/s is larger");
  EXPECT_PRED2(contains, refused_with("sweep_hslm_a", "1,1"), "each once");
  EXPECT_PRED2(contains, refused_with("sweep_hslm_a", "0"), "from 1 to 10");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {hslm_a: 1}\nsweep: {hslm_a: 2, speed: [10, 20, 5]}\n"), "either");
  EXPECT_PRED2(contains, refused(beam_yaml + "load: {forces: 1}\nsweep: {hslm_a: 2, speed: [10, 20, 5]}\n"), "either");
  EXPECT_PRED2(contains, refused(beam_yaml + "scene_analysis: modes\nsweep: {speed: [10, 20, 5]}\n"), "transient");
  EXPECT_PRED2(contains, refused(vehicle_yaml + train_yaml + "sweep: {speed: [10, 20, 5]}\n"), "needs a bridge");
}

TEST(SceneSweep, BridgesByModes) {
  const std::string moving = beam_yaml + "load: {forces: 1e5, speed: 30}\n";
  EXPECT_EQ(scene_of(moving + "model_modes: 7\n").model.modes, 7);
  EXPECT_EQ(scene_of(moving + "model: {modes: 2, damping_ratios: [0.01, 0.02]}\n").damping_of_modes,
            (std::vector<double>{0.01, 0.02}));
  EXPECT_PRED2(contains, refused(moving + "model_modes: many\n"), "a whole number from 0 to 100000, or auto");
  EXPECT_PRED2(contains, refused(moving + "model: {modes: 3, damping_ratios: [0.01, 0.02]}\n"),
               "one, or 3 (one per mode)");
  EXPECT_PRED2(contains, refused(moving + "model_damping_ratios: 0.01\n"), "needs model_modes");
  EXPECT_PRED2(contains, refused(moving + "model_modes: 3\nts_type: bdf\n"), "exact in time");
  EXPECT_PRED2(contains, refused(beam_yaml + "ts_max_time: 1\nmodel_modes: 3\n"),
               "needs vehicles (train_vehicles) or moving forces");
  EXPECT_PRED2(contains, refused(moving + "model_modes: 3\nfoundation_vertical: {x: 5, k: 1e6, gap: 1e-3}\n"), "gap");
}

TEST(SceneWhole, SomethingHasToHappenAndToEnd) {
  EXPECT_PRED2(contains, refused(""), "nothing to simulate");
  EXPECT_PRED2(contains, refused("scene: {analysis: modes}\n"), "modes need a beam");
  EXPECT_PRED2(contains, refused(vehicle_yaml + train_yaml), "ts_max_time");
  EXPECT_NO_THROW(scene_of(vehicle_yaml + train_yaml + "ts_max_time: 1\n"));
  EXPECT_PRED2(contains, message_of([] { scene_with({{"train_speed", "0"}}); }), "train_speed is 0");
  EXPECT_NO_THROW(scene_with({{"train_speed", "0"}, {"scene_tail", "1"}}));
  EXPECT_NO_THROW(scene_of(beam_yaml + "scene: {analysis: modes}\n"));
}

TEST(SceneWhole, AMechanismOnItsOwnIsNotDriven) {
  const Scene s = scene_of(
      "vehicle: {pendulum: {bodies: bob, joints: pin, bob: {mass: 1, inertia: 1, position: [1, 0]}, "
      "pin: {type: revolute, bodies: [ground, bob], point: [0, 0]}}}\nts_max_time: 1\nscene_start: given\n");
  EXPECT_EQ(s.train.drive, Drive::free);
  EXPECT_EQ(s.start, Start::given);
  EXPECT_EQ(s.vehicles[0].mechanism.joints[0].bodies[0], multibody::ground);
}

class SceneFile : public testing::TestWithParam<std::string> {};

TEST_P(SceneFile, IsReadAndOpensWithThreeLines) {
  std::ifstream file(GetParam());
  for (const char* opening : {"# What: ", "# Source: ", "# Expected: "}) {
    std::string line;
    std::getline(file, line);
    EXPECT_TRUE(line.starts_with(opening)) << line;
  }
  if (contains(GetParam(), "/limits/")) return;  // lists, of which verdict_limits_test.cpp knows
  options::Entries entries;
  const std::vector<options::Entry> given = options::read_options_file(GetParam());
  if (!contains(GetParam(), "/scenes/")) return;
  for (const options::Entry& e : given) entries.set(e);
  EXPECT_NO_THROW(read_scene(Options(entries)));
}

std::vector<std::string> files_in_options() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() + "/options")) {
    if (entry.path().extension() == ".yml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Options, SceneFile, testing::ValuesIn(files_in_options()), [](const auto& name) {
  const std::filesystem::path path(name.param);
  return path.parent_path().stem().string() + "_" + path.stem().string();
});

// A coach as its source describes it: ten degrees of freedom besides x, and the axle loads of its masses.

}  // namespace
}  // namespace traverse::scene
