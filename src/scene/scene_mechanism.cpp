// Reads the mechanism of one vehicle (bodies, joints, springs, actuators, drivers) and the couplers of trains.
#include <fmt/format.h>

#include "traverse/base/error.hpp"
#include "vehicle_reader.hpp"

namespace traverse::scene {

using Eigen::Vector2d;

Coupler VehicleReader::read_coupler(const std::string& name) {
  coupler_ = true;
  part_ = prefix_ + name + "_";
  Coupler c;
  c.name = name;
  options::check_relations(o_, options::Related::part, part_);
  const std::vector<std::string> bodies = o_.texts(key("bodies"));
  c.bodies = {bodies[0], bodies[1]};
  if (o_.choice(key("type")) == "spring") {
    spring(name);
    c.spring = vehicle_.mechanism.springs.back();
  } else {
    joint(name);
    c.joint = vehicle_.mechanism.joints.back();
  }
  return c;
}

void VehicleReader::body(const std::string& name) {
  part_ = prefix_ + name + "_";
  multibody::Body b;
  b.name = name;
  b.mass = number("mass");
  b.inertia = number("inertia");
  const Vector2d position = vector("position");
  b.position = {position.x(), position.y(), number("angle")};
  const std::vector<double> velocity = o_.numbers(key("velocity"));
  b.velocity = {velocity[0], velocity[1], velocity[2]};
  vehicle_.mechanism.bodies.push_back(b);
}

void VehicleReader::joint(const std::string& name) {
  multibody::Joint j;
  j.name = name;
  j.type = multibody::JointType::named(o_.choice(key("type")));
  j.bodies = two_bodies();
  if (j.type->needs.ends) {
    j.from = vector("from");
    j.to = vector("to");
    check_apart(j.from, j.to);
  }
  if (j.type->needs.point) j.point = vector("point");
  if (j.type->needs.axis) {
    j.axis = vector("axis");
    if (!(j.axis.norm() > 0.0)) o_.refuse(key("axis"), "allowed: a direction, not 0, 0");
    j.axis.normalize();
  }
  joint_friction(j);
  joint_numbers(j);
  vehicle_.mechanism.joints.push_back(j);
}

void VehicleReader::joint_friction(multibody::Joint& j) const {
  if (j.type->slides) j.friction = {number("friction"), number("friction_force"), number("transition_speed")};
  for (const char* field : {"friction", "friction_force", "transition_speed"}) {
    if (!has(field)) continue;
    if (!j.type->slides)
      o_.refuse(key(field), "is only for joints that slide: " +
                                multibody::joint_names([](const auto& row) { return row.slides; }, ", ", " or "));
    if (!j.friction.acts() && std::string_view(field) == "transition_speed")
      o_.refuse(key(field), "needs friction or friction_force");
  }
}

/// Reads the additional numbers of this joint type; numbers of other types are refused.
void VehicleReader::joint_numbers(multibody::Joint& j) const {
  for (const multibody::JointRow& row : multibody::joint_rows()) {
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
      const std::string_view field = row.numbers[i].name;
      if (j.type == multibody::JointType(row)) {
        j.numbers[i] = number(field);
      } else if (has(field)) {
        o_.refuse(key(field), fmt::format("is only for joints of type {}", row.name));
      }
    }
  }
}

base::Polyline VehicleReader::polyline(std::string_view field) const {
  return from_table(o_, key(field), rising_pairs,
                    [](const auto& columns) { return base::Polyline(columns[0], columns[1]); });
}

/// The force law of a nonlinear spring; none for a linear one.
std::optional<base::ForceLaw> VehicleReader::force_law() const {
  const std::string side = o_.choice(key("side"));
  base::ForceLaw law;
  law.gap = number("gap");
  law.side = side == "tension"       ? base::Side::tension
             : side == "compression" ? base::Side::compression
                                     : base::Side::both;
  if (!law.can_disengage() && !has("table") && !has("damper_table")) return {};
  law.elastic = has("table") ? polyline("table") : base::Polyline::line(number("stiffness"));
  law.damper = has("damper_table") ? polyline("damper_table") : base::Polyline::line(number("damping"));
  if (const std::string where = law.damper.opposing(); !where.empty())
    o_.refuse(key("damper_table"),
              "the force of a damper must have the sign of the rate, so that it dissipates energy; " + where);
  if (const std::string where = law.can_disengage() ? law.elastic.opposing() : ""; !where.empty())
    o_.refuse(key("table"), "with a gap or a side the force must have the sign of the elongation; " + where);
  return law;
}

void VehicleReader::check_spring_given(std::string_view kind) const {
  for (const char* field : {"stiffness", "damping", "table", "damper_table", "preload"}) {
    if (std::string_view(field) == "preload" && kind != "spring") continue;
    if (has(field)) return;
  }
  o_.refuse(key("stiffness"), fmt::format("missing: a {} needs a stiffness, a damping or a table", kind));
}

