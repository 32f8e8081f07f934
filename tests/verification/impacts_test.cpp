// Impacts of bodies as scenes: Hertz' and the linear law, dampers, restitution and friction against closed forms, all
// at a step far longer than the impact; a ball that bounces.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/separations.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double gravity = 9.81;

const std::string no_gravity = R"(
scene: {start: given}
gravity: 0.0
ts: {max_time: 0.1, dt: 1.0e-3}
output: {interval: 1.0e-2}
)";

// A ball of 2 kg, 1 cm above a floor, at 1.5 m/s towards it.
constexpr double ball_mass = 2.0, ball_radius = 0.1, gap = 0.01, speed = 1.5;
std::string ball_on_floor(const std::string& law) {
  return R"(
vehicle:
  ball:
    bodies: [ball]
    contacts: [floor]
    ball:  {mass: 2.0, inertia: 0.008, position: [0.0, 0.11], velocity: [0.0, -1.5, 0.0]}
    floor: {type: arc_line, bodies: [ball, ground], radii: 0.1, centres: [0.0, 0.11], line: [-1.0, 0.0, 1.0, 0.0], )" +
         law + "}" + no_gravity;
}

// Two free balls of 2 and 5 kg, 1 cm apart, at 1.1 and -0.4 m/s; the second contact body is a distant one.
std::string two_balls(const std::string& law) {
  return R"(
vehicle:
  balls:
    bodies: [left, right]
    contacts: [between]
    left:  {mass: 2.0, inertia: 0.008, position: [-0.1, 0.0], velocity: [1.1, 0.0, 0.0]}
    right: {mass: 5.0, inertia: 0.045, position: [0.16, 0.0], velocity: [-0.4, 0.0, 0.0]}
    between: {type: arc_arc, bodies: [left, right], radii: [0.1, 0.15], centres: [-0.1, 0.0, 0.16, 0.0], )" +
         law + "}" + no_gravity;
}

/// What free flight before and after says of an impact.
struct Rebound {
  double speed, duration, force, start;  // m/s, s, N, s
};
/// `distance` and its rate at the end, from the gap at the start.
Rebound rebound(Results& run, double distance, double rate) {
  const std::vector<Separated> list = separations(run);
  EXPECT_EQ(list.size(), 2u) << "from the start to the impact, and after it";
  const double touched = gap / speed, end = run.time().back();
  return {rate, end - distance / rate - touched, list.at(0).impact_force, list.at(0).duration};
}
Rebound on_floor(const std::string& law) {
  Results run = run_yaml(ball_on_floor(law));
  testing::Test::RecordProperty("floor_energy", text(energy_error(run)));
  EXPECT_LT(energy_error(run), 1e-3);
  return rebound(run, run.column("/vehicles/0/ball/position", 1).back() - ball_radius,
                 run.column("/vehicles/0/ball/velocity", 1).back());
}
Rebound between_balls(const std::string& law) {
  Results run = run_yaml(two_balls(law));
  testing::Test::RecordProperty("balls_energy", text(energy_error(run)));
  EXPECT_LT(energy_error(run), 1e-3);
  const auto apart = [&](const char* what) {
    return run.column(std::string("/vehicles/0/right/") + what).back() -
           run.column(std::string("/vehicles/0/left/") + what).back();
  };
  const double momentum =
      2.0 * run.column("/vehicles/0/left/velocity").back() + 5.0 * run.column("/vehicles/0/right/velocity").back();
  EXPECT_NEAR(momentum, 2.0 * 1.1 - 5.0 * 0.4, 2e-6);  // rounding of positions over the shortest step
  return rebound(run, apart("position") - 0.25, apart("velocity"));
}

/// Effective mass of each pair.
constexpr double floor_mass = ball_mass, balls_mass = 10.0 / 7.0;

void expect_near(const std::string& what, double value, double expected, double tolerance) {
  testing::Test::RecordProperty(what, text(value / expected - 1.0));
  EXPECT_NEAR(value, expected, tolerance * expected) << what;
}

// --- elastic impacts -------------------------------------------------------------------------------------------------

class ElasticImpact : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Impacts, ElasticImpact, testing::Values(1e6, 1e9, 1e12));

void expect_hertz(const Rebound& seen, double mass, double k, const std::string& what) {
  const double deepest = std::pow(1.25 * mass * speed * speed / k, 0.4);
  expect_near(what + "_rebound", seen.speed, speed, 1e-4);
  expect_near(what + "_duration", seen.duration, 2.943275 * deepest / speed, 2e-5);
  expect_near(what + "_depth", std::pow(seen.force / k, 2.0 / 3.0), deepest, 5e-5);
  expect_near(what + "_force", seen.force, k * std::pow(deepest, 1.5), 1e-4);
  expect_near(what + "_start", seen.start, gap / speed, 1e-12);
}

