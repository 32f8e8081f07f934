// Reverses the signs of x coordinates, angles, moments and asymmetric laws of torsion springs for all parts of a
// vehicle or coupler.
#include "mirrored.hpp"

#include <utility>

namespace traverse::train {
namespace {

void mirror(Eigen::Vector2d& point) { point.x() = -point.x(); }

void mirror(Eigen::Vector3d& place) {  // x, y, phi
  place.x() = -place.x();
  place.z() = -place.z();
}

void mirror(multibody::Joint& joint) {
  for (Eigen::Vector2d* point : {&joint.point, &joint.axis, &joint.from, &joint.to}) mirror(*point);
}

void mirror(multibody::Spring& spring) {
  mirror(spring.from);
  mirror(spring.to);
}

/// A twist changes its sign, and so does its moment.
void mirror(multibody::TorsionSpring& spring) {
  if (spring.free_angle) spring.free_angle = -*spring.free_angle;
  if (!spring.law) return;
  using base::Side;
  base::ForceLaw& law = *spring.law;
  law.elastic = law.elastic.reversed();
  law.damper = law.damper.reversed();
  if (law.side != Side::both) law.side = law.side == Side::tension ? Side::compression : Side::tension;
}

void mirror(Wheel& wheel) {
  wheel.shape.flat_angle = -wheel.shape.flat_angle;
  wheel.shape.polygon_phase = -wheel.shape.polygon_phase;
}

void mirror(contact::BodyContact& contact) {
  for (std::size_t i = 0; i < 2; ++i) {
    mirror(contact.centres[i]);
    mirror(contact.line[i]);
  }
}

}  // namespace

Vehicle mirrored(Vehicle vehicle) {
  multibody::MechanismModel& model = vehicle.mechanism;
  for (multibody::Body& body : model.bodies) {
    mirror(body.position);
    mirror(body.velocity);
  }
  for (multibody::Joint& joint : model.joints) mirror(joint);
  for (multibody::Spring& spring : model.springs) mirror(spring);
  for (multibody::TorsionSpring& spring : model.torsion_springs) mirror(spring);
  for (multibody::Actuator& actuator : model.actuators)
    for (const std::size_t along : {0, 2}) actuator.action[along].reverse();
  for (multibody::Driver& driver : model.drivers)
    if (driver.coordinate != 1) driver.value.reverse();
  for (Wheel& wheel : vehicle.wheels) mirror(wheel);
  for (contact::BodyContact& contact : vehicle.contacts) mirror(contact);
  for (Sensor& sensor : vehicle.sensors) mirror(sensor.arm);
  return vehicle;
}

Coupler mirrored(Coupler coupler) {
  if (coupler.joint) mirror(*coupler.joint);
  mirror(coupler.spring);
  return coupler;
}

}  // namespace traverse::train
