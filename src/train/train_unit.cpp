// Joins the bodies, joints and springs of coupled vehicles in one mechanism, and adds the driving constraint of a
// prescribed speed (a rheonomic constraint of equation 43 of the paper). For a mirror image, the signs of x
// coordinates, angles, moments and asymmetric laws of torsion springs are reversed for all parts of a vehicle or
// coupler.
#include "train/train_unit.hpp"

#include <algorithm>
#include <utility>

namespace traverse::train {
namespace {

using multibody::MechanismModel;

base::TimeFunction frozen_function(const base::TimeFunction& f) { return {f.value(0.0), 0.0}; }

bool drives_x(const MechanismModel& model) {
  return std::any_of(model.drivers.begin(), model.drivers.end(),
                     [](const multibody::Driver& d) { return d.coordinate == 0; });
}

bool has_gap(const Coupler& coupler, int gap) {
  return std::find(coupler.gaps.begin(), coupler.gaps.end(), gap) != coupler.gaps.end();
}

/// Adds parts of a vehicle at x to a unit, with their bodies numbered from `first_body`.
class Placement {
 public:
  Placement(double x, int first_body, std::string prefix) : x_(x), first_(first_body), prefix_(std::move(prefix)) {}

  void name(std::string& text) const { text = prefix_ + text; }
  void body(int& index) const {
    if (index != multibody::ground) index += first_;
  }
  template <class Pair>
  void bodies(Pair& pair) const {
    for (int& index : pair) body(index);
  }
  void point(Eigen::Vector2d& p) const { p.x() += x_; }
  double x() const { return x_; }