TEST_P(ElasticImpact, Hertz) {
  const double k = GetParam();
  const std::string law = "stiffness: " + text(k);
  expect_hertz(on_floor(law), floor_mass, k, "floor");
  expect_hertz(between_balls(law), balls_mass, k, "balls");
}

void expect_half_period(const Rebound& seen, double mass, double k, const std::string& what) {
  const double omega = std::sqrt(k / mass);
  expect_near(what + "_rebound", seen.speed, speed, 3e-4);
  expect_near(what + "_duration", seen.duration, pi / omega, 1e-5);
  expect_near(what + "_force", seen.force, mass * omega * speed, 1e-4);
}

TEST_P(ElasticImpact, Linear) {
  const double k = GetParam();
  const std::string law = "law: linear, stiffness: " + text(k);
  expect_half_period(on_floor(law), floor_mass, k, "floor");
  expect_half_period(between_balls(law), balls_mass, k, "balls");
}

// --- a linear damper -------------------------------------------------------------------------------------------------

/// m a'' + c a' + k a = 0 from a = 0 at `speed` until the force k a + c a' is zero, at (pi - 2 asin zeta)/omega_d: the
/// bodies then part at a constant speed, the surfaces still overlapping, until they are clear.
void expect_damped(const Rebound& seen, double mass, double k, double zeta, const std::string& what) {
  const double omega = std::sqrt(k / mass), damped = omega * std::sqrt(1.0 - zeta * zeta), turn = std::asin(zeta);
  const auto derivative = [&](int n, double t) {
    return speed / damped * std::pow(omega, n) * std::exp(-zeta * omega * t) *
           std::sin(damped * t + n * (0.5 * pi + turn));
  };
  const double end = (pi - 2.0 * turn) / damped;
  const double left = derivative(0, end), leaves = -derivative(1, end);
  ASSERT_NEAR(derivative(2, end), 0.0, 1e-10 * omega * speed);
  const double crest = zeta < 0.5 ? (0.5 * pi - 3.0 * turn) / damped : 0.0;  // of the force
  expect_near(what + "_rebound", seen.speed, leaves, 1e-3);
  expect_near(what + "_clear", seen.duration, end + left / leaves, 1e-4);
  expect_near(what + "_force", seen.force, -mass * derivative(2, crest), 5e-3);
}

class DampedImpact : public testing::TestWithParam<std::pair<double, double>> {};
INSTANTIATE_TEST_SUITE_P(Impacts, DampedImpact,
                         testing::Values(std::pair(1e6, 0.05), std::pair(1e6, 0.3), std::pair(1e6, 0.8),
                                         std::pair(1e9, 0.3), std::pair(1e12, 0.3)));

TEST_P(DampedImpact, LinearSpringAndDamper) {
  const auto [k, zeta] = GetParam();
  const auto law = [&, k = k, zeta = zeta](double mass) {
    return "law: linear, stiffness: " + text(k) + ", damping: " + text(2.0 * zeta * std::sqrt(k * mass));
  };
  expect_damped(on_floor(law(floor_mass)), floor_mass, k, zeta, "floor");
  expect_damped(between_balls(law(balls_mass)), balls_mass, k, zeta, "balls");
}

// --- restitution -----------------------------------------------------------------------------------------------------

class Restitution : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Impacts, Restitution, testing::Values(0.9, 0.5, 0.2));

TEST_P(Restitution, AsAsked) {
  const std::string asked = "restitution: " + text(GetParam());
  expect_near("hertz", on_floor("stiffness: 1.0e9, " + asked).speed, GetParam() * speed, 1e-3);
  expect_near("linear", on_floor("law: linear, stiffness: 1.0e8, " + asked).speed, GetParam() * speed, 1e-3);
  expect_near("balls", between_balls("stiffness: 1.0e11, " + asked).speed, GetParam() * speed, 1e-3);
}

/// The e > 0 of (1 + e) d = ln((1 + d)/(1 - e d)).
double restitution_of(double d) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double e = 0.5 * (low + high);
    ((1.0 + e) * d > std::log1p(d) - std::log1p(-e * d) ? low : high) = e;
  }
  return low;
}

