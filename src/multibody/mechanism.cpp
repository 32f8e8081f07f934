// The constant data of a mechanism, its states, the results in a state, and checks of a mechanism as the user describes
// it: finite numbers, positive masses and inertias, existing bodies, consistent force laws.
#include "multibody/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

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

void check_rope(const Part& part, const Rope& rope) {
  if (rope.points.size() < 2 || rope.bodies.size() != rope.points.size())
    part.fail("needs at least two points, and a body for each");
  for (const Eigen::Vector2d& point : rope.points) part.finite_vector("points", point);
  std::vector<int> moved = rope.bodies;
  for (const int body : moved) part.body(body, true);
  part.body(rope.drum, true);
  moved.push_back(rope.drum);
  std::sort(moved.begin(), moved.end());
  moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
  const auto count = std::count_if(moved.begin(), moved.end(), [](int body) { return body != ground; });
  if (count == 0) part.fail("moves no body");
  if (count > most_bodies_of_a_rope)
    part.fail("runs over " + std::to_string(count) + " bodies, at most " + std::to_string(most_bodies_of_a_rope) +
              " are allowed");
  part.not_negative("stiffness", rope.stiffness);
  part.not_negative("axial_rigidity", rope.axial_rigidity);
  if ((rope.stiffness > 0.0) == (rope.axial_rigidity > 0.0)) part.fail("give either a stiffness or an axial rigidity");
  part.not_negative("damping", rope.damping);
  part.finite("drum_radius", rope.drum_radius);
  if (rope.drum != ground && rope.drum == rope.bodies.back())
    part.fail("the last point must be on the body that carries the drum, not on the drum");
  if (rope.free_length && rope.preload) part.fail("give free_length or preload, not both");
  if (rope.preload) part.not_negative("preload", *rope.preload);
  part.positive("unstretched length", unstretched_length(rope));
}

void check_actuator(const Part& part, const Actuator& actuator) {
  part.body(actuator.body, false);
  part.body(actuator.reaction_body, true);
  if (actuator.body == actuator.reaction_body) part.fail("acts on a body and reacts on the same");
  for (const base::TimeFunction& action : actuator.action) part.finite("action", action.value(0.0));
}

/// Throws InputError that names the vehicle, the part and the invalid value.
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
  for (const Rope& rope : model.ropes) check_rope(Part(model, "rope", rope.name), rope);
  for (const Actuator& actuator : model.actuators) check_actuator(Part(model, "actuator", actuator.name), actuator);
}

Frame start_frame(const MechanismModel& model, int body) {
  Frame frame;
  if (body == ground) return frame;
  const Body& b = model.bodies[body];
  frame.origin = b.position.head<2>();
  frame.set_angle(b.position.z());
  frame.velocity = b.velocity.head<2>();
  frame.omega = b.velocity.z();
  return frame;
}

template <class State, class Visit>
void visit_observed(State& s, Visit visit) {
  visit(&s.time, 1);
  visit(&s.dissipation, 1);
  for (auto* x : {&s.q, &s.qd, &s.qdd, &s.lambda, &s.friction.force, &s.friction.speed})
    visit(x->data(), static_cast<int>(x->size()));
}

}  // namespace

Mechanism::Mechanism(MechanismModel model) : model_(std::move(model)) {
  check_model(model_);
  mass_.resize(coordinates());
  for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
    const Body& body = model_.bodies[i];
    mass_.segment<3>(3 * static_cast<int>(i)) << body.mass, body.mass, body.inertia;
  }
  for (const Joint& joint : model_.joints) {
    joints_.push_back(joint_geometry(joint, start_frame(model_, joint.bodies[0]), start_frame(model_, joint.bodies[1]),
                                     joint_row_count_));
    joint_row_count_ += joint.type->rows;
    if (!joint.friction.acts()) continue;
    friction_joints_.push_back(static_cast<int>(joints_.size()) - 1);
    has_normal_friction_ = has_normal_friction_ || joint.friction.coefficient > 0.0;
  }
  for (const Spring& spring : model_.springs) {
    springs_.push_back(
        spring_geometry(spring, start_frame(model_, spring.bodies[0]), start_frame(model_, spring.bodies[1])));
  }
  for (const TorsionSpring& spring : model_.torsion_springs) {
    torsion_springs_.push_back(
        torsion_geometry(spring, start_frame(model_, spring.bodies[0]), start_frame(model_, spring.bodies[1])));
  }
  std::vector<Frame> frames = {Frame()};
  for (int i = 0; i < static_cast<int>(model_.bodies.size()); ++i) frames.push_back(start_frame(model_, i));
  for (const Rope& rope : model_.ropes) ropes_.emplace_back(rope, frames);
  find_scaling();
  find_pattern();
  if (constraints() == 0) {  // all coordinates are independent
    for (int i = 0; i < coordinates(); ++i) partition_.independent.push_back(i);
    partition_version_ = 1;
  }
}

int Mechanism::coordinates() const { return 3 * static_cast<int>(model_.bodies.size()); }
bool Mechanism::select_sides(double t) {
  bool changed = false;
  for (Driver& driver : model_.drivers) changed = driver.value.select_side(t) || changed;
  for (SpringGeometry& spring : springs_)
    if (spring.winding) changed = spring.winding->select_side(t) || changed;
  for (RopeGeometry& rope : ropes_) changed = rope.select_side(t) || changed;
  return changed;
}

int Mechanism::constraints() const { return joint_row_count_ + static_cast<int>(model_.drivers.size()); }
int Mechanism::freedom() const { return static_cast<int>(partition_.independent.size()); }