 private:
  double x_;
  int first_;
  std::string prefix_;
};

void add_vehicle(const Vehicle& type, const Placement& to, double speed, Unit& unit) {
  MechanismModel& all = unit.mechanism;
  for (multibody::Body b : type.mechanism.bodies) {
    to.name(b.name);
    b.position.x() += to.x();
    b.velocity.x() += speed;
    all.bodies.push_back(std::move(b));
  }
  for (multibody::Joint j : type.mechanism.joints) {
    to.name(j.name);
    to.bodies(j.bodies);
    for (Eigen::Vector2d* p : {&j.point, &j.from, &j.to}) to.point(*p);
    all.joints.push_back(std::move(j));
  }
  for (multibody::Spring s : type.mechanism.springs) {
    to.name(s.name);
    to.bodies(s.bodies);
    to.point(s.from);
    to.point(s.to);
    all.springs.push_back(std::move(s));
  }
  for (multibody::TorsionSpring s : type.mechanism.torsion_springs) {
    to.name(s.name);
    to.bodies(s.bodies);
    all.torsion_springs.push_back(std::move(s));
  }
  for (multibody::Rope r : type.mechanism.ropes) {
    to.name(r.name);
    to.bodies(r.bodies);
    to.body(r.drum);
    for (Eigen::Vector2d& p : r.points) to.point(p);
    all.ropes.push_back(std::move(r));
  }
  for (multibody::Actuator a : type.mechanism.actuators) {
    to.name(a.name);
    to.body(a.body);
    to.body(a.reaction_body);
    all.actuators.push_back(std::move(a));
  }
  for (multibody::Driver d : type.mechanism.drivers) {
    to.name(d.name);
    to.body(d.body);
    if (d.coordinate == 0) d.value.shift(to.x());
    all.drivers.push_back(std::move(d));
  }
  for (Wheel w : type.wheels) {
    to.body(w.body);
    unit.wheels.push_back(std::move(w));
  }
  for (contact::BodyContact c : type.contacts) {
    to.bodies(c.bodies);
    for (std::size_t i = 0; i < 2; ++i) {
      to.point(c.centres[i]);
      to.point(c.line[i]);
    }
    unit.contacts.push_back(std::move(c));
  }
}

/// The driving constraint of a train with prescribed speed: x of a vehicle's first body.
void add_drive(const Placement& to, const base::SpeedLaw& speed, Unit& unit) {
  MechanismModel& model = unit.mechanism;
  multibody::Driver drive{"drive", 0, 0, {}};
  to.name(drive.name);
  to.body(drive.body);
  drive.value = speed.from(model.bodies[static_cast<std::size_t>(drive.body)].position.x());
  unit.drives.push_back(static_cast<int>(model.drivers.size()));
  unit.speed = speed;
  model.drivers.push_back(drive);
}

Member next_member(const Vehicle& type, int number, const Unit& unit) {
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  const MechanismModel& m = unit.mechanism;
  return {&type,
          number,
          size(m.bodies),
          size(m.joints),
          size(m.springs),
          size(m.torsion_springs),
          size(m.ropes),
          size(unit.wheels),
          size(unit.contacts)};
}

int body_named(const Vehicle& type, const std::string& name) {
  const auto& bodies = type.mechanism.bodies;
  const auto same = [&](const multibody::Body& b) { return b.name == name; };
  return static_cast<int>(std::find_if(bodies.begin(), bodies.end(), same) - bodies.begin());
}

/// A coupler's part between two neighbours. Its points refer to the front vehicle's origin, `to` to the rear vehicle's
/// origin.
template <class Part>
Part placed(Part part, const Coupler& coupler, const std::array<const Member*, 2>& ends, double front, double rear) {
  for (std::size_t i = 0; i < 2; ++i)
    part.bodies[i] = ends[i]->first_body + body_named(*ends[i]->type, coupler.bodies[i]);
  part.from.x() += front;
  part.to.x() += rear;
  return part;
}

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

void mirror(multibody::Rope& rope) {
  for (Eigen::Vector2d& point : rope.points) mirror(point);
  rope.drum_radius = -rope.drum_radius;
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

AssembledTrain assemble(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen) {
  AssembledTrain all;
  const int count = static_cast<int>(train.vehicles.size());
  const auto joined = [&](int gap) {
    return std::any_of(train.couplers.begin(), train.couplers.end(), [&](const Coupler& c) { return has_gap(c, gap); });
  };
  const auto follows = [&](int k) {  // the neighbour determines its position along the track
    return std::any_of(train.couplers.begin(), train.couplers.end(),
                       [&](const Coupler& c) { return c.joint && has_gap(c, k - 1); });
  };
  for (int k = 0; k < count; ++k) {
    const Vehicle& type = types[static_cast<std::size_t>(train.vehicles[k])];
    const bool begins_unit = k == 0 || !joined(k - 1);
    if (begins_unit) {
      Unit unit;
      unit.mechanism.name = type.mechanism.name;
      unit.mechanism.gravity = gravity;
      unit.mechanism.gradient = type.mechanism.gradient;
      all.units.push_back(std::move(unit));
    }
    Unit& unit = all.units.back();
    const bool single = begins_unit && (k + 1 == count || !joined(k));
    if (!single) unit.mechanism.name = "train";
    const Member member = next_member(type, static_cast<int>(all.units.size()) - 1, unit);
    const Placement to(train.positions[k], member.first_body, single ? "" : std::to_string(k) + ".");
    const auto number = static_cast<std::size_t>(k);
    const base::SpeedLaw speed = law_of(train, number);
    add_vehicle(type, to, speed.speed(0.0), unit);
    const bool rolls = !type.wheels.empty() && !drives_x(type.mechanism) && !follows(k);
    if (rolls && (frozen || drive_of(train, number) == Drive::constant)) add_drive(to, speed, unit);
    all.members.push_back(member);
  }
  for (std::size_t i = 0; i < train.couplers.size(); ++i) {
    const Coupler& coupler = train.couplers[i];
    for (const int gap : coupler.gaps) {
      const std::array<const Member*, 2> ends = {&all.members[gap], &all.members[gap + 1]};
      MechanismModel& model = all.units[ends[0]->unit].mechanism;
      const double front = train.positions[gap], rear = train.positions[gap + 1];
      const int part = static_cast<int>(coupler.joint ? model.joints.size() : model.springs.size());
      if (coupler.joint) {
        model.joints.push_back(placed(*coupler.joint, coupler, ends, front, rear));
        model.joints.back().point.x() += front;
      } else {
        model.springs.push_back(placed(coupler.spring, coupler, ends, front, rear));
      }
      all.couplers.push_back({static_cast<int>(i), ends[0]->unit, part});
    }
  }
  for (Unit& unit : all.units) {
    if (!frozen) break;
    for (multibody::Driver& d : unit.mechanism.drivers) d.value = frozen_function(d.value);
    for (multibody::Spring& s : unit.mechanism.springs)
      if (s.winding) s.winding = frozen_function(*s.winding);
    for (multibody::Rope& r : unit.mechanism.ropes)
      if (r.winding) r.winding = frozen_function(*r.winding);
  }
  return all;
}

Vehicle mirrored(Vehicle vehicle) {
  multibody::MechanismModel& model = vehicle.mechanism;
  for (multibody::Body& body : model.bodies) {
    mirror(body.position);
    mirror(body.velocity);
  }
  for (multibody::Joint& joint : model.joints) mirror(joint);
  for (multibody::Spring& spring : model.springs) mirror(spring);
  for (multibody::TorsionSpring& spring : model.torsion_springs) mirror(spring);
  for (multibody::Rope& rope : model.ropes) mirror(rope);
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
