// Reads the wheels, contacts between bodies and sensors of one vehicle.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <numbers>

#include "vehicle_reader.hpp"

namespace traverse::scene {

using Eigen::Vector2d;

double VehicleReader::stiffness(contact::LawKind kind, double radius, const std::string& other) const {
  const std::string other_young = other + "_young", other_poisson = other + "_poisson";
  if (has("stiffness")) return number("stiffness");
  if (!has("young")) o_.refuse(key("stiffness"), "missing: a contact needs stiffness, or young and poisson (eq. 48)");
  if (kind != contact::LawKind::hertz)
    o_.refuse(key("young"), "is only for law hertz; law " + o_.choice(key("law")) + " needs stiffness");
  const double young = number("young"), poisson = number("poisson");
  return contact::hertz_stiffness(radius, young, poisson, has(other_young) ? number(other_young) : young,
                                  has(other_poisson) ? number(other_poisson) : poisson);
}

/// The contact law. radius: effective radius of eq. 48. other: prefix of the options of the second material.
contact::Law VehicleReader::law(double radius, const std::string& other) const {
  contact::Law law;
  law.kind = contact::law_kind(o_.choice(key("law"))).value();
  law.stiffness = stiffness(law.kind, radius, other);
  if (contact::pulls(law.kind))
    for (const char* field : {"friction", "restitution"})
      if (has(field) && number(field) != 0.0)
        o_.refuse(key(field),
                  fmt::format("is only for one-sided contacts, not for law {}", contact::row_of(law.kind).name));
  law.damping = number("damping");
  if (has("restitution")) {
    const double e = number("restitution");
    law.hysteresis = o_.choice(key("restitution_law")) == "exact" ? contact::exact_hysteresis(e)
                                                                  : contact::lankarani_nikravesh_hysteresis(e);
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
    o_.refuse(key("bodies"), "allowed for arc_line: first the body with the arc, then the body with the line");
  const std::size_t arcs = line ? 1 : 2;
  std::vector<double> radii = o_.numbers(key("radii"), arcs, line ? "the arc's radius" : "one per arc");
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
  }
  shape.flat_angle = has("flat_angle") ? number("flat_angle") : std::numbers::pi;
  if (!has("polygon_order")) return shape;
  shape.polygon_order = o_.integer(key("polygon_order"));
  shape.polygon_amplitude = number("polygon_amplitude");
  shape.polygon_phase = number("polygon_phase");
  const double most = radius / (shape.polygon_order * shape.polygon_order);
  if (shape.polygon_amplitude >= most)
    o_.refuse(key("polygon_amplitude"), fmt::format("the tread would be concave; allowed: below {:g} m", most));
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

void VehicleReader::sensor(const std::string& name) {
  train::Sensor s;
  s.name = name;
  s.body = moving_body(key("body"), o_.text(key("body")));
  const Eigen::Vector3d& home = vehicle_.mechanism.bodies[static_cast<std::size_t>(s.body)].position;
  if (has("point")) s.arm = Eigen::Rotation2Dd(-home.z()) * (vector("point") - home.head<2>());
  vehicle_.sensors.push_back(s);
}

}  // namespace traverse::scene
