// Checks bodies, joints, drivers, springs and actuators in turn: finite numbers, positive masses and inertias, existing
// bodies, consistent force laws.
#include "check_model.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "traverse/base/error.hpp"

namespace traverse::multibody {

namespace {

/// Checks one part of a vehicle, with messages such as "vehicle 'x', joint 'y': ...".
class Part {
 public:
  Part(const MechanismModel& model, const std::string& kind, const std::string& name)
      : model_(model), prefix_("vehicle '" + model.name + "', " + kind + " '" + name + "': ") {}

  [[noreturn]] void fail(const std::string& text) const { throw InputError(prefix_ + text); }

  void finite(const char* what, double value) const {
    if (!std::isfinite(value)) fail(std::string(what) + " is not a finite number");
  }
  template <class Vector>
  void finite_vector(const char* what, const Vector& value) const {
    for (const double entry : value) finite(what, entry);
  }
  void positive(const char* what, double value) const {
    finite(what, value);
    if (!(value > 0.0)) fail(std::string(what) + " must be greater than 0, it is " + text(value));
  }
  void not_negative(const char* what, double value) const {
    finite(what, value);
    if (value < 0.0) fail(std::string(what) + " must not be negative, it is " + text(value));
  }
  void body(int index, bool may_be_ground) const {
    if (index == ground && may_be_ground) return;
    if (index == ground) fail("must act on a body, not on the ground");
    if (index < 0 || index >= static_cast<int>(model_.bodies.size())) {
      fail("there is no body number " + std::to_string(index));
    }
  }
  void pair(const std::array<int, 2>& bodies) const {
    body(bodies[0], true);
    body(bodies[1], true);
    if (bodies[0] != bodies[1]) return;
    fail(bodies[0] == ground ? "joins the ground to itself" : "joins a body to itself");
  }

 private:
  static std::string text(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  }

  const MechanismModel& model_;
  std::string prefix_;
};

void check_body(const Part& part, const Body& body) {
  part.positive("mass", body.mass);
  part.positive("inertia", body.inertia);
  part.finite_vector("position", body.position);
  part.finite_vector("velocity", body.velocity);
}

void check_friction(const Part& part, const Joint& joint) {
  part.not_negative("friction", joint.friction.coefficient);
  part.not_negative("friction_force", joint.friction.force);
  part.positive("transition_speed", joint.friction.transition_speed);
  if (!joint.friction.acts() || joint.type->slides) return;
  part.fail("friction needs a joint that slides: " +
            joint_names([](const JointRow& row) { return row.slides; }, ", ", " or "));
}

void check_joint(const Part& part, const Joint& joint) {
  part.pair(joint.bodies);
  check_friction(part, joint);
  if (joint.type->needs.ends) {
    part.finite_vector("from", joint.from);
    part.finite_vector("to", joint.to);
    if (!((joint.to - joint.from).norm() > 0.0)) part.fail("from and to must be different points");
  }
  if (joint.type->needs.axis) {
    part.finite_vector("axis", joint.axis);
    if (!(joint.axis.norm() > 0.0)) part.fail("axis must not be zero");
  }
  if (joint.type->needs.point) part.finite_vector("point", joint.point);
  for (std::size_t i = 0; i < joint.type->numbers.size(); ++i)
    part.finite(std::string(joint.type->numbers[i].name).c_str(), joint.numbers[i]);
}

void check_driver(const Part& part, const Driver& driver) {
  part.body(driver.body, false);
  if (driver.coordinate < 0 || driver.coordinate > 2) {
    part.fail("coordinate must be 0 (x), 1 (y) or 2 (phi), it is " + std::to_string(driver.coordinate));
  }
  part.finite("value", driver.value.value(0.0));
  part.finite("rate", driver.value.rate(0.0));
}

void check_law(const Part& part, const base::ForceLaw& law, double stiffness, double damping) {
  if (stiffness != 0.0 || damping != 0.0) part.fail("give a law or stiffness and damping, not both");
  part.not_negative("gap", law.gap);
  const std::string damper_error = law.damper.opposing();
  if (!damper_error.empty()) part.fail("damper table: force and rate must not have opposite signs, " + damper_error);
  const std::string elastic_error = law.can_disengage() ? law.elastic.opposing() : std::string();
  if (!elastic_error.empty())
    part.fail("table: with a gap or a side force and elongation must not differ in sign, " + elastic_error);
}

void check_spring(const Part& part, const Spring& spring) {
  part.pair(spring.bodies);
  part.finite_vector("from", spring.from);
  part.finite_vector("to", spring.to);
  part.not_negative("stiffness", spring.stiffness);
  part.not_negative("damping", spring.damping);
  if (spring.free_length && spring.preload) part.fail("give free_length or preload, not both");
  if (spring.free_length) part.not_negative("free_length", *spring.free_length);
  if (spring.preload) part.finite("preload", *spring.preload);
  if (!spring.law) return;
  check_law(part, *spring.law, spring.stiffness, spring.damping);
  if (spring.preload && !spring.law->elongation_at(*spring.preload)) {
    part.fail("preload: there is no length at which alone the law gives this force; give free_length");
  }
}

void check_torsion_spring(const Part& part, const TorsionSpring& spring) {
  part.pair(spring.bodies);
  part.not_negative("stiffness", spring.stiffness);
  part.not_negative("damping", spring.damping);
  if (spring.free_angle) part.finite("free_angle", *spring.free_angle);
  if (spring.law) check_law(part, *spring.law, spring.stiffness, spring.damping);
}

void check_actuator(const Part& part, const Actuator& actuator) {
  part.body(actuator.body, false);
  part.body(actuator.reaction_body, true);
  if (actuator.body == actuator.reaction_body) part.fail("acts on a body and reacts on the same");
  for (const base::TimeFunction& action : actuator.action) part.finite("action", action.value(0.0));
}

}  // namespace

void check_model(const MechanismModel& model) {
  if (model.bodies.empty()) throw InputError("vehicle '" + model.name + "' has no body");
  if (!std::isfinite(model.gradient))
    throw InputError("vehicle '" + model.name + "': the gradient is not a finite number");
  if (!std::isfinite(model.gravity)) throw InputError("vehicle '" + model.name + "': gravity is not a finite number");
  for (const Body& body : model.bodies) check_body(Part(model, "body", body.name), body);
  for (const Joint& joint : model.joints) check_joint(Part(model, "joint", joint.name), joint);
  for (const Driver& driver : model.drivers) check_driver(Part(model, "driver", driver.name), driver);
  for (const Spring& spring : model.springs) check_spring(Part(model, "spring", spring.name), spring);
  for (const TorsionSpring& spring : model.torsion_springs) {
    check_torsion_spring(Part(model, "torsion spring", spring.name), spring);
  }
  for (const Actuator& actuator : model.actuators) check_actuator(Part(model, "actuator", actuator.name), actuator);
}

}  // namespace traverse::multibody
