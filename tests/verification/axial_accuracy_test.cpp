// A train that brakes on a bed that holds the deck along x: mesh and step do for what it pushes along, too.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const char* const braked_deck = R"(
beam: {spans: 40.0, EI: 2.0e10, EA: 1.0e10, mass: 5000.0}
support: {types: [pinned, roller]}
foundation: {longitudinal: {bed: {k: 1.0e9, c: 5.0e6}}}
train: {vehicles: car, positions: 8.0}
ts: {max_time: 1.6}
output: {probes: {spacing: 2.0}}
vehicle:
  car:
    bodies:  [body, front, rear]
    joints:  [front_guide, rear_guide]
    springs: [front_spring, rear_spring]
    wheels:  [front_wheel, rear_wheel]
    body:  {mass: 2.0e4, inertia: 1.0e5, position: [0.0, 2.0]}
    front: {mass: 1.5e3, inertia: 1.0, position: [2.0, 0.46]}
    rear:  {mass: 1.5e3, inertia: 1.0, position: [-3.0, 0.46]}
    front_guide: {type: prismatic, bodies: [body, front], point: [2.0, 0.46], axis: [0.0, 1.0]}
    rear_guide:  {type: prismatic, bodies: [body, rear], point: [-3.0, 0.46], axis: [0.0, 1.0]}
    front_spring: {bodies: [body, front], from: [2.0, 2.0], to: [2.0, 0.46], stiffness: 2.0e6, damping: 4.0e4}
    rear_spring:  {bodies: [body, rear], from: [-3.0, 2.0], to: [-3.0, 0.46], stiffness: 2.0e6, damping: 4.0e4}
    front_wheel: {body: front, radius: 0.46, law: linear, stiffness: 1.0e9}
    rear_wheel:  {body: rear, radius: 0.46, law: linear, stiffness: 1.0e9}
)";

// The displacement fades within sqrt(EA/k) = 3.2 m of a wheel, which the four elements that do for the deflection do
// not follow.
TEST(AxialAccuracy, KeepsTheDisplacementOfABrakedDeck) {
  const TemporaryFolder folder;
  const Values braked = {{"train_speed_file", folder.write("speed.csv", "0,10\n0.5,10\n1.0,8\n1.6,5\n")},
                         {"accuracy_cache", "false"}};
  constexpr double accuracy = 1e-2;
  const Results run = run_yaml(
      braked_deck, braked + Values{{"accuracy", text(accuracy)}, {"accuracy_of", "deflection,axial_displacement"}});
  const Results fine = run_yaml(
      braked_deck, braked + Values{{"beam_elements_per_span", "320"}, {"ts_dt", "2e-3"}, {"step_probes", "true"}});
  EXPECT_LE(run.attribute("/summary", "expected_error_axial_displacement"), accuracy);
  EXPECT_NEAR(run.attribute("/summary", "axial_displacement") / fine.attribute("/summary", "axial_displacement"), 1.0,
              accuracy);
}

}  // namespace
}  // namespace traverse::test
