// Reads the parts of one vehicle, or the couplers of one train, from the options.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "options/relations.hpp"
#include "repeated_parts.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {

/// Reads a vehicle or a coupler. Throws InputError with the name of the option.
class VehicleReader {
 public:
  VehicleReader(const options::Options& options, const std::string& name)
      : o_(options), prefix_("vehicle_" + name + "_") {
    vehicle_.name = name;
    vehicle_.mechanism.name = name;
  }

  /// A reader of the couplers of a train.
  VehicleReader(const options::Options& options, const Block& train) : o_(options), prefix_(train.name + "_") {}
  Coupler read_coupler(const std::string& name);

  Vehicle read() {
    vehicle_.mechanism.gravity = o_.number("gravity");
    if (!o_.has(prefix_ + "bodies")) o_.refuse(prefix_ + "bodies", "a vehicle needs at least one body");
    bodies_ = part_names(o_, prefix_, options::Part::body);
    for (const std::string& name : bodies_) body(name);
    each(options::Part::joint, [this](const std::string& name) { joint(name); });
    each(options::Part::spring, [this](const std::string& name) { spring(name); });
    each(options::Part::torsion_spring, [this](const std::string& name) { torsion_spring(name); });
    each(options::Part::rope, [this](const std::string& name) { rope(name); });
    each(options::Part::wheel, [this](const std::string& name) { wheel(name); });
    each(options::Part::actuator, [this](const std::string& name) { actuator(name); });
    each(options::Part::driver, [this](const std::string& name) { driver(name); });
    each(options::Part::contact, [this](const std::string& name) { body_contact(name); });
    each(options::Part::sensor, [this](const std::string& name) { sensor(name); });
    lift_bodies();
    return std::move(vehicle_);
  }

 private:
  template <class Read>
  void each(options::Part part, Read&& read) {
    for (const std::string& name : part_names(o_, prefix_, part)) {
      part_ = prefix_ + name + "_";
      options::check_relations(o_, options::Related::part, part_);
      read(name);
    }
  }

  std::string key(std::string_view field) const { return part_ + std::string(field); }
  bool has(std::string_view field) const { return o_.has(key(field)); }
  double number(std::string_view field) const { return o_.number(key(field)); }
  Eigen::Vector2d vector(std::string_view field) const {
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

  void check_apart(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    if (coupler_ || (to - from).norm() > 0.0) return;  // a coupler's points are relative to two origins
    o_.refuse(key("to"), "from and to are the same point: the direction between them is not defined");
  }

  void body(const std::string& name);
  void joint(const std::string& name);
  void joint_friction(multibody::Joint& j) const;
  void joint_numbers(multibody::Joint& j) const;
  base::Polyline polyline(std::string_view field) const;
  std::optional<base::ForceLaw> force_law() const;
  void check_spring_given(std::string_view kind) const;
  void spring(const std::string& name);
  base::TimeFunction winding(double length) const;
  void rope(const std::string& name);
  void lift(multibody::Rope& rope);
  void lift_bodies();
  void torsion_spring(const std::string& name);
  void wheel(const std::string& name);
  contact::Law law(double radius, const std::string& other) const;
  track::WheelShape wheel_shape(double radius) const;
  double stiffness(contact::LawKind kind, double radius, const std::string& other) const;
  void body_contact(const std::string& name);
  void actuator(const std::string& name);
  void actuator_table(multibody::Actuator& a) const;
  void driver(const std::string& name);
  void sensor(const std::string& name);

  const options::Options& o_;
  std::string prefix_;  // vehicle_NAME_
  std::string part_;    // vehicle_NAME_PART_
  std::vector<std::string> bodies_;
  Vehicle vehicle_;
  bool coupler_ = false;

  /// Bodies that the length of a rope moves up at t = 0.
  struct Lift {
    std::string rope;
    std::vector<int> bodies;
    double up = 0.0;  // m
    bool moves(int body) const { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); }
  };
  std::vector<Lift> lifts_;
};

}  // namespace traverse::scene
