// A wheel on a surface above the beam's axis: reactions keep the balance of moments in the deflected shape.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr double e = 2.0, radius = 0.5, L = 20.0, x = 8.0;

const char* const one_wheel = R"(
scene: {analysis: static}
model: {axial: "true"}
beam: {spans: 20.0, EI: 1.0e10, EA: 1.0e12, mass: 1.0e4, elements_per_span: 10, surface_height: 2.0}
support: {types: [pinned, roller]}
vehicle:
  roller:
    bodies: [body]
    wheels: [wheel]
    body: {mass: 5.0e4, inertia: 1.0e4, position: [0.0, 0.5]}
    wheel: {body: body, radius: 0.5, law: linear, stiffness: 1.0e8}
train: {vehicles: roller, positions: 8.0, speed: 0.0}
output: {probes: [8.0]}
)";

// The wheel's force goes through its centre, at x. Moments about the left support, of its components at the surface's
// point: R L = f_y (x - u) + f_x (e + d cos a), where a is the slope there, d the wheel's compressed radius, and u what
// the axis has moved along x.
TEST(SurfaceHeight, ReactionsKeepTheBalanceOfMoments) {
  Results run = run_yaml(one_wheel);
  const std::vector<double>& reaction = run("/supports/reaction");  // fx, fy and moment of both supports
  const double force = run("/vehicles/0/wheel/normal_force").back(),
               d = radius - run("/vehicles/0/wheel/penetration").back();
  const double u = run("/probes/axial_displacement").back();
  const double f_y = reaction[1] + reaction[4], f_x = -reaction[0];
  EXPECT_LT(f_x, -100.0);  // towards the left, where the surface falls to the right
  EXPECT_NEAR(reaction[4] * L, f_y * (x - u) + f_x * (e + d * f_y / force), 1e-7 * std::abs(f_x) * e);
}

}  // namespace
}  // namespace traverse::test
