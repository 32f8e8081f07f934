// The generalized forces g of eq. 42 of the paper without contact: gravity, springs, actuators; and the energy balance.
#include "multibody/mechanism.hpp"

namespace traverse::multibody {

namespace {

/// Calls use(spring) with the free length at time t.
template <class Use>
auto at_time(const SpringGeometry& spring, double t, Use use) {
  return spring.winding == nullptr ? use(spring) : use(wound(spring, t));
}

}  // namespace

void Mechanism::compute_forces(MechanismState& s) const {
  s.g.setZero();
  s.dissipation = 0.0;
  for (int i = 1; i < s.g.size(); i += 3) {
    s.g[i] = -mass_[i] * model_.gravity;
    s.g[i - 1] = model_.gradient * s.g[i];
  }
  for (const SpringGeometry& spring : springs_) {
    const PairForce force = at_time(spring, s.time, [&](const SpringGeometry& now) {
      return multibody::spring_force(now, frame(s, spring.first), frame(s, spring.second), s.dissipation);
    });
    if (spring.first != ground) s.g.segment<3>(3 * spring.first) += force.head<3>();
    if (spring.second != ground) s.g.segment<3>(3 * spring.second) += force.tail<3>();
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    const double moment = torsion_moment(spring, frame(s, spring.first), frame(s, spring.second));
    s.dissipation += torsion_dissipation(spring, frame(s, spring.first), frame(s, spring.second));
    if (spring.first != ground) s.g[3 * spring.first + 2] -= moment;
    if (spring.second != ground) s.g[3 * spring.second + 2] += moment;
  }
  for (const RopeGeometry& rope : ropes_) {
    const RopeState at = rope.state(s.frames, s.time);
    s.dissipation += at.tension.dissipation;
    for (std::size_t i = 0; i < rope.bodies().size(); ++i)
      s.g.segment<3>(3 * rope.bodies()[i]) -= at.tension.tension * at.by_q.segment<3>(3 * static_cast<int>(i));
  }
  for (const Actuator& actuator : model_.actuators) {
    for (int c = 0; c < 3; ++c) {
      const double action = actuator.action[c].value(s.time);
      s.g[3 * actuator.body + c] += action;
      if (actuator.reaction_body != ground) s.g[3 * actuator.reaction_body + c] -= action;
    }
  }
  if (applied_.size() > 0) s.g += applied_;
  if (has_friction()) compute_friction_kinematics(s);
}

void Mechanism::apply(int body, const Eigen::Vector3d& action) {
  if (applied_.size() == 0) applied_ = Eigen::VectorXd::Zero(coordinates());
  applied_.segment<3>(3 * body) = action;
}

void add_pair_times_B(int first, int second, const PairMatrix& K, const MechanismState& s, Eigen::MatrixXd& product) {
  const int bodies[2] = {first, second};
  for (int j = 0; j < 2; ++j) {
    if (bodies[j] == ground) continue;
    const ColumnRange range = s.columns[bodies[j]];
    const int width = range.last - range.first;
    const auto B = s.B.block(3 * bodies[j], range.first, 3, width);
    for (int i = 0; i < 2; ++i) {
      if (bodies[i] == ground) continue;
      product.block(3 * bodies[i], range.first, 3, width).noalias() += K.block<3, 3>(3 * i, 3 * j).lazyProduct(B);
    }
  }
}

/// Calls add(first, second, K) with the matrix K of each pair of bodies, in the order of augmented_pattern; without
/// curvature (by_lambda 0) the joints are left out.
template <class Add>
void Mechanism::each_tangent(const MechanismState& s, double by_q, double by_qd, double by_lambda, Add add) const {
  PairMatrix K, g_qd;
  for (const SpringGeometry& spring : springs_) {
    at_time(spring, s.time, [&](const SpringGeometry& now) {
      spring_derivatives(now, frame(s, spring.first), frame(s, spring.second), K, g_qd);
    });
    K = by_q * K + by_qd * g_qd;
    add(spring.first, spring.second, K);
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    const TorsionTangent tangent = torsion_tangent(spring, frame(s, spring.first), frame(s, spring.second));
    const double k = by_q * tangent.stiffness + by_qd * tangent.damping;
    K.setZero();
    K(2, 2) = K(5, 5) = -k;
    K(2, 5) = K(5, 2) = k;
    add(spring.first, spring.second, K);
  }
  for (const RopeGeometry& rope : ropes_) {
    const RopeMatrix all = rope.tangent(s.frames, rope.state(s.frames, s.time), by_q, by_qd);
    rope.each_pair(all, add);
  }
  if (by_lambda == 0.0) return;
  for (const JointGeometry& joint : joints_) {
    joint_curvature(joint, frame(s, joint.first), frame(s, joint.second), s.lambda.data() + joint.row, K);
    K *= by_lambda;
    add(joint.first, joint.second, K);
  }
}

void Mechanism::multiply_tangent(const MechanismState& s, double by_q, double by_qd, double by_lambda,
                                 Eigen::MatrixXd& product) const {
  product.setZero(coordinates(), freedom());
  if (has_friction()) multiply_friction_tangent(s, by_q, by_qd, product);
  each_tangent(s, by_q, by_qd, by_lambda,
               [&](int first, int second, const PairMatrix& K) { add_pair_times_B(first, second, K, s, product); });
}

AugmentedPattern Mechanism::augmented_pattern() const {
  AugmentedPattern pattern;
  pattern.bodies = static_cast<int>(model_.bodies.size());
  for (const SpringGeometry& spring : springs_) pattern.pairs.push_back({spring.first, spring.second});
  for (const TorsionGeometry& spring : torsion_springs_) pattern.pairs.push_back({spring.first, spring.second});
  for (const RopeGeometry& rope : ropes_)
    rope.each_pair(rope.no_tangent(), [&](int first, int second, const PairMatrix&) {
      pattern.pairs.push_back({first, second});
    });
  for (const JointGeometry& joint : joints_) pattern.pairs.push_back({joint.first, joint.second});
  const auto rows = static_cast<std::size_t>(constraints());
  for (const int row : partition_.rows) {
    std::vector<int>& columns = pattern.rows.emplace_back();
    for (int j = 0; j < coordinates(); ++j)
      if (pattern_[static_cast<std::size_t>(j) * rows + static_cast<std::size_t>(row)]) columns.push_back(j);
  }
  return pattern;
}

void Mechanism::assemble_augmented(const MechanismState& s, double by_mass, double by_q, double by_qd, double by_lambda,
                                   AugmentedSystem& system) const {
  system.set_zero();
  system.add_mass(mass_, by_mass);
  if (by_q != 0.0 || by_qd != 0.0 || by_lambda != 0.0) {
    int pair = 0;
    each_tangent(s, by_q, by_qd, by_lambda, [&](int, int, const PairMatrix& K) { system.add_pair(pair++, K); });
  }
  system.set_constraints(s.Phi_q, partition_.rows);
}

double Mechanism::spring_tension(const MechanismState& s, int k) const {
  const SpringGeometry& spring = springs_[k];
  return at_time(spring, s.time, [&](const SpringGeometry& now) {
    return multibody::spring_tension(now, frame(s, spring.first), frame(s, spring.second));
  });
}

double Mechanism::rope_tension(const MechanismState& s, int k) const {
  return ropes_[k].state(s.frames, s.time).tension.tension;
}

double Mechanism::torsion_spring_moment(const MechanismState& s, int k) const {
  const TorsionGeometry& spring = torsion_springs_[k];
  return torsion_moment(spring, frame(s, spring.first), frame(s, spring.second));
}

MechanismEnergy Mechanism::energy(const MechanismState& s) const {
  MechanismEnergy e{powers(s)};
  for (int i = 0; i < s.q.size(); ++i) e.kinetic += 0.5 * mass_[i] * s.qd[i] * s.qd[i];
  for (int i = 1; i < s.q.size(); i += 3)
    e.potential += mass_[i] * model_.gravity * (s.q[i] + model_.gradient * s.q[i - 1]);
  for (const SpringGeometry& spring : springs_) {
    e.strain += at_time(spring, s.time, [&](const SpringGeometry& now) {
      return spring_strain_energy(now, frame(s, spring.first), frame(s, spring.second));
    });
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    e.strain += torsion_strain_energy(spring, frame(s, spring.first), frame(s, spring.second));
  }
  for (const RopeGeometry& rope : ropes_) e.strain += rope.strain_energy(rope.state(s.frames, s.time));
  return e;
}

base::Powers Mechanism::powers(const MechanismState& s) const {
  base::Powers e{s.dissipation};
  for (int k = 0; k < s.friction.force.size(); ++k) e.dissipation -= s.friction.force[k] * s.friction.speed[k];
  for (const Actuator& actuator : model_.actuators) {
    for (int c = 0; c < 3; ++c) {
      double rate = s.qd[3 * actuator.body + c];
      if (actuator.reaction_body != ground) rate -= s.qd[3 * actuator.reaction_body + c];
      e.work += actuator.action[c].value(s.time) * rate;
    }
  }
  for (std::size_t k = 0; k < springs_.size(); ++k)
    if (springs_[k].winding != nullptr)
      e.work -= spring_tension(s, static_cast<int>(k)) * springs_[k].winding->rate(s.time);
  for (const RopeGeometry& rope : ropes_) e.work += rope.work(rope.state(s.frames, s.time));
  if (applied_.size() > 0) e.work += applied_.dot(s.qd);
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    e.work += driver_force(s, static_cast<int>(k)) * model_.drivers[k].value.rate(s.time);
  }
  return e;
}

}  // namespace traverse::multibody