TEST_P(Restitution, ByLankaraniAndNikravesh) {
  const double d = 0.75 * (1.0 - GetParam() * GetParam());
  const std::string asked = "restitution_law: lankarani_nikravesh, restitution: " + text(GetParam());
  EXPECT_GT(restitution_of(d), GetParam());
  expect_near("hertz", on_floor("stiffness: 1.0e9, " + asked).speed, restitution_of(d) * speed, 1e-3);
  expect_near("balls", between_balls("stiffness: 1.0e7, " + asked).speed, restitution_of(d) * speed, 1e-3);
}

// --- eq. 48 ----------------------------------------------------------------------------------------------------------

double stiffness_read(const std::string& scene) {
  run_yaml(scene, {{"ts_max_time", "1e-3"}});
  return scene::read_scene().vehicles.at(0).contacts.at(0).law.stiffness;
}

TEST(ContactStiffness, FromModuliAndRadii) {
  const auto eq48 = [](double radius, double young, double poisson, double other_young, double other_poisson) {
    const double h = (1.0 - poisson * poisson) / (pi * young);
    const double other = (1.0 - other_poisson * other_poisson) / (pi * other_young);
    return 4.0 / (3.0 * pi * (h + other)) * std::sqrt(radius);
  };
  const auto expect = [](double seen, double expected) { EXPECT_NEAR(seen, expected, 1e-14 * expected); };
  expect(stiffness_read(ball_on_floor("young: 2.1e11")), eq48(0.1, 2.1e11, 0.3, 2.1e11, 0.3));
  expect(stiffness_read(ball_on_floor("young: 2.1e11, poisson: 0.28, other_young: 3.0e10, other_poisson: 0.2")),
         eq48(0.1, 2.1e11, 0.28, 3.0e10, 0.2));
  expect(stiffness_read(two_balls("young: 2.1e11")), eq48(0.1 * 0.15 / 0.25, 2.1e11, 0.3, 2.1e11, 0.3));
  expect(stiffness_read(two_balls("young: 7.0e10, poisson: 0.33, other_young: 2.1e11")),
         eq48(0.1 * 0.15 / 0.25, 7.0e10, 0.33, 2.1e11, 0.33));
}

// --- an oblique impact -----------------------------------------------------------------------------------------------

// Spinning balls meet off centre, with friction.
constexpr const char* oblique = R"(
vehicle:
  balls:
    bodies: [left, right]
    contacts: [between]
    left:  {mass: 2.0, inertia: 0.008, position: [-0.1, 0.05], velocity: [3.0, -0.4, 20.0]}
    right: {mass: 5.0, inertia: 0.045, position: [0.16, -0.02], velocity: [-0.4, 0.3, -7.0]}
    between: {type: arc_arc, bodies: [left, right], radii: [0.1, 0.15], centres: [-0.1, 0.05, 0.16, -0.02],
              stiffness: 1.0e9, restitution: 0.7, friction: 0.3}
)";

void expect_momentum(Results run, double tolerance) {
  const std::array<const char*, 2> names = {"left", "right"};
  const std::array<double, 2> mass = {2.0, 5.0}, inertia = {0.008, 0.045};
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), worst = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < run.time().size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t b = 0; b < 2; ++b) {
      const double* q = &run(std::string("/vehicles/0/") + names[b] + "/position")[3 * i];
      const double* v = &run(std::string("/vehicles/0/") + names[b] + "/velocity")[3 * i];
      sum += Eigen::Vector3d(mass[b] * v[0], mass[b] * v[1], mass[b] * (q[0] * v[1] - q[1] * v[0]) + inertia[b] * v[2]);
    }
    if (i == 0) first = sum;
    worst = worst.cwiseMax((sum - first).cwiseAbs());
  }
  testing::Test::RecordProperty("momentum", text(worst.head<2>().maxCoeff()));
  testing::Test::RecordProperty("angular_momentum", text(worst.z()));
  testing::Test::RecordProperty("energy", text(energy_error(run)));
  const double spin = run.column("/vehicles/0/left/velocity", 2).back();
  EXPECT_LT(spin, 19.0) << "friction has acted";
  EXPECT_LT(worst.head<2>().maxCoeff(), tolerance);
  EXPECT_LT(worst.z(), 1e-6);  // the integrator's, kg m2/s: 0.5 in all
  EXPECT_LT(energy_error(run), 1e-4);
}

// Implicit stages take velocities from positions, whose rounding a short step magnifies.
TEST(ObliqueImpact, KeepsMomentumAndAngularMomentum) { expect_momentum(run_yaml(oblique + no_gravity), 1e-8); }

// Friction that nearly holds is stiff: too much so for an explicit method in 20 steps an impact.
TEST(ObliqueImpact, KeepsThemByAnExplicitMethodToo) {
  expect_momentum(
      run_yaml(oblique + no_gravity,
               {{"ts_type", "rk"}, {"ts_rk_type", "5dp"}, {"vehicle_balls_between_transition_speed", "0.5"}}),
      1e-13);
}

