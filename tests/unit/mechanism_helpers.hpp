// What the tests of multibody share: small mechanisms and a Runge-Kutta integrator of p and p'.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "traverse/multibody/mechanism.hpp"

namespace traverse::multibody::testing {

inline Body make_body(const std::string& name, double mass, double inertia, double x, double y, double phi = 0.0) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.inertia = inertia;
  body.position = {x, y, phi};
  return body;
}

inline Joint make_joint(const std::string& name, JointType type, int first, int second, double x, double y,
                        double axis_x = 0.0, double axis_y = 1.0) {
  Joint joint;
  joint.name = name;
  joint.type = type;
  joint.bodies = {first, second};
  joint.point = {x, y};
  joint.axis = {axis_x, axis_y};
  return joint;
}

inline Joint make_distance(const std::string& name, int first, int second, Eigen::Vector2d from, Eigen::Vector2d to) {
  Joint joint;
  joint.name = name;
  joint.type = JointType::distance;
  joint.bodies = {first, second};
  joint.from = from;
  joint.to = to;
  return joint;
}

inline Driver make_driver(const std::string& name, int body, int coordinate, double value, double rate) {
  return {name, body, coordinate, base::TimeFunction(value, rate)};
}

inline Spring make_spring(const std::string& name, int first, int second, Eigen::Vector2d from, Eigen::Vector2d to,
                          double stiffness, double damping = 0.0) {
  Spring spring;
  spring.name = name;
  spring.bodies = {first, second};
  spring.from = from;
  spring.to = to;
  spring.stiffness = stiffness;
  spring.damping = damping;
  return spring;
}

/// A mechanism with a state, ready to move; p and p' are what a time integrator would hold.
class Motion {
 public:
  explicit Motion(MechanismModel model) : mechanism(std::move(model)), state(mechanism.make_state()) {
    dropped = mechanism.choose_partition(state, 0.0);
    read();
    Q = Eigen::VectorXd::Zero(mechanism.coordinates());
  }

  /// One classical Runge-Kutta step of p and p'.
  void step(double h) {
    const int f = mechanism.freedom();
    const Eigen::VectorXd p0 = p, pd0 = pd;
    Eigen::VectorXd k[4], l[4];
    const double at[4] = {0.0, 0.5, 0.5, 1.0};
    for (int i = 0; i < 4; ++i) {
      p = p0;
      pd = pd0;
      if (i > 0) {
        p += at[i] * h * k[i - 1];
        pd += at[i] * h * l[i - 1];
      }
      k[i] = pd;
      l[i].resize(f);
      converged = evaluate(time + at[i] * h, l[i].data()) && converged;
    }
    p = p0 + h / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]);
    pd = pd0 + h / 6.0 * (l[0] + 2.0 * l[1] + 2.0 * l[2] + l[3]);
    time += h;
  }

  /// The state's accelerations and multipliers at the current p and p'.
  void finish() {
    Eigen::VectorXd pdd(mechanism.freedom());
    converged = evaluate(time, pdd.data()) && converged;
  }

  bool evaluate(double t, double* pdd) {
    if (!mechanism.set_positions(state, t, p.data())) return false;
    mechanism.set_velocities(state, t, pd.data());
    mechanism.compute_forces(state, false);
    mechanism.accelerations(state, Q, pdd);
    return true;
  }

  /// New independent coordinates at the present position.
  void repartition() {
    finish();
    mechanism.choose_partition(state, time);
    read();
  }

  double total_energy() const {
    const MechanismEnergy e = mechanism.energy(state);
    return e.kinetic + e.strain + e.potential;
  }

  Mechanism mechanism;
  MechanismState state;
  std::vector<std::string> dropped;
  Eigen::VectorXd p, pd, Q;
  double time = 0.0;
  bool converged = true;

 private:
  void read() {
    const std::vector<int>& independent = mechanism.partition().independent;
    p.resize(static_cast<int>(independent.size()));
    pd.resize(p.size());
    for (int k = 0; k < p.size(); ++k) {
      p[k] = state.q[independent[k]];
      pd[k] = state.qd[independent[k]];
    }
  }
};

}  // namespace traverse::multibody::testing
