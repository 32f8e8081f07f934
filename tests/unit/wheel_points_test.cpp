// Contacts of a wheel with the ground: forces are the gradient of the contacts' potential, out of round or not, at one
// point or several; in a valley they are those of statics.
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <vector>

#include "coupling/system.hpp"

namespace traverse::train {
namespace {

constexpr double R = 0.46, mass = 1000.0, g = 9.81;

Vehicle wheelset(double stiffness, contact::LawKind kind, const track::WheelShape& shape = {}, double friction = 0.0) {
  Vehicle v;
  v.name = "axle";
  multibody::Body body;
  body.name = "axle";
  body.mass = mass;
  body.inertia = 100.0;
  body.position = {0.0, R, 0.0};
  v.mechanism.bodies = {body};
  Wheel wheel;
  wheel.name = "wheel";
  wheel.radius = R;
  wheel.law.kind = kind;
  wheel.law.stiffness = stiffness;
  wheel.law.friction = friction;
  wheel.shape = shape;
  v.wheels = {wheel};
  return v;
}

// A free wheelset on the ground, put where a test wants it.
struct Placed {
  Placed(const Vehicle& vehicle, track::Profile p) : profile(std::move(p)) {
    Train train;
    train.vehicles = {0};
    train.positions = {0.0};
    train.drive = Drive::free;
    fleet = Fleet({vehicle}, train, g, false, nullptr, &profile, 0.0);
    fleet.partition(0.0);
    fleet.start_rolling();
  }
  void put(const Eigen::Vector3d& q, const Eigen::Vector3d& qd = Eigen::Vector3d::Zero()) {
    fleet.vehicles[0].state.q = q;
    fleet.vehicles[0].state.qd = qd;
    fleet.place_wheels();
    ASSERT_TRUE(fleet.touch(2, none.data(), none.data()));
    for (WheelContact& c : fleet.wheels) c.kinematics = c.touch.kinematics;
    fleet.contact_forces();
    fleet.contact_loads();
  }
  double potential(const Eigen::Vector3d& q) {
    put(q);
    return fleet.contact_potential();
  }
  track::Profile profile;
  Fleet fleet;
  std::vector<double> none = std::vector<double>(12, 0.0);
};

void expect_gradient(Placed& placed, const Eigen::Vector3d& q) {
  const double d = 1e-7;
  Eigen::Vector3d gradient;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = d * Eigen::Vector3d::Unit(i);
    gradient[i] = (placed.potential(q + step) - placed.potential(q - step)) / (2.0 * d);
  }
  placed.put(q);
  const Eigen::Vector3d force = placed.fleet.vehicles[0].Q;
  EXPECT_LT((force + gradient).norm(), 2e-4 * force.norm() + 0.5) << "x = " << q.x() << ", y = " << q.y();
}

void expect_rates(Placed& placed, const Eigen::Vector3d& q, const Eigen::Vector3d& qd) {
  const double d = 1e-6;
  std::vector<double> before, after;
  placed.put(q - d * qd, qd);
  for (const WheelContact& c : placed.fleet.wheels) before.push_back(c.kinematics.penetration);
  placed.put(q + d * qd, qd);
  for (const WheelContact& c : placed.fleet.wheels) after.push_back(c.kinematics.penetration);
  placed.put(q, qd);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double rate = (after[i] - before[i]) / (2.0 * d);
    if (std::abs(rate) > 10.0 || before[i] < -1e-3) continue;  // a point that comes or goes, or lies far apart
    EXPECT_NEAR(placed.fleet.wheels[i].kinematics.penetration_rate, rate, 1e-5) << "entry " << i << ", x = " << q.x();
    EXPECT_NEAR(placed.fleet.wheels[i].touch.normal_on_body.dot(qd), rate, 1e-5) << "entry " << i << ", x = " << q.x();
  }
}

track::WheelShape out_of_round() {
  track::WheelShape shape;
  shape.polygon_order = 7;
  shape.polygon_amplitude = 3e-4;
  shape.polygon_phase = 0.4;
  shape.flat_length = 0.08;
  shape.flat_angle = 0.3;
  return shape;
}

TEST(WheelContacts, OutOfRoundByTheDistanceRolled) {
  Placed placed(wheelset(1e8, contact::LawKind::linear, out_of_round()), track::Profile::bump(0.5, 2.0, 0.003));
  ASSERT_FALSE(placed.fleet.wheels[0].turns);
  for (double x : {0.05, 0.13, 0.16, 0.7, 1.5}) {
    expect_gradient(placed, {x, R - 1e-3, 0.2});
    expect_rates(placed, {x, R - 1e-3, 0.2}, {2.0, -0.3, 5.0});
  }
}

TEST(WheelContacts, OutOfRoundByItsOwnAngle) {
  Placed placed(wheelset(1e8, contact::LawKind::hertz, out_of_round(), 0.3), track::Profile());
  ASSERT_TRUE(placed.fleet.wheels[0].turns);
  for (double angle : {0.0, -0.25, -0.35, -2.0, -6.6}) {
    const Eigen::Vector3d q(0.3, R - 1e-3, angle), qd(2.0, -0.3, -5.0);
    expect_rates(placed, q, qd);
    placed.put(q);  // without speeds there is no friction
    expect_gradient(placed, q);
  }
}

