// Reverses the signs of x coordinates, angles, moments and asymmetric laws of torsion springs for all parts of a
// vehicle or coupler.
#include "mirrored.hpp"

#include <utility>

namespace traverse::train {
namespace {

void turn(Eigen::Vector2d& point) { point.x() = -point.x(); }

void turn(Eigen::Vector3d& place) {  // x, y, phi
  place.x() = -place.x();
  place.z() = -place.z();
}

void turn(multibody::Joint& joint) {
  for (Eigen::Vector2d* point : {&joint.point, &joint.axis, &joint.from, &joint.to}) turn(*point);
}

void turn(multibody::Spring& spring) {
  turn(spring.from);
  turn(spring.to);
}

/// A twist has the other sign, and so has its moment.
void turn(multibody::TorsionSpring& spring) {
  if (spring.free_angle) spring.free_angle = -*spring.free_angle;
  if (!spring.law) return;
  using multibody::Side;
  multibody::ForceLaw& law = *spring.law;
  law.elastic = law.elastic.reversed();
  law.damper = law.damper.reversed();
  if (law.side != Side::both) law.side = law.side == Side::tension ? Side::compression : Side::tension;
}

void turn(Wheel& wheel) {
  wheel.shape.flat_angle = -wheel.shape.flat_angle;
  wheel.shape.polygon_phase = -wheel.shape.polygon_phase;
}

void turn(contact::BodyContact& contact) {
  for (std::size_t i = 0; i < 2; ++i) {
    turn(contact.centres[i]);
    turn(contact.line[i]);
  }
}

}  // namespace

Vehicle mirrored(Vehicle vehicle) {
  multibody::MechanismModel& model = vehicle.mechanism;
  for (multibody::Body& body : model.bodies) {
    turn(body.position);
    turn(body.velocity);
  }
  for (multibody::Joint& joint : model.joints) turn(joint);
  for (multibody::Spring& spring : model.springs) turn(spring);
  for (multibody::TorsionSpring& spring : model.torsion_springs) turn(spring);
  for (multibody::Actuator& actuator : model.actuators)
    for (const std::size_t along : {0, 2}) actuator.action[along].reverse();
  for (multibody::Driver& driver : model.drivers)
    if (driver.coordinate != 1) driver.value.reverse();
  for (Wheel& wheel : vehicle.wheels) turn(wheel);
  for (contact::BodyContact& contact : vehicle.contacts) turn(contact);
  for (Sensor& sensor : vehicle.sensors) turn(sensor.arm);
  return vehicle;
}

Coupler mirrored(Coupler coupler) {
  if (coupler.joint) turn(*coupler.joint);
  turn(coupler.spring);
  return coupler;
}

}  // namespace traverse::train
