// Trains of moving forces by name: their weights and lengths, and what EN 15528's check case gives by influence lines.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/message.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::test {
namespace {

constexpr const char* bridge = R"(
beam: {spans: 25.0, EI: 3.0e10, mass: 1.5e4, damping_ratios: 0.01}
support: {types: [pinned, roller]}
output: {probes: [12.5]}
)";

train::MovingLoad load_of(const std::string& load) {
  return scene::read_scene(options::Options::from_yaml(bridge + ("load: {speed: 20, " + load + "}\n"))).load;
}

TEST(LoadModels, ReferenceWagons) {
  const train::MovingLoad load = load_of("en15528: D2, wagons: 6");
  ASSERT_EQ(load.forces.size(), 24U);
  EXPECT_NEAR(std::accumulate(load.forces.begin(), load.forces.end(), 0.0), 24 * 22.5e3 * 9.81, 1e-6);
  EXPECT_NEAR(load.positions[3], -(7.45 + 3.6), 1e-12);
  EXPECT_NEAR(load.positions[4] - load.positions[3], -3.0, 1e-12);  // over the buffers
}

// Every choice of the option has its wagon.
TEST(LoadModels, EveryLine) {
  double before = 0.0;
  for (const char* line : {"A1", "B1", "B2", "C2", "C3", "C4", "D2", "D3", "D4", "D5", "E4", "E5"}) {
    const train::MovingLoad load = load_of(std::string("en15528: ") + line);
    ASSERT_EQ(load.forces.size(), 4U) << line;
    EXPECT_GE(load.forces.front(), before) << line;
    before = load.forces.front();
  }
  EXPECT_NEAR(before, 25e3 * 9.81, 1e-9);
}

TEST(LoadModels, EvenlySpacedForces) {
  const train::MovingLoad load = load_of("hslm_b: [10, 3.5], positions: -2");
  EXPECT_EQ(load.forces, std::vector<double>(10, 170e3));
  EXPECT_EQ(load.positions.front(), -2.0);
  EXPECT_EQ(load.positions.back(), -2.0 - 9 * 3.5);
}

TEST(LoadModels, OfAFile) {
  const TemporaryFolder folder;
  const std::string file = folder.write("axles.csv", "# x, force\n10, 1e5\n7.5, 2e5\n");
  const train::MovingLoad load = load_of("file: " + file);
  EXPECT_EQ(load.forces, (std::vector<double>{1e5, 2e5}));
  EXPECT_EQ(load.positions, (std::vector<double>{0.0, -2.5}));
}

TEST(LoadModels, SpreadOverSleepers) {
  const train::MovingLoad load = load_of("forces: [1e5, 2e5], positions: [0, -3], spread: 0.6");
  EXPECT_EQ(load.forces, (std::vector<double>{2.5e4, 5e4, 2.5e4, 5e4, 1e5, 5e4}));
  EXPECT_EQ(load.positions, (std::vector<double>{0.6, 0.0, -0.6, -2.4, -3.0, -3.6}));
  EXPECT_EQ(load_of("hslm_b: [2, 3.5], spread: 0.6").positions.front(), 0.0);
  const scene::Scene sweep =
      scene::read_scene(options::Options::from_yaml(bridge + std::string("load: {speed: 20, spread: 0.6}\n"
                                                                         "sweep: {hslm_a: [1, 2]}\n")));
  EXPECT_EQ(sweep.sweep->loads[1].forces.size(), 3 * 48U);  // four and two axles at both ends, 36 between coaches
}

// Six D2 wagons: the greatest static deflection at midspan is 1.125392e-2 m, wherever they stand.
TEST(LoadModels, CheckCaseOfTheLine) {
  Results run = run_yaml(bridge, {{"load_en15528", "D2"},
                                  {"load_wagons", "6"},
                                  {"load_speed", "10"},
                                  {"model_modes", "3"},
                                  {"sweep_speed", "10,10,1"}});
  EXPECT_NEAR(run("/sweep/static_deflection")[0], 1.125392e-2, 1e-5 * 1.125392e-2);
}

TEST(LoadModels, BadOnesAreRefusedInOneLine) {
  const auto message = [](const std::string& load) { return message_of([&] { load_of(load); }); };
  EXPECT_NE(message("en15528: D9").find("allowed: one of A1, B1"), std::string::npos);
  EXPECT_NE(message("hslm_b: [2.5, 3]").find("a whole number of forces"), std::string::npos);
  EXPECT_NE(message("hslm_b: [2, 3], hslm_a: 1").find("give either this or load_hslm_b"), std::string::npos);
  EXPECT_NE(message("file: /no/such.csv").find("there is no such file"), std::string::npos);
}

}  // namespace
}  // namespace traverse::test
