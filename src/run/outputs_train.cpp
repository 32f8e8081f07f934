// Outputs of the train: bodies, wheels and other contacts, joints, springs, and the couplers between vehicles.
#include <Eigen/Geometry>

#include "output_groups.hpp"

namespace traverse::run {
namespace {

using Triple = std::array<double, 3>;
constexpr auto identity = [](const auto& numbers) { return numbers; };

struct BodyMotion {
  Triple position, velocity, acceleration;  // x, y, angle
};

constexpr Row<BodyMotion> body_rows[] = {
    {"position", "m, m, rad", of<&BodyMotion::position>},
    {"velocity", "m/s, m/s, rad/s", of<&BodyMotion::velocity>},
    {"acceleration", "m/s2, m/s2, rad/s2", of<&BodyMotion::acceleration>},
};

constexpr Row<train::WheelLoad> wheel_rows[] = {
    {"normal_force", "N", of<&train::WheelLoad::normal>},
    {"friction_force", "N", of<&train::WheelLoad::tangential>},
    {"penetration", "m", of<&train::WheelLoad::penetration>},
};

constexpr Row<coupling::ContactPoint> contact_point_rows[] = {
    {"contact_position", "m, m", of<&coupling::ContactPoint::position>},
    {"contact_velocity", "m/s, m/s", of<&coupling::ContactPoint::velocity>},
    {"contact_acceleration", "m/s2, m/s2", of<&coupling::ContactPoint::acceleration>},
};

// A point of a body: x'' = x_b'' + phi'' k x r - phi'^2 r with r from the centre of mass, in the ground's axes.
struct SensorMotion {
  double x = 0.0, y = 0.0;                            // m
  double acceleration_x = 0.0, acceleration_y = 0.0;  // m/s2
  double pitch_rate = 0.0;                            // rad/s
};

constexpr Row<SensorMotion> sensor_rows[] = {
    {"position_x", "m", of<&SensorMotion::x>},
    {"position_y", "m", of<&SensorMotion::y>},
    {"acceleration_x", "m/s2", of<&SensorMotion::acceleration_x>},
    {"acceleration_y", "m/s2", of<&SensorMotion::acceleration_y>},
    {"pitch_rate", "rad/s", of<&SensorMotion::pitch_rate>},
};

// The reaction of a joint on its second body.
constexpr Row<Triple> joint_rows[] = {{"reaction", "N, N, N m", identity}};
constexpr Row<double> spring_rows[] = {{"force", "N", identity}};  // positive in tension; also of ropes
constexpr Row<double> torsion_spring_rows[] = {{"moment", "N m", identity}};

// The reaction of a joint on the rear vehicle.
constexpr Row<Triple> coupler_rows[] = {
    {"fx", "N", [](const Triple& r) { return r[0]; }},
    {"fy", "N", [](const Triple& r) { return r[1]; }},
    {"moment", "N m", [](const Triple& r) { return r[2]; }},
};

Triple triple(const Eigen::VectorXd& x, std::size_t body) {
  const auto i = 3 * static_cast<Eigen::Index>(body);
  return {x[i], x[i + 1], x[i + 2]};
}

SensorMotion sensor_motion(const multibody::MechanismState& state, std::size_t body, const Eigen::Vector2d& arm) {
  const Triple q = triple(state.q, body), rate = triple(state.qd, body), a = triple(state.qdd, body);
  const Eigen::Vector2d r = Eigen::Rotation2Dd(q[2]) * arm;
  const double squared = rate[2] * rate[2];
  return {q[0] + r.x(), q[1] + r.y(), a[0] - a[2] * r.y() - squared * r.x(), a[1] + a[2] * r.x() - squared * r.y(),
          rate[2]};
}

Triple reaction(const train::MovingVehicle& unit, int joint) {
  const Eigen::Vector3d r = unit.mechanism.joint_reaction(unit.state, joint);
  return {r.x(), r.y(), r.z()};
}

double spring_tension(const train::MovingVehicle& unit, int spring) {
  return unit.mechanism.spring_tension(unit.state, spring);
}

/// The outputs of one vehicle of the train.
class VehicleOutputs {
 public:
  VehicleOutputs(const Source& source, std::size_t number, Outputs& outputs)
      : fleet_(source.fleet),
        contact_points_(source.scene.output.contact_points),
        member_(fleet_.members[number]),
        unit_(static_cast<std::size_t>(member_.unit)),
        group_("/vehicles/" + std::to_string(number) + "/"),
        outputs_(outputs) {}

  void add() {
    add_bodies();
    add_sensors();
    add_contacts();
    add_joints();
  }

 private:
  std::string group(const std::string& part) const { return group_ + part + "/"; }

