// One vehicle's parts out of the options: bodies, joints, springs, wheels, actuators, drivers.
#include <fmt/format.h>

#include <numbers>

#include "scene_parts.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/data_file.hpp"

namespace traverse::app {
namespace {

using Eigen::Vector2d;
using options::Part;

class VehicleReader {
 public:
  VehicleReader(const options::Options& options, const std::string& name)
      : o_(options), prefix_("vehicle_" + name + "_") {
    vehicle_.name = name;
    vehicle_.mechanism.name = name;
  }

  /// Reads the parts of a train instead: prefix train_.
  explicit VehicleReader(const options::Options& options) : o_(options), prefix_("train_") {}
  Coupler read_coupler(const std::string& name);

  Vehicle read() {
    vehicle_.mechanism.gravity = o_.number("gravity");
    if (!o_.has(prefix_ + "bodies")) o_.refuse(prefix_ + "bodies", "a vehicle needs at least one body");
    bodies_ = o_.texts(prefix_ + "bodies");
    for (const std::string& name : bodies_) body(name);
    each(Part::joint, [this](const std::string& name) { joint(name); });
    each(Part::spring, [this](const std::string& name) { spring(name); });
    each(Part::torsion_spring, [this](const std::string& name) { torsion_spring(name); });
    each(Part::wheel, [this](const std::string& name) { wheel(name); });
    each(Part::actuator, [this](const std::string& name) { actuator(name); });
    each(Part::driver, [this](const std::string& name) { driver(name); });
    each(Part::contact, [this](const std::string& name) { body_contact(name); });
    return std::move(vehicle_);
  }

 private:
  template <class Read>
  void each(Part part, Read&& read) {
    const std::string list = prefix_ + std::string(options::part_list(part));
    if (!o_.has(list)) return;
    for (const std::string& name : o_.texts(list)) {
      part_ = prefix_ + name + "_";
      read(name);
    }
  }

  std::string key(std::string_view field) const { return part_ + std::string(field); }
  bool has(std::string_view field) const { return o_.has(key(field)); }
  double number(std::string_view field) const { return o_.number(key(field)); }
  Vector2d vector(std::string_view field) const {
    const std::vector<double> v = o_.numbers(key(field));
    return {v[0], v[1]};
  }

