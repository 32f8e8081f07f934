// Adds up gravity, joint reactions, springs, actuators and wheel forces on every body and compares the sum with mass
// times acceleration at every stored instant.
#include "support/newton_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/curve.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using multibody::ground;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The forces and moments that add up on every body at one instant.
class Balance {
 public:
  /// driven: whether the train's drive prescribes x of its first body.
  Balance(Results& run, const train::Vehicle& vehicle, std::string group, double gravity, bool driven, std::size_t row)
      : run_(run), vehicle_(vehicle), model_(vehicle.mechanism), group_(std::move(group)), row_(row) {
    const multibody::MechanismModel& model = model_;
    for (const multibody::Body& body : model.bodies) {
      position_.push_back(triple(group_ + body.name + "/position"));
      sum_.emplace_back(0.0, -body.mass * gravity, 0.0);
      free_.emplace_back(Vector3d::Ones());
    }
    if (driven) free_[0].x() = 0.0;
    for (const multibody::Driver& d : model.drivers) free_[static_cast<std::size_t>(d.body)][d.coordinate] = 0.0;
    for (const multibody::Joint& joint : model.joints) add(joint);
    for (const multibody::Spring& spring : model.springs) add(spring);
    for (const multibody::TorsionSpring& spring : model.torsion_springs) {
      const double moment = run(group_ + spring.name + "/moment")[row];
      pair(spring.bodies, {}, {}, Vector3d(0.0, 0.0, moment));
    }
    for (const multibody::Actuator& actuator : model.actuators) {
      const double t = run("/time")[row];
      const Vector3d action(actuator.action[0].value(t), actuator.action[1].value(t), actuator.action[2].value(t));
      force(actuator.body, centre(actuator.body), action);
      if (actuator.reaction_body != ground) force(actuator.reaction_body, centre(actuator.reaction_body), -action);
    }
  }

  void compare(Imbalance& worst, Imbalance& scale) {
    for (const train::Wheel& wheel : vehicle_.wheels) add(wheel, worst);
    for (std::size_t b = 0; b < sum_.size(); ++b) {
      const multibody::Body& body = model_.bodies[b];
      const Vector3d a = triple(group_ + body.name + "/acceleration");
      const Vector3d left =
          (sum_[b] - Vector3d(body.mass, body.mass, body.inertia).cwiseProduct(a)).cwiseProduct(free_[b]);
      worst.force = std::max(worst.force, left.head<2>().norm());
      worst.moment = std::max(worst.moment, std::abs(left.z()));
    }
    scale.force = std::max(scale.force, largest_.force);
    scale.moment = std::max(scale.moment, largest_.moment);
  }

 private:
  Vector3d triple(const std::string& name) { return Eigen::Map<const Vector3d>(&run_(name)[3 * row_]); }
  Vector2d centre(int body) const { return position_[static_cast<std::size_t>(body)].head<2>(); }

  /// The present position of a body's point that is given at t = 0.
  Vector2d now(int body, const Vector2d& point) const {
    if (body == ground) return point;
    const Vector3d& start = model_.bodies[static_cast<std::size_t>(body)].position;
    const Vector3d& q = position_[static_cast<std::size_t>(body)];
    return q.head<2>() + Eigen::Rotation2Dd(q.z() - start.z()) * (point - start.head<2>());
  }

  /// A force at a point and a moment on a body.
  void force(int body, const Vector2d& at, const Vector3d& f) {
    if (body == ground) return;
    const double moment = f.z() + cross(at - centre(body), f.head<2>());
    sum_[static_cast<std::size_t>(body)] += Vector3d(f.x(), f.y(), moment);
    largest_.force = std::max(largest_.force, f.head<2>().norm());
    largest_.moment = std::max(largest_.moment, std::abs(moment));
  }
  void pair(const std::array<int, 2>& bodies, const Vector2d& first, const Vector2d& second,
            const Vector3d& on_second) {
    force(bodies[0], first, -on_second);
    force(bodies[1], second, on_second);
  }

  /// The results have the normal and tangential parts of the track's force on a wheel, but not its direction. Therefore
  /// the sum of all other forces must have the same magnitude. Friction acts at the surface.
  void add(const train::Wheel& wheel, Imbalance& worst) {
    const auto value = [&](const char* what) { return run_(group_ + wheel.name + what)[row_]; };
    const std::size_t b = static_cast<std::size_t>(wheel.body);
    const multibody::Body& body = model_.bodies[b];
    const double normal = value("/normal_force"), friction = value("/friction_force");
    const Vector3d a = triple(group_ + body.name + "/acceleration");
    const Vector2d missing = body.mass * a.head<2>() - sum_[b].head<2>();
    worst.force = std::max(worst.force, std::abs(missing.norm() - std::hypot(normal, friction)));
    const double arm = wheel.radius - value("/penetration");
    force(wheel.body, centre(wheel.body), Vector3d(missing.x(), missing.y(), -friction * arm));
  }

  void add(const multibody::Joint& joint) {
    const bool rod = joint.type == multibody::JointType::distance;
    const Vector2d at = now(joint.bodies[1], rod ? joint.to : joint.point);
    pair(joint.bodies, at, at, triple(group_ + joint.name + "/reaction"));
  }
  void add(const multibody::Spring& spring) {
    const Vector2d from = now(spring.bodies[0], spring.from), to = now(spring.bodies[1], spring.to);
    const Vector2d pull = run_(group_ + spring.name + "/force")[row_] * (from - to).normalized();
    pair(spring.bodies, from, to, Vector3d(pull.x(), pull.y(), 0.0));
  }

  Results& run_;
  const train::Vehicle& vehicle_;
  const multibody::MechanismModel& model_;
  std::string group_;
  std::size_t row_;
  std::vector<Vector3d> position_, sum_;
  std::vector<Vector3d>
      free_;  // 0 for a coordinate that a driver prescribes, because the results do not contain its force; otherwise 1
  Imbalance largest_;
};

}  // namespace

Imbalance newton_imbalance(Results& run, int vehicle) {
  const scene::Scene scene = scene::read_scene();
  const train::Vehicle& type =
      scene.vehicles.at(static_cast<std::size_t>(scene.train.vehicles.at(static_cast<std::size_t>(vehicle))));
  const bool driven = !type.wheels.empty() && scene.train.drive == train::Drive::constant;
  const std::string group = "/vehicles/" + std::to_string(vehicle) + "/";
  Imbalance worst, scale;
  for (std::size_t row = 0; row < run("/time").size(); ++row)
    Balance(run, type, group, scene.gravity, driven, row).compare(worst, scale);
  if (scale.force > 0.0) worst.force /= scale.force;  // without any force, every acceleration is an error
  if (scale.moment > 0.0) worst.moment /= scale.moment;
  return worst;
}

void expect_newton(Results& run) {
  const Imbalance worst = newton_imbalance(run);
  testing::Test::RecordProperty("newton_force", text(worst.force));
  testing::Test::RecordProperty("newton_moment", text(worst.moment));
  EXPECT_LT(worst.force, 1e-9);
  EXPECT_LT(worst.moment, 1e-9);
}

}  // namespace traverse::test