// --- a ball that bounces ---------------------------------------------------------------------------------------------

constexpr double drop = 1.0;  // m

std::vector<double> approach_speeds(Results& run) {
  std::vector<double> speeds;
  for (const Separated& s : separations(run))
    if (s.approach_speed > 0.0) speeds.push_back(s.approach_speed);
  return speeds;
}

TEST(BouncingBall, TwentyBouncesKeepTheirHeight) {
  const auto drift = [](const char* steps) {  // of the energy, a bounce
    Results run =
        run_scene("bouncing_ball",
                  {{"vehicle_ball_floor_restitution", "1"}, {"ts_max_time", "19.0"}, {"contact_impact_steps", steps}});
    const std::vector<double> v = approach_speeds(run);
    EXPECT_EQ(v.size(), 21u);
    EXPECT_NEAR(v.front(), std::sqrt(2.0 * gravity * drop), 1e-5 * v.front());
    const double y = run.column("/vehicles/0/ball/position", 1).back() - 0.12;
    const double rate = run.column("/vehicles/0/ball/velocity", 1).back();
    const double apex = y + 0.5 * rate * rate / gravity;
    EXPECT_NEAR(apex, 0.5 * v.back() * v.back() / gravity, 1e-3 * drop);
    return (apex / drop - 1.0) / 21.0;
  };
  const double usual = drift("20"), fine = drift("80");
  RecordProperty("drift_a_bounce", text(usual));
  RecordProperty("drift_with_80_steps", text(fine));
  EXPECT_LT(std::abs(usual), 1e-4);
  EXPECT_LT(std::abs(fine), 0.1 * std::abs(usual));
}

// The energy that impacts leave does not add up to what a run may miss, by methods of one solve a step neither.
TEST(BouncingBall, ThreeHundredBouncesKeepTheirEnergy) {
  const Values elastic = {{"vehicle_ball_floor_restitution", "1"}, {"output_interval", "1"}};
  Results usual = run_scene("bouncing_ball", elastic + Values{{"ts_max_time", "272"}});
  EXPECT_GE(approach_speeds(usual).size(), 300u);
  RecordProperty("energy", text(energy_error(usual)));
  EXPECT_LT(energy_error(usual), 4e-3);
  Results one_solve = run_scene("bouncing_ball", elastic + Values{{"ts_max_time", "19"}, {"ts_type", "genalpha"}});
  EXPECT_EQ(approach_speeds(one_solve).size(), 21u);
  RecordProperty("energy_genalpha", text(energy_error(one_solve)));
  EXPECT_LT(energy_error(one_solve), 2e-3);
}

// Flights follow a geometric series, e^n times the first, as long as the weight is small against the impact's force.
TEST(BouncingBall, GeometricSeriesToRest) {
  Results run = run_scene("bouncing_ball", {{"vehicle_ball_floor_stiffness", "1.0e12"}});
  const std::vector<Separated> list = separations(run);
  const double e = 0.7, first = std::sqrt(2.0 * gravity * drop);
  ASSERT_GE(list.size(), 15u);
  double worst = 0.0, worst_start = 0.0, start = first / gravity;
  for (std::size_t n = 1; n <= 8; ++n) {
    const double flight = 2.0 * first * std::pow(e, static_cast<double>(n)) / gravity;
    worst = std::max(worst, std::abs(list[n].duration / flight - 1.0));
    worst_start = std::max(worst_start, std::abs(list[n].start - start));
    start += flight;
  }
  RecordProperty("flight_error", text(worst));
  RecordProperty("start_error", text(worst_start));
  EXPECT_LT(worst, 2e-3);
  EXPECT_LT(worst_start, 5e-4);  // eight impacts last 0.3 ms
  for (std::size_t n = 1; n < list.size(); ++n)
    EXPECT_LT(list[n].approach_speed, 0.705 * list[n - 1].approach_speed) << n;
  EXPECT_LT(list.back().end(), first / gravity * (1.0 + e) / (1.0 - e) + 2e-3);
  const double deep = std::pow(0.6 * gravity / 1e12, 2.0 / 3.0);
  EXPECT_NEAR(run.column("/vehicles/0/ball/position", 1).back(), 0.12 - deep, 1e-9);
  EXPECT_NEAR(run.column("/vehicles/0/ball/velocity", 1).back(), 0.0, 1e-9);
  EXPECT_LT(energy_error(run), 1e-3);
}

}  // namespace
}  // namespace traverse::test