  int index_of(const std::string& option, const std::string& name) const {
    if (name == "ground") return multibody::ground;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i] == name) return static_cast<int>(i);
    }
    const std::string near = options::nearest(name, bodies_);
    o_.refuse(option, fmt::format("there is no body '{}' in {}bodies{}", name, prefix_,
                                  near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }

  int moving_body(const std::string& option, const std::string& name) const {
    const int index = index_of(option, name);
    if (index == multibody::ground) o_.refuse(option, "ground does not move; allowed: one of " + prefix_ + "bodies");
    return index;
  }

  std::array<int, 2> two_bodies() const {
    if (coupler_) return {0, 1};
    const std::vector<std::string> names = o_.texts(key("bodies"));
    if (names[0] == names[1]) o_.refuse(key("bodies"), "allowed: two different bodies");
    return {index_of(key("bodies"), names[0]), index_of(key("bodies"), names[1])};
  }

  void check_apart(const Vector2d& from, const Vector2d& to) const {
    if (coupler_ || (to - from).norm() > 0.0) return;  // a coupler's points count from two origins
    o_.refuse(key("to"), "from and to are the same point: the direction between them is not defined");
  }

  void body(const std::string& name);
  void joint(const std::string& name);
  multibody::Polyline polyline(std::string_view field) const;
  std::optional<multibody::ForceLaw> force_law() const;
  void check_spring_given(std::string_view kind) const;
  void spring(const std::string& name);
  void torsion_spring(const std::string& name);
  void wheel(const std::string& name);
  contact::Law law(double radius, const std::string& other) const;
  track::WheelShape wheel_shape(double radius) const;
  double stiffness(contact::LawKind kind, double radius, const std::string& other) const;
  void body_contact(const std::string& name);
  void actuator(const std::string& name);
  void actuator_table(multibody::Actuator& a) const;
  void driver(const std::string& name);

  const options::Options& o_;
  std::string prefix_;  // vehicle_NAME_
  std::string part_;    // vehicle_NAME_PART_
  std::vector<std::string> bodies_;
  Vehicle vehicle_;
  bool coupler_ = false;
};

Coupler VehicleReader::read_coupler(const std::string& name) {
  coupler_ = true;
  part_ = prefix_ + name + "_";
  Coupler c;
  c.name = name;
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
  const std::string type = o_.choice(key("type"));
  j.bodies = two_bodies();
  if (type == "distance") {
    j.type = multibody::JointType::distance;
    j.from = vector("from");
    j.to = vector("to");
    check_apart(j.from, j.to);
  } else {
    j.type = type == "revolute"    ? multibody::JointType::revolute
             : type == "prismatic" ? multibody::JointType::prismatic
             : type == "slot"      ? multibody::JointType::slot
                                   : multibody::JointType::weld;
    j.point = vector("point");
  }
  if (type == "prismatic" || type == "slot") {
    j.axis = vector("axis");
    if (!(j.axis.norm() > 0.0)) o_.refuse(key("axis"), "allowed: a direction, not 0, 0");
    j.axis.normalize();
    j.friction = {number("friction"), number("friction_force"), number("transition_speed")};
  }
  for (const char* field : {"friction", "friction_force", "transition_speed"}) {
    if (!has(field)) continue;
    if (type != "prismatic" && type != "slot") o_.refuse(key(field), "belongs to joints that slide: prismatic or slot");
    if (!j.friction.acts() && std::string_view(field) == "transition_speed")
      o_.refuse(key(field), "needs friction or friction_force");
  }
  vehicle_.mechanism.joints.push_back(j);
}

multibody::Polyline VehicleReader::polyline(std::string_view field) const {
  auto columns = options::read_columns(o_.path(key(field)), 2, 2);
  try {
    return {std::move(columns[0]), std::move(columns[1])};
  } catch (const InputError& error) {
    o_.refuse(key(field), error.what());
  }
}

/// Nothing for a linear spring.
std::optional<multibody::ForceLaw> VehicleReader::force_law() const {
  const std::string side = o_.choice(key("side"));
  multibody::ForceLaw law;
  law.gap = number("gap");
  law.side = side == "tension"       ? multibody::Side::tension
             : side == "compression" ? multibody::Side::compression
                                     : multibody::Side::both;
  if (!law.lets_go() && !has("table") && !has("damper_table")) return {};
  for (const auto& [table, constant] : {std::pair("table", "stiffness"), std::pair("damper_table", "damping")}) {
    if (has(table) && has(constant)) o_.refuse(key(table), fmt::format("give either {} or {}", table, key(constant)));
  }
  law.elastic = has("table") ? polyline("table") : multibody::Polyline::line(number("stiffness"));
  law.damper = has("damper_table") ? polyline("damper_table") : multibody::Polyline::line(number("damping"));
  if (const std::string gains = law.damper.opposing(); !gains.empty())
    o_.refuse(key("damper_table"), "a damper takes energy, its force must have the sign of the rate; " + gains);
  if (const std::string pushes = law.lets_go() ? law.elastic.opposing() : ""; !pushes.empty())
    o_.refuse(key("table"), "with a gap or a side the force must have the sign of the elongation; " + pushes);
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
  if (s.free_length && s.preload) o_.refuse(key("preload"), "give either a preload or " + key("free_length"));
  if (s.law && s.preload && !s.law->elongation_at(*s.preload)) {
    o_.refuse(key("preload"), "allowed: a force that the spring has at one elongation, or " + key("free_length"));
  }
  vehicle_.mechanism.springs.push_back(s);
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

double VehicleReader::stiffness(contact::LawKind kind, double radius, const std::string& other) const {
  const std::string other_young = other + "_young", other_poisson = other + "_poisson";
  if (has("stiffness")) {
    for (const std::string& field : {std::string("young"), std::string("poisson"), other_young, other_poisson}) {
      if (has(field)) o_.refuse(key(field), "give either stiffness or young and poisson");
    }
    return number("stiffness");
  }
  if (!has("young")) o_.refuse(key("stiffness"), "missing: a contact needs stiffness, or young and poisson (eq. 48)");
  if (kind == contact::LawKind::linear) o_.refuse(key("young"), "belongs to law hertz; law linear needs stiffness");
  const double young = number("young"), poisson = number("poisson");
  return contact::hertz_stiffness(radius, young, poisson, has(other_young) ? number(other_young) : young,
                                  has(other_poisson) ? number(other_poisson) : poisson);
}

/// `radius` of eq. 48; `other` stands before the second material's options.
contact::Law VehicleReader::law(double radius, const std::string& other) const {
  contact::Law law;
  law.kind = o_.choice(key("law")) == "linear" ? contact::LawKind::linear : contact::LawKind::hertz;
  law.stiffness = stiffness(law.kind, radius, other);
  law.damping = number("damping");
  if (has("restitution")) {
    if (has("damping")) o_.refuse(key("restitution"), "give either restitution or damping");
    const double e = number("restitution");
    law.hysteresis = o_.choice(key("restitution_law")) == "exact" ? contact::exact_hysteresis(e)
                                                                  : contact::lankarani_nikravesh_hysteresis(e);
  } else if (has("restitution_law")) {
    o_.refuse(key("restitution_law"), "needs " + key("restitution"));
  }
  law.friction = number("friction");
  law.transition_speed = number("transition_speed");
  return law;
}

void VehicleReader::body_contact(const std::string& name) {
  contact::BodyContact c;
  c.name = name;
  const bool line = o_.choice(key("type")) == "arc_line";
  c.type = line ? contact::PairType::arc_line : contact::PairType::arc_arc;
  c.bodies = two_bodies();
  if (c.bodies[0] == multibody::ground) std::swap(c.bodies[0], c.bodies[1]);
  const bool swapped = index_of(key("bodies"), o_.texts(key("bodies"))[0]) == multibody::ground;
  if (swapped && line)
    o_.refuse(key("bodies"), "arc_line: the body with the arc comes first, that with the line second");
  const std::size_t arcs = line ? 1 : 2;
  std::vector<double> radii = o_.numbers(key("radii"), arcs, line ? "the arc's radius" : "one an arc");
  std::vector<double> centres =
      o_.numbers(key("centres"), 2 * arcs, line ? "x, y of the arc's centre" : "x, y of both centres");
  for (std::size_t i = 0; i < arcs; ++i) {
    const std::size_t to = swapped ? 1 - i : i;
    c.radii[to] = radii[i];
    c.centres[to] = {centres[2 * i], centres[2 * i + 1]};
  }
  if (line) {
    const std::vector<double> ends = o_.numbers(key("line"));
    c.line = {Vector2d(ends[0], ends[1]), Vector2d(ends[2], ends[3])};
    if (!((c.line[1] - c.line[0]).norm() > 0.0)) o_.refuse(key("line"), "allowed: x, y of two different points");
    if (!(c.radii[0] > 0.0)) o_.refuse(key("radii"), "allowed on a line: a radius above 0");
  } else {
    if (has("line")) o_.refuse(key("line"), "belongs to type arc_line");
    const auto [i, j] = c.radii;
    const bool fits = (i > 0.0 && j > 0.0) || (i * j < 0.0 && i + j < 0.0);
    if (!fits)
      o_.refuse(key("radii"),
                "allowed: two radii above 0, or one below 0 for a hollow arc that is larger than the other");
  }
  c.law = law(effective_radius(c), "other");
  vehicle_.contacts.push_back(c);
}

track::WheelShape VehicleReader::wheel_shape(double radius) const {
  track::WheelShape shape;
  if (has("flat_length")) {
    shape.flat_length = number("flat_length");
    if (shape.flat_length > radius) o_.refuse(key("flat_length"), "allowed: up to the wheel's radius");
  } else if (has("flat_angle")) {
    o_.refuse(key("flat_angle"), "needs " + key("flat_length"));
  }
  shape.flat_angle = has("flat_angle") ? number("flat_angle") : std::numbers::pi;
  if (has("polygon_order") != has("polygon_amplitude"))
    o_.refuse(key(has("polygon_order") ? "polygon_amplitude" : "polygon_order"),
              "missing: a polygonal wheel needs polygon_order and polygon_amplitude");
  if (!has("polygon_order")) {
    if (has("polygon_phase")) o_.refuse(key("polygon_phase"), "needs " + key("polygon_order"));
    return shape;
  }
  shape.polygon_order = o_.integer(key("polygon_order"));
  shape.polygon_amplitude = number("polygon_amplitude");
  shape.polygon_phase = number("polygon_phase");
  const double most = radius / (shape.polygon_order * shape.polygon_order);
  if (shape.polygon_amplitude >= most)
    o_.refuse(key("polygon_amplitude"), fmt::format("the tread would be hollow; allowed: below {:g} m", most));
  return shape;
}

void VehicleReader::wheel(const std::string& name) {
  Wheel w;
  w.name = name;
  w.body = moving_body(key("body"), o_.text(key("body")));
  w.radius = number("radius");
  w.law = law(w.radius, "rail");
  w.shape = wheel_shape(w.radius);
  vehicle_.wheels.push_back(w);
}

void VehicleReader::actuator_table(multibody::Actuator& a) const {
  const auto columns = options::read_columns(o_.path(key("table")), 2, 4);
  const std::size_t first = columns.size() == 2 ? 2 : 0;  // t,moment or t,fx,fy[,moment]
  for (std::size_t i = 1; i < columns.size(); ++i)
    a.action[first + i - 1] = base::TimeFunction::piecewise_linear(columns[0], columns[i]);
}

void VehicleReader::actuator(const std::string& name) {
  multibody::Actuator a;
  a.name = name;
  if (has("bodies")) {
    if (has("body") || has("reaction_body")) o_.refuse(key("bodies"), "give either bodies or body and reaction_body");
    a.body = moving_body(key("bodies"), o_.texts(key("bodies"))[0]);
    a.reaction_body = two_bodies()[1];
  } else {
    a.body = moving_body(key("body"), o_.text(key("body")));
    a.reaction_body = index_of(key("reaction_body"), o_.text(key("reaction_body")));
    if (a.reaction_body == a.body) o_.refuse(key("reaction_body"), "allowed: another body");
  }
  if (has("table")) {
    if (has("force") || has("moment")) o_.refuse(key("table"), "give either a table or force and moment");
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
    if (has("value") || has("rate")) o_.refuse(key("table"), "give either a table or value and rate");
    const auto columns = options::read_columns(o_.path(key("table")), 2, 2);
    d.value = base::TimeFunction(columns[0], columns[1]);
  } else {
    const double now = vehicle_.mechanism.bodies[static_cast<std::size_t>(d.body)].position[d.coordinate];
    d.value = base::TimeFunction(has("value") ? number("value") : now, number("rate"));
  }
  vehicle_.mechanism.drivers.push_back(d);
}

}  // namespace

Coupler read_coupler(const options::Options& options, const std::string& name) {
  return VehicleReader(options).read_coupler(name);
}

Vehicle read_vehicle(const options::Options& options, const std::string& name) {
  return VehicleReader(options, name).read();
}

}  // namespace traverse::app
