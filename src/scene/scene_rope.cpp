// Reads the ropes of a vehicle. A rope with a given length moves the bodies that hang on it, with the points of all
// parts on them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vehicle_reader.hpp"

namespace traverse::scene {
namespace {

using Eigen::Vector2d;

constexpr int most_steps = 60;  // of Newton's method, which is monotone here
constexpr double rounding_of_length = 1e-13;

/// The length of a rope whose marked points are moved up by y, m, and its derivative.
struct MovedLength {
  double length = 0.0, slope = 0.0;
};
MovedLength moved_length(const multibody::Rope& rope, const std::vector<bool>& moves, double y) {
  MovedLength sum;
  for (std::size_t i = 0; i + 1 < rope.points.size(); ++i) {
    const double share = (moves[i + 1] ? 1.0 : 0.0) - (moves[i] ? 1.0 : 0.0);
    const Vector2d fall = rope.points[i + 1] - rope.points[i] + Vector2d(0.0, share * y);
    sum.length += fall.norm();
    if (fall.norm() > 0.0) sum.slope += share * fall.y() / fall.norm();
  }
  return sum;
}

/// By how much to move the marked points up so that the rope has this length; none if it is always longer. The length
/// is a convex function of y, so that Newton's method from a low position approaches the solution from below.
std::optional<double> lift_to(const multibody::Rope& rope, const std::vector<bool>& moves, double length) {
  double y = -length - multibody::path_length(rope);
  for (int step = 0; step < most_steps; ++step) {
    const MovedLength now = moved_length(rope, moves, y);
    if (!(now.slope < 0.0)) return {};
    const double change = (length - now.length) / now.slope;
    y += change;
    if (std::abs(change) <= rounding_of_length * length) return y;
  }
  return {};
}

}  // namespace

void VehicleReader::rope(const std::string& name) {
  multibody::Rope r;
  r.name = name;
  for (const std::string& body : o_.texts(key("bodies"))) r.bodies.push_back(index_of(key("bodies"), body));
  const std::vector<double> points = o_.numbers(key("points"));
  if (points.size() != 2 * r.bodies.size() || r.bodies.size() < 2)
    o_.refuse(key("points"), fmt::format("allowed: x, y of each of the {} points of {}, at least two points",
                                         r.bodies.size(), key("bodies")));
  for (std::size_t i = 0; i < r.bodies.size(); ++i) r.points.emplace_back(points[2 * i], points[2 * i + 1]);
  if (!has("stiffness") && !has("EA")) o_.refuse(key("stiffness"), "missing: a rope needs a stiffness or EA");
  r.stiffness = o_.optional_number(key("stiffness")).value_or(0.0);
  r.axial_rigidity = o_.optional_number(key("EA")).value_or(0.0);
  r.damping = number("damping");
  r.free_length = o_.optional_number(key("free_length"));
  r.preload = o_.optional_number(key("preload"));
  if (has("drum")) {
    r.drum = moving_body(key("drum"), o_.text(key("drum")));
    r.drum_radius = number("drum_radius");
    if (r.drum == r.bodies.back())
      o_.refuse(key("drum"), "allowed: another body than that of the last point, which carries the drum");
  }
  if (has("length")) lift(r);
  if (!(multibody::unstretched_length(r) > 0.0))
    o_.refuse(key("preload"),
              fmt::format("allowed: a tension that stretches the rope by less than its length of {:g} m",
                          multibody::path_length(r)));
  if (has("winding_table")) r.winding = winding(multibody::unstretched_length(r));
  vehicle_.mechanism.ropes.push_back(r);
}

/// Moves the points of the rope, and remembers the bodies that lift_bodies moves with all that is fixed to them.
void VehicleReader::lift(multibody::Rope& rope) {
  std::vector<int> hanging;
  for (const std::string& body : o_.texts(key("lifts"))) {
    hanging.push_back(moving_body(key("lifts"), body));
    for (const Lift& other : lifts_)
      if (other.moves(hanging.back()))
        o_.refuse(key("lifts"), fmt::format("'{}' already has its place by the length of another rope", body));
  }
  std::vector<bool> moves;
  const Lift probe{rope.name, hanging, 0.0};
  for (const int body : rope.bodies) moves.push_back(probe.moves(body));
  const std::optional<double> up = lift_to(rope, moves, number("length"));
  if (!up)
    o_.refuse(key("length"), "allowed: a length at which the bodies of lifts hang below the other points of the rope");
  for (std::size_t i = 0; i < moves.size(); ++i)
    if (moves[i]) rope.points[i].y() += *up;
  lifts_.push_back({rope.name, hanging, *up});
}

void VehicleReader::lift_bodies() {
  multibody::MechanismModel& model = vehicle_.mechanism;
  for (const Lift& lift : lifts_) {
    const Vector2d up(0.0, lift.up);
    const auto move = [&](int body, Vector2d& point) {
      if (lift.moves(body)) point += up;
    };
    for (const int body : lift.bodies) model.bodies[static_cast<std::size_t>(body)].position.y() += lift.up;
    for (multibody::Joint& joint : model.joints) {
      const bool first = lift.moves(joint.bodies[0]), second = lift.moves(joint.bodies[1]);
      if (first && second) joint.point += up;
      move(joint.bodies[0], joint.from);
      move(joint.bodies[1], joint.to);
      const bool slides = joint.type == multibody::JointType::prismatic || joint.type == multibody::JointType::slot;
      if (first != second && !slides && !joint.type->needs.ends)
        o_.refuse(
            fmt::format("{}{}_lifts", prefix_, lift.rope),
            fmt::format("joint '{}' holds one of these bodies at another one; allowed: both in lifts", joint.name));
    }
    for (multibody::Spring& spring : model.springs) {
      move(spring.bodies[0], spring.from);
      move(spring.bodies[1], spring.to);
    }
    for (multibody::Rope& rope : model.ropes)
      for (std::size_t i = 0; i < rope.points.size() && rope.name != lift.rope; ++i)
        move(rope.bodies[i], rope.points[i]);
    for (multibody::Driver& driver : model.drivers)
      if (driver.coordinate == 1 && lift.moves(driver.body)) driver.value.shift(lift.up);
    for (contact::BodyContact& contact : vehicle_.contacts)
      for (std::size_t i = 0; i < 2; ++i) {
        move(contact.bodies[i], contact.centres[i]);
        move(contact.bodies[1], contact.line[i]);
      }
    for (const Wheel& wheel : vehicle_.wheels)
      if (lift.moves(wheel.body))
        o_.refuse(fmt::format("{}{}_lifts", prefix_, lift.rope),
                  fmt::format("wheel '{}' is fixed to one of these bodies and stays on the track", wheel.name));
  }
}

}  // namespace traverse::scene
