// Static equilibria that lie beyond what is loose, or apart, where the scene puts the bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/message.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double weight = 981.0;

/// A body of 100 kg that slides upright, 2 m below where its spring is fastened; what it goes down by to rest there,
/// found at the start and kept.
const std::string hanging = R"(
vehicle:
  swing:
    bodies: [body]
    springs: [rope]
    drivers: [upright, along]
    body: {mass: 100.0, inertia: 1.0, position: [0.0, 0.0]}
    upright: {body: body, coordinate: phi}
    along: {body: body, coordinate: x}
    rope: {bodies: [ground, body], from: [0.0, 2.0], to: [0.0, 0.0], damping: 10.0}
train: {vehicles: swing}
ts: {max_time: 0.1, dt: 0.01}
)";

/// The scene without the lines that begin with these words.
std::string without(const std::vector<std::string>& words) {
  std::istringstream in(hanging);
  std::string out, line;
  while (std::getline(in, line)) {
    const std::string text = line.substr(std::min(line.find_first_not_of(' '), line.size()));
    const auto begins = [&](const std::string& word) { return text.rfind(word, 0) == 0; };
    if (std::none_of(words.begin(), words.end(), begins)) out += line + '\n';
  }
  return out;
}

double sag(const std::string& scene, const Values& options, const std::string& body = "/vehicles/0/body") {
  Results run = run_yaml(scene, options);
  const std::vector<double>& position = run(body + "/position");
  for (std::size_t i = 1; 3 * i < position.size(); ++i) EXPECT_NEAR(position[3 * i + 1], position[1], 1e-9);
  return -position[1];
}

const std::string rope = "vehicle_swing_rope_";

TEST(LooseStart, ARopeDrawnAtItsFreeLength) {
  for (const double k : {1e2, 3.4e3, 1e6, 1e9})
    EXPECT_NEAR(sag(hanging, {{rope + "stiffness", std::to_string(k)}, {rope + "side", "tension"}}), weight / k,
                1e-9 * (1.0 + weight / k))
        << k;
}

TEST(LooseStart, ARopeDrawnSlack) {
  EXPECT_NEAR(sag(hanging, {{rope + "stiffness", "3.4e3"}, {rope + "side", "tension"}, {rope + "free_length", "2.7"}}),
              0.7 + weight / 3.4e3, 1e-9);
}

TEST(LooseStart, ASpringWithPlay) {
  EXPECT_NEAR(sag(hanging, {{rope + "stiffness", "3.4e3"}, {rope + "gap", "0.03"}}), 0.03 + weight / 3.4e3, 1e-9);
}

TEST(LooseStart, ABumpStopWithAGapBelow) {
  EXPECT_NEAR(sag(hanging, {{rope + "stiffness", "3.4e5"},
                            {rope + "side", "compression"},
                            {rope + "gap", "0.05"},
                            {rope + "from", "0,-0.5"}}),
              0.05 + weight / 3.4e5, 1e-9);
}

TEST(LooseStart, ATableThatIsFlatAtZero) {
  const TemporaryFolder folder;
  const std::string table = folder.write("law.csv", "-1.0, -3000\n-0.1, 0\n0.1, 0\n1.0, 3000\n");
  EXPECT_NEAR(sag(hanging, {{rope + "table", table}}), 0.1 + 0.9 * weight / 3000.0, 1e-9);
}

// It swings down until the rope is upright, and beyond its length by the stretch.
TEST(LooseStart, ARopeDrawnToTheSide) {
  Results run = run_yaml(without({"along:"}), {{rope + "stiffness", "3.4e3"},
                                               {rope + "side", "tension"},
                                               {rope + "from", "1.0,0.5"},
                                               {"vehicle_swing_drivers", "upright"}});
  const std::vector<double>& position = run("/vehicles/0/body/position");
  EXPECT_NEAR(position[0], 1.0, 1e-6);
  EXPECT_NEAR(position[1], 0.5 - std::sqrt(1.25) - weight / 3.4e3, 1e-9);
}

TEST(LooseStart, ABallThatIsDrawnAboveTheFloor) {
  const std::string ball = R"(
vehicle:
  ball:
    bodies: [ball]
    contacts: [floor]
    drivers: [upright]
    ball: {mass: 100.0, inertia: 1.0, position: [0.0, 0.0]}
    upright: {body: ball, coordinate: phi}
    floor: {type: arc_line, bodies: [ball, ground], radii: 0.12, centres: [0.0, 0.0], line: [-1.0, -1.0, 1.0, -1.0],
            law: linear, stiffness: 1.0e6}
train: {vehicles: ball}
ts: {max_time: 0.1, dt: 0.01}
)";
  EXPECT_NEAR(sag(ball, {}, "/vehicles/0/ball"), 1.0 - 0.12 + weight / 1e6, 1e-9);
}

TEST(LooseStart, AWheelThatIsDrawnAboveABridge) {
  const std::string scene = R"(
beam: {spans: 20.0, elements_per_span: 4, EI: 1.0e8, mass: 1000.0}
support: {types: [pinned, roller]}
vehicle:
  mass:
    bodies: [body]
    wheels: [wheel]
    drivers: [upright]
    body: {mass: 1.0e4, inertia: 1.0, position: [0.0, 0.8]}
    upright: {body: body, coordinate: phi}
    wheel: {body: body, radius: 0.46, law: linear, stiffness: 1.0e7}
train: {vehicles: mass, positions: 10.0, speed: 10.0}
scene: {analysis: static}
)";
  Results run = run_yaml(scene);
  const double P = 9.81e4, deflection = P * 8000.0 / (48.0 * 1e8);
  EXPECT_NEAR(run("/vehicles/0/body/position")[1], 0.46 - deflection - P / 1e7, 1e-8);
  EXPECT_NEAR(run("/probes/deflection")[0], -deflection, 1e-8);
}

TEST(LooseStart, WhatNothingHoldsIsNamed) {
  const auto refused = [](const std::string& scene, const Values& options) -> std::string {
    try {
      run_yaml(scene, options);
    } catch (const SolverError& error) {
      return error.what();
    }
    return "not refused";
  };
  // A strut above the body that only pushes; a rope that would hold it 10 km down.
  for (const Values& options :
       {Values{{rope + "stiffness", "3.4e3"}, {rope + "side", "compression"}},
        Values{{rope + "stiffness", "3.4e3"}, {rope + "side", "tension"}, {rope + "free_length", "1e4"}}}) {
    const std::string said = refused(hanging, options);
    EXPECT_PRED2(contains, said, "no static equilibrium");
    EXPECT_PRED2(contains, said, "nothing holds body 'body' of vehicle 'swing'");
    EXPECT_PRED2(contains, said, "spring 'rope' stays loose");
    EXPECT_PRED2(contains, said, "scene_start: given");
  }
  EXPECT_PRED2(contains, refused(without({"springs:", "rope:"}), {}), "body 'body'");
}

}  // namespace
}  // namespace traverse::test
