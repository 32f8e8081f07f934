// The generalized forces g of eq. 42 without contact: gravity, springs, actuators; and the energy balance.
#include "traverse/multibody/mechanism.hpp"

namespace traverse::multibody {

void Mechanism::compute_forces(MechanismState& s, bool derivatives) const {
  s.g.setZero();
  for (int i = 1; i < s.g.size(); i += 3) s.g[i] = -mass_[i] * model_.gravity;
  for (const SpringGeometry& spring : springs_) {
    const PairForce force = multibody::spring_force(spring, frame(s, spring.first), frame(s, spring.second));
    if (spring.first != ground) s.g.segment<3>(3 * spring.first) += force.head<3>();
    if (spring.second != ground) s.g.segment<3>(3 * spring.second) += force.tail<3>();
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    const double moment = torsion_moment(spring, frame(s, spring.first), frame(s, spring.second));
    if (spring.first != ground) s.g[3 * spring.first + 2] -= moment;
    if (spring.second != ground) s.g[3 * spring.second + 2] += moment;
  }
  for (const Actuator& actuator : model_.actuators) {
    for (int c = 0; c < 3; ++c) {
      const double action = actuator.action[c].value(s.time);
      s.g[3 * actuator.body + c] += action;
      if (actuator.reaction_body != ground) s.g[3 * actuator.reaction_body + c] -= action;
    }
  }
  if (derivatives) compute_force_derivatives(s);
}

void Mechanism::compute_force_derivatives(MechanismState& s) const {
  s.g_q.setZero();
  s.g_qd.setZero();
  PairMatrix g_q, g_qd;
  for (const SpringGeometry& spring : springs_) {
    spring_derivatives(spring, frame(s, spring.first), frame(s, spring.second), g_q, g_qd);
    add_pair(spring.first, spring.second, g_q, s.g_q);
    add_pair(spring.first, spring.second, g_qd, s.g_qd);
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    const TorsionTangent tangent = torsion_tangent(spring, frame(s, spring.first), frame(s, spring.second));
    g_q.setZero();
    g_q(2, 2) = g_q(5, 5) = -tangent.stiffness;
    g_q(2, 5) = g_q(5, 2) = tangent.stiffness;
    g_qd.setZero();
    g_qd(2, 2) = g_qd(5, 5) = -tangent.damping;
    g_qd(2, 5) = g_qd(5, 2) = tangent.damping;
    add_pair(spring.first, spring.second, g_q, s.g_q);
    add_pair(spring.first, spring.second, g_qd, s.g_qd);
  }
}

double Mechanism::spring_force(const MechanismState& s, int k) const {
  const SpringGeometry& spring = springs_[k];
  return spring_tension(spring, frame(s, spring.first), frame(s, spring.second));
}

double Mechanism::torsion_spring_moment(const MechanismState& s, int k) const {
  const TorsionGeometry& spring = torsion_springs_[k];
  return torsion_moment(spring, frame(s, spring.first), frame(s, spring.second));
}

MechanismEnergy Mechanism::energy(const MechanismState& s) const {
  MechanismEnergy e;
  for (int i = 0; i < s.q.size(); ++i) e.kinetic += 0.5 * mass_[i] * s.qd[i] * s.qd[i];
  for (int i = 1; i < s.q.size(); i += 3) e.potential += mass_[i] * model_.gravity * s.q[i];
  for (const SpringGeometry& spring : springs_) {
    e.strain += spring_strain_energy(spring, frame(s, spring.first), frame(s, spring.second));
    e.dissipation += spring_dissipation(spring, frame(s, spring.first), frame(s, spring.second));
  }
  for (const TorsionGeometry& spring : torsion_springs_) {
    e.strain += torsion_strain_energy(spring, frame(s, spring.first), frame(s, spring.second));
    e.dissipation += torsion_dissipation(spring, frame(s, spring.first), frame(s, spring.second));
  }
  for (const Actuator& actuator : model_.actuators) {
    for (int c = 0; c < 3; ++c) {
      double rate = s.qd[3 * actuator.body + c];
      if (actuator.reaction_body != ground) rate -= s.qd[3 * actuator.reaction_body + c];
      e.work += actuator.action[c].value(s.time) * rate;
    }
  }
  for (std::size_t k = 0; k < model_.drivers.size(); ++k) {
    e.work += driver_force(s, static_cast<int>(k)) * model_.drivers[k].value.rate(s.time);
  }
  return e;
}

}  // namespace traverse::multibody