/// Scales angles by twice the longest arm of a joint, so that pivoting prefers angles as independent coordinates: the
/// angle of a crank is a valid coordinate at its dead points, the position of the slider is not.
void Mechanism::find_scaling() {
  double arm = 0.0;
  for (const JointGeometry& joint : joints_) {
    if (joint.first != ground) arm = std::max(arm, joint.first_arm.norm());
    if (joint.second != ground) arm = std::max(arm, joint.second_arm.norm());
  }
  if (arm == 0.0) {
    for (const Body& body : model_.bodies) arm = std::max(arm, std::sqrt(body.inertia / body.mass));
  }
  length_ = 2.0 * arm;
  scaling_.column = Eigen::VectorXd::Ones(coordinates());
  for (int i = 2; i < coordinates(); i += 3) scaling_.column[i] = 1.0 / length_;
  scaling_.row = Eigen::VectorXd::Ones(constraints());
  for (const JointGeometry& joint : joints_) {
    for (int r = 0; r < joint.type->rows; ++r)
      if (joint.type->angle[static_cast<std::size_t>(r)]) scaling_.row[joint.row + r] = length_;
  }
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    if (model_.drivers[k].coordinate == 2) scaling_.row[driver_row(static_cast<int>(k))] = length_;
  }
}

/// Evaluates Phi_q in two arbitrary positions of the bodies: entries that are zero in both are zero in all positions.
void Mechanism::find_pattern() {
  pattern_.assign(static_cast<std::size_t>(constraints()) * coordinates(), 0);
  MechanismState s = make_state();
  for (int probe = 0; probe < 2; ++probe) {
    for (int i = 0; i < s.q.size(); ++i) s.q[i] += length_ * scaling_.column[i] * std::sin(1.0 + 2.3 * i + probe);
    place_frames(s);
    compute_Phi_q(s);
    for (std::size_t i = 0; i < pattern_.size(); ++i)
      if (s.Phi_q.data()[i] != 0.0) pattern_[i] = 1;
  }
}

MechanismState Mechanism::make_state() const {
  const int n = coordinates();
  const int m = constraints();
  MechanismState s;
  s.frames.resize(model_.bodies.size() + 1);
  for (Eigen::VectorXd* v : {&s.q, &s.qd, &s.b, &s.d, &s.g, &s.qdd, &s.work}) v->setZero(n);
  for (Eigen::VectorXd* v : {&s.Phi, &s.gamma, &s.Phi_t, &s.lambda}) v->setZero(m);
  s.Phi_q.setZero(m, n);
  for (int i = 0; i < n / 3; ++i) {
    s.q.segment<3>(3 * i) = model_.bodies[i].position;
    s.qd.segment<3>(3 * i) = model_.bodies[i].velocity;
    s.frames[i + 1] = start_frame(model_, i);
  }
  if (has_friction()) {
    const auto r = static_cast<int>(friction_joints_.size());
    FrictionState& friction = s.friction;
    for (Eigen::MatrixXd* matrix : {&friction.A, &friction.H}) matrix->setZero(n, r);
    for (Eigen::MatrixXd* matrix : {&friction.gain, &friction.system, &friction.inverse}) matrix->setZero(r, r);
    friction.lu = Eigen::PartialPivLU<Eigen::MatrixXd>(r);
    for (Eigen::VectorXd* v : {&friction.speed, &friction.share, &friction.force, &friction.normal_force,
                               &friction.start, &friction.by_lambda})
      v->setZero(r);
    friction.unit.setZero(m);
    friction.work.setZero(n);
  }
  prepare_workspaces(s);
  return s;
}

const std::string& Mechanism::part_name(int row) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (row < joints_[j].row + joints_[j].type->rows) return model_.joints[j].name;
  }
  return model_.drivers[row - joint_row_count_].name;
}

const char* Mechanism::row_unit(int row) const {
  if (row >= joint_row_count_) return model_.drivers[row - joint_row_count_].coordinate == 2 ? "rad" : "m";
  for (const JointGeometry& joint : joints_) {
    const int local = row - joint.row;
    if (local >= 0 && local < joint.type->rows) return joint.type->angle[static_cast<std::size_t>(local)] ? "rad" : "m";
  }
  return "m";
}

std::string Mechanism::row_name(int row) const {
  return (row < joint_row_count_ ? "joint '" : "driver '") + part_name(row) + "'";
}

Eigen::Vector3d Mechanism::joint_reaction(const MechanismState& s, int j) const {
  const JointGeometry& joint = joints_[j];
  Eigen::Vector3d reaction =
      multibody::joint_reaction(joint, frame(s, joint.first), frame(s, joint.second), s.lambda.data() + joint.row);
  const auto found = std::find(friction_joints_.begin(), friction_joints_.end(), j);
  if (found != friction_joints_.end()) {
    const double force = s.friction.force[found - friction_joints_.begin()];
    reaction.head<2>() += force * frame(s, joint.first).to_global(quarter_turn(joint.normal));
  }
  return reaction;
}

double Mechanism::driver_force(const MechanismState& s, int k) const { return -s.lambda[driver_row(k)]; }

int Mechanism::observed_size() const {
  return 2 + 3 * coordinates() + constraints() + 2 * static_cast<int>(friction_joints_.size());
}

void Mechanism::write_observed(const MechanismState& s, double* to) const {
  visit_observed(s, [&to](const double* x, int size) { to = std::copy_n(x, size, to); });
}

void Mechanism::read_observed(MechanismState& s, const double* from) const {
  visit_observed(s, [&from](double* x, int size) {
    std::copy_n(from, size, x);
    from += size;
  });
  place_frames(s);
  move_frames(s);
}

}  // namespace traverse::multibody