void VehicleReader::spring(const std::string& name) {
  multibody::Spring s;
  s.name = name;
  s.bodies = two_bodies();
  s.from = vector("from");
  s.to = vector("to");
  check_apart(s.from, s.to);
  check_spring_given("spring");
  s.law = force_law();
  if (!s.law) {
    s.stiffness = number("stiffness");
    s.damping = number("damping");
  }
  s.free_length = o_.optional_number(key("free_length"));
  s.preload = o_.optional_number(key("preload"));
  if (s.law && s.preload && !s.law->elongation_at(*s.preload)) {
    o_.refuse(key("preload"),
              "allowed: a force that the spring has at exactly one elongation, or " + key("free_length"));
  }
  if (has("winding_table")) s.winding = winding(s.free_length.value_or((s.to - s.from).norm()));
  vehicle_.mechanism.springs.push_back(s);
}

/// Reads the length that a winch adds to a free length, m.
base::TimeFunction VehicleReader::winding(double length) const {
  return from_table(o_, key("winding_table"), rising_pairs, [&](const auto& columns) {
    for (const double change : columns[1])
      if (!(length + change > 0.0))
        throw InputError(fmt::format("the free length {:g} m would not be positive", length + change));
    return base::TimeFunction(columns[0], columns[1]);
  });
}

void VehicleReader::torsion_spring(const std::string& name) {
  multibody::TorsionSpring s;
  s.name = name;
  s.bodies = two_bodies();
  check_spring_given("torsion spring");
  s.law = force_law();
  if (!s.law) {
    s.stiffness = number("stiffness");
    s.damping = number("damping");
  }
  s.free_angle = o_.optional_number(key("free_angle"));
  vehicle_.mechanism.torsion_springs.push_back(s);
}

void VehicleReader::actuator_table(multibody::Actuator& a) const {
  a.action = from_table(o_, key("table"), {2, 4, options::Order::rising}, [](const auto& columns) {
    auto action = multibody::Actuator().action;
    const std::size_t first = columns.size() == 2 ? 2 : 0;  // t,moment or t,fx,fy[,moment]
    for (std::size_t i = 1; i < columns.size(); ++i)
      action[first + i - 1] = base::TimeFunction::piecewise_linear(columns[0], columns[i]);
    return action;
  });
  for (base::TimeFunction& action : a.action) action.delay(number("delay"));
}

void VehicleReader::actuator(const std::string& name) {
  multibody::Actuator a;
  a.name = name;
  if (has("bodies")) {
    a.body = moving_body(key("bodies"), o_.texts(key("bodies"))[0]);
    a.reaction_body = two_bodies()[1];
  } else {
    a.body = moving_body(key("body"), o_.text(key("body")));
    a.reaction_body = index_of(key("reaction_body"), o_.text(key("reaction_body")));
    if (a.reaction_body == a.body) o_.refuse(key("reaction_body"), "allowed: another body");
  }
  if (has("table")) {
    actuator_table(a);
  } else {
    if (!has("force") && !has("moment")) o_.refuse(key("force"), "missing: an actuator needs force, moment or table");
    const Vector2d force = vector("force");
    a.action = {base::TimeFunction(force.x(), 0.0), base::TimeFunction(force.y(), 0.0),
                base::TimeFunction(number("moment"), 0.0)};
  }
  vehicle_.mechanism.actuators.push_back(a);
}

void VehicleReader::driver(const std::string& name) {
  multibody::Driver d;
  d.name = name;
  d.body = moving_body(key("body"), o_.text(key("body")));
  const std::string coordinate = o_.choice(key("coordinate"));
  d.coordinate = coordinate == "x" ? 0 : coordinate == "y" ? 1 : 2;
  if (has("table")) {
    options::WantedColumns wanted = rising_pairs;
    wanted.units = coordinate == "phi" ? "s, rad" : "s, m";
    d.value = from_table(o_, key("table"), wanted,
                         [](const auto& columns) { return base::TimeFunction(columns[0], columns[1]); });
  } else {
    const double initial = vehicle_.mechanism.bodies[static_cast<std::size_t>(d.body)].position[d.coordinate];
    d.value = base::TimeFunction(has("value") ? number("value") : initial, number("rate"));
  }
  vehicle_.mechanism.drivers.push_back(d);
}

Coupler read_coupler(const options::Options& options, const Block& train, const std::string& name) {
  return VehicleReader(options, train).read_coupler(name);
}

Vehicle read_vehicle(const options::Options& options, const std::string& name) {
  return VehicleReader(options, name).read();
}

}  // namespace traverse::scene