  void add_bodies() {
    std::size_t body = member_.first_body;
    for (const multibody::Body& b : member_.type->mechanism.bodies)
      outputs_.add(group(b.name), body_rows, [&fleet = fleet_, unit = unit_, i = body++](const Observed&) {
        const multibody::MechanismState& state = fleet.vehicles[unit].state;
        return BodyMotion{triple(state.q, i), triple(state.qd, i), triple(state.qdd, i)};
      });
  }

  void add_sensors() {
    for (const train::Sensor& s : member_.type->sensors)
      outputs_.add(
          group(s.name), sensor_rows,
          [&fleet = fleet_, unit = unit_, arm = s.arm, i = static_cast<std::size_t>(member_.first_body + s.body)](
              const Observed&) { return sensor_motion(fleet.vehicles[unit].state, i, arm); });
  }

  void add_contacts() {
    const train::MovingVehicle& unit = fleet_.vehicles[unit_];
    std::size_t wheel = unit.first_wheel + member_.first_wheel, pair = unit.first_pair + member_.first_contact;
    for (const train::Wheel& w : member_.type->wheels) {
      outputs_.add(group(w.name), wheel_rows,
                   [&fleet = fleet_, i = wheel](const Observed&) { return fleet.load(fleet.wheels[i]); });
      if (contact_points_)
        outputs_.add(group(w.name), contact_point_rows,
                     [i = wheel](const Observed& now) { return now.motion.contact_points[i]; });
      ++wheel;
    }
    for (const contact::BodyContact& c : member_.type->contacts)
      outputs_.add(group(c.name), wheel_rows, [&fleet = fleet_, i = pair++](const Observed&) {
        const train::Contact& now = fleet.pairs[i];
        return train::WheelLoad{now.force.normal, now.force.tangential, now.kinematics.penetration};
      });
  }

  void add_joints() {
    const multibody::MechanismModel& model = member_.type->mechanism;
    int joint = member_.first_joint, spring = member_.first_spring, torsion = member_.first_torsion_spring,
        rope = member_.first_rope;
    for (const multibody::Joint& j : model.joints)
      outputs_.add(group(j.name), joint_rows, [&fleet = fleet_, unit = unit_, i = joint++](const Observed&) {
        return reaction(fleet.vehicles[unit], i);
      });
    for (const multibody::Spring& s : model.springs)
      outputs_.add(group(s.name), spring_rows, [&fleet = fleet_, unit = unit_, i = spring++](const Observed&) {
        return spring_tension(fleet.vehicles[unit], i);
      });
    for (const multibody::TorsionSpring& s : model.torsion_springs)
      outputs_.add(group(s.name), torsion_spring_rows, [&fleet = fleet_, unit = unit_, i = torsion++](const Observed&) {
        const train::MovingVehicle& now = fleet.vehicles[unit];
        return now.mechanism.torsion_spring_moment(now.state, i);
      });
    for (const multibody::Rope& r : model.ropes)
      outputs_.add(group(r.name), spring_rows, [&fleet = fleet_, unit = unit_, i = rope++](const Observed&) {
        const train::MovingVehicle& now = fleet.vehicles[unit];
        return now.mechanism.rope_tension(now.state, i);
      });
  }

  const train::Fleet& fleet_;
  bool contact_points_;
  const train::Member& member_;
  std::size_t unit_;  // index in fleet.vehicles, whose address may change
  std::string group_;
  Outputs& outputs_;
};

}  // namespace

void add_vehicles(const Source& source, Outputs& outputs) {
  for (std::size_t k = 0; k < source.fleet.members.size(); ++k) VehicleOutputs(source, k, outputs).add();
}

void add_couplers(const Source& source, Outputs& outputs) {
  std::size_t first = 0;  // index of the coupler's first gap
  for (const train::Coupler& c : source.scene.train.couplers) {
    const std::string group = "/couplers/" + c.name + "/";
    outputs.add_constant(group + "gap", {c.gaps.begin(), c.gaps.end()}, "1");
    const auto joint = [&fleet = source.fleet, first](const Observed&, std::size_t i) {
      const train::CoupledGap& gap = fleet.couplers[first + i];
      return reaction(fleet.vehicles[gap.unit], gap.part);
    };
    const auto spring = [&fleet = source.fleet, first](const Observed&, std::size_t i) {
      const train::CoupledGap& gap = fleet.couplers[first + i];
      return spring_tension(fleet.vehicles[gap.unit], gap.part);
    };
    if (c.joint)
      outputs.add_each(group, coupler_rows, c.gaps.size(), joint);
    else
      outputs.add_each(group, spring_rows, c.gaps.size(), spring);
    first += c.gaps.size();
  }
}

}  // namespace traverse::run
