// What the tests of multibody share: small mechanisms and a Runge-Kutta integrator of p and p'.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "multibody/mechanism.hpp"

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

inline Joint make_distance(const std::string& name, int first, int second, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) {
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

inline Spring make_spring(const std::string& name, int first, int second, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to, double stiffness, double damping = 0.0) {
  Spring spring;
  spring.name = name;
  spring.bodies = {first, second};
  spring.from = from;
  spring.to = to;
  spring.stiffness = stiffness;
  spring.damping = damping;
  return spring;
}

constexpr double crank_length = 1.0, rod_length = 3.0;

/// Crank about the origin, rod, slider on the x axis; crank at angle theta.
inline MechanismModel slider_crank(double theta, bool with_distance_rod = false) {
  const Eigen::Vector2d pin(crank_length * std::cos(theta), crank_length * std::sin(theta));
  const double x = pin.x() + std::sqrt(rod_length * rod_length - pin.y() * pin.y());
  MechanismModel model;
  model.name = "slider_crank";
  model.bodies = {make_body("crank", 2.0, 0.4, 0.5 * pin.x(), 0.5 * pin.y(), theta),
                  make_body("slider", 3.0, 0.3, x, 0.0)};
  model.joints = {make_joint("bearing", JointType::revolute, ground, 0, 0.0, 0.0),
                  make_joint("guide", JointType::prismatic, ground, 1, 0.0, 0.0, 1.0, 0.0)};
  if (with_distance_rod) {
    model.joints.push_back(make_distance("rod", 0, 1, pin, {x, 0.0}));
    return model;
  }
  model.bodies.push_back(
      make_body("rod", 1.0, 0.9, 0.5 * (pin.x() + x), 0.5 * pin.y(), std::asin(-pin.y() / rod_length)));
  model.joints.push_back(make_joint("crank_pin", JointType::revolute, 0, 2, pin.x(), pin.y()));
  model.joints.push_back(make_joint("slider_pin", JointType::revolute, 2, 1, x, 0.0));
  return model;
}

/// Crank, coupler and rocker between pins at (0, 0) and (4, 0).
inline MechanismModel four_bar() {
  MechanismModel model;
  model.name = "four_bar";
  model.bodies = {make_body("crank", 1.0, 0.1, 0.0, 0.5), make_body("coupler", 2.0, 1.5, 2.5, 2.0),
                  make_body("rocker", 1.5, 0.7, 4.5, 1.5)};
  model.joints = {
      make_joint("a", JointType::revolute, ground, 0, 0.0, 0.0), make_joint("b", JointType::revolute, 0, 1, 0.0, 1.0),
      make_joint("c", JointType::revolute, 1, 2, 5.0, 3.0), make_joint("d", JointType::revolute, 2, ground, 4.0, 0.0)};
  return model;
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
    mechanism.compute_forces(state);
    mechanism.accelerations(state, Q, pdd);
    return true;
  }

  /// New independent coordinates at the present position.
  void repartition() {
    finish();
    mechanism.choose_partition(state, time);
    read();
  }

  /// The largest error of any constraint.
  double drift() const { return state.Phi.size() == 0 ? 0.0 : state.Phi.cwiseAbs().maxCoeff(); }

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
