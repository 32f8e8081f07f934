// The constant data of a mechanism, its states, and the results in a state.
#include "multibody/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check_model.hpp"

namespace traverse::multibody {

namespace {

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

}  // namespace traverse::multibody