TEST(WheelContacts, OneEntryOnSmoothTrack) {
  Placed placed(wheelset(1e8, contact::LawKind::linear), track::Profile::bump(0.5, 2.0, 0.003));
  EXPECT_EQ(placed.fleet.wheels.size(), 1u);
}

// All along a sharp bump, with overlaps from none to some millimetres: where points come and go, too. A high one is
// touched beside the ground; over the valleys at the feet of a low one the overlap reaches.
void expect_gradient_along(double height, int& several, int& sharing) {
  Placed placed(wheelset(1e7, contact::LawKind::linear), track::Profile::bump(2.0, 0.1, height));
  ASSERT_EQ(placed.fleet.wheels.size(), 1u + further_entries);
  for (double x = 1.85; x < 2.25; x += 0.00073) {
    const double highest = track::touching_points(placed.profile, R, x).height;
    for (double overlap : {1e-5, 1e-4, 3e-4, 1e-3, 3e-3}) {
      const Eigen::Vector3d q(x, highest - overlap, 0.0);
      expect_gradient(placed, q);
      expect_rates(placed, q, {1.0, -0.3, 0.0});
      int carrying = 0;
      for (const WheelContact& c : placed.fleet.wheels) {
        if (c.force.normal > 0.0) ++carrying;
        if (c.force.normal < 0.0) ++sharing;
      }
      if (carrying > 1) ++several;
      const WheelLoad load = placed.fleet.load(placed.fleet.wheels[0]);  // the deepest alone, up to all of them
      EXPECT_GE(load.normal, 1e7 * load.penetration * (1.0 - 1e-12));
      EXPECT_LE(load.normal, 1e7 * load.penetration * std::max(1, carrying) * (1.0 + 1e-12));
    }
  }
}

TEST(WheelContacts, GradientOfThePotentialOverAHighBump) {
  int several = 0, sharing = 0;
  expect_gradient_along(0.01, several, sharing);
  EXPECT_GT(several, 50);
}

TEST(WheelContacts, GradientOfThePotentialOverALowBump) {
  int several = 0, sharing = 0;
  expect_gradient_along(0.002, several, sharing);
  EXPECT_GT(several, 50);
  EXPECT_GT(sharing, 50);
}

// Corners at the feet of a table's ramp, where the level ground ends.
TEST(WheelContacts, GradientOfThePotentialAtACorner) {
  Placed placed(wheelset(1e7, contact::LawKind::linear),
                track::Profile::spline({2.0, 2.25, 2.5}, {0.0, 0.01, 0.0}, "ramp"));
  ASSERT_EQ(placed.fleet.wheels.size(), 1u + further_entries);
  for (double x = 1.9; x < 2.15; x += 0.00173) {
    const double highest = track::touching_points(placed.profile, R, x).height;
    for (double overlap : {1e-5, 1e-4, 1e-3}) expect_gradient(placed, {x, highest - overlap, 0.0});
  }
}

// h = sqrt(a^2 + s^2 x^2), a valley with smooth ground: slope s far out, curvature s^2/a in the middle.
constexpr double slope = 0.3, bottom = 0.009;
track::Profile valley() {
  std::vector<double> x, h;
  for (int i = -400; i <= 400; ++i) {
    x.push_back(0.002 * i);
    h.push_back(std::hypot(bottom, slope * x.back()));
  }
  return track::Profile::spline(x, h, "valley");
}

// Where h' = tan(angle) and x = R sin(angle).
double angle_of_contact() {
  double low = 1e-3, high = std::atan(slope);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high), x = R * std::sin(middle);
    (slope * slope * x / std::hypot(bottom, slope * x) > std::tan(middle) ? low : high) = middle;
  }
  return low;
}

TEST(WheelContacts, AtRestInAValley) {
  coupling::SystemInput input;
  input.types = {wheelset(1e11, contact::LawKind::linear)};
  input.train.vehicles = {0};
  input.train.positions = {0.0};
  input.profile = valley();
  coupling::System system(MPI_COMM_SELF, nullptr, input);
  std::vector<double> y(static_cast<std::size_t>(system.local_size()));
  system.start(true, y.data());
  const Fleet& fleet = system.fleet();
  const double angle = angle_of_contact(), exact = mass * g / (2.0 * std::cos(angle));
  ASSERT_GT(angle, 0.1);
  std::vector<double> forces;
  for (const WheelContact& c : fleet.wheels)
    if (c.force.normal != 0.0) forces.push_back(c.force.normal);
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_NEAR(forces[0], exact, 1e-5 * exact);
  EXPECT_NEAR(forces[1], exact, 1e-5 * exact);
  EXPECT_NEAR(fleet.load(fleet.wheels[0]).normal, 2.0 * exact, 2e-5 * exact);
  RecordProperty("force_over_statics", std::to_string(forces[0] / exact));
}

TEST(WheelContacts, RoughnessForMorePointsIsRefused) {
  coupling::SystemInput input;
  input.types = {wheelset(1e9, contact::LawKind::linear)};
  input.train.vehicles = {0};
  input.train.positions = {0.0};
  input.profile = track::Profile::rough(track::iso8608('E'), 0.0, 1);
  try {
    coupling::System system(MPI_COMM_SELF, nullptr, input);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("vehicle_axle_wheel_radius"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("at more than 3 points"), std::string::npos);
  }
}

}  // namespace
}  // namespace traverse::train
