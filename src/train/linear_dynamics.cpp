// Mass, damping and stiffness matrices of the projected equations of motion (equation 42 of the paper) by linearisation
// about the initial state, and the residual of the nonlinear mechanism as a measure of their error.
#include "linear_dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::train {
namespace {

/// Calls use(coordinate of q, action, action at t = 0) for all actuators, N or N m.
template <class Use>
void for_actions(const MovingVehicle& vehicle, double t, Use use) {
  for (const multibody::Actuator& actuator : vehicle.mechanism.model().actuators)
    for (int i = 0; i < 3; ++i) {
      const base::TimeFunction& action = actuator.action[static_cast<std::size_t>(i)];
      const double now = action.value(t), at_start = action.value(0.0);
      if (now == 0.0 && at_start == 0.0) continue;
      use(3 * actuator.body + i, now, at_start);
      if (actuator.reaction_body != multibody::ground) use(3 * actuator.reaction_body + i, -now, -at_start);
    }
}

/// The rates of all bodies (n) per metre of travel by the drives, with the independent coordinates at rest: those of a
/// translation, minus the part of its independent coordinates.
Eigen::VectorXd rates_of_drives(const MovingVehicle& vehicle, const Eigen::MatrixXd& B) {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(B.rows());
  for (Eigen::Index x = 0; x < rates.size(); x += 3) rates[x] = 1.0;
  const std::vector<int>& independent = vehicle.mechanism.partition().independent;
  for (std::size_t i = 0; i < independent.size(); ++i)
    if (independent[i] % 3 == 0) rates -= B.col(static_cast<Eigen::Index>(i));
  return rates;
}

}  // namespace

std::string LinearDynamics::obstacle(const MovingVehicle& vehicle) {
  const multibody::MechanismModel& model = vehicle.mechanism.model();
  if (vehicle.wheels.empty()) return "it has no wheels";
  if (vehicle.mechanism.has_friction()) return "a joint slides with friction";
  if (!vehicle.contacts.empty()) return "bodies of it touch each other";
  for (std::size_t i = 0; i < model.drivers.size(); ++i) {
    const multibody::Driver& driver = model.drivers[i];
    if (std::find(vehicle.drives.begin(), vehicle.drives.end(), static_cast<int>(i)) != vehicle.drives.end()) continue;
    if (!driver.value.straight()) return fmt::format("its driver '{}' changes its speed", driver.name);
    if (!vehicle.speed.constant() && (driver.coordinate == 0 || driver.value.rate(0.0) != 0.0))
      return fmt::format("its driver '{}' does not follow the changing speed of the train", driver.name);
  }
  for (const multibody::Spring& spring : model.springs) {
    if (spring.law) return fmt::format("its spring '{}' follows a law that is not linear", spring.name);
    if (spring.winding) return fmt::format("its spring '{}' is wound up or off", spring.name);
    if (spring.bodies[0] == multibody::ground || spring.bodies[1] == multibody::ground)
      return fmt::format("its spring '{}' is held by the ground", spring.name);
  }
  for (const multibody::TorsionSpring& spring : model.torsion_springs)
    if (spring.law) return fmt::format("its torsion spring '{}' follows a law that is not linear", spring.name);
  if (!model.ropes.empty()) return fmt::format("its rope '{}' only pulls", model.ropes.front().name);
  for (const multibody::Joint& joint : model.joints)
    if (joint.bodies[0] == multibody::ground || joint.bodies[1] == multibody::ground)
      return fmt::format("its joint '{}' is held by the ground", joint.name);
  for (const Wheel& wheel : vehicle.wheels)
    for (const multibody::Joint& joint : model.joints) {
      // A turning wheel moves the points of its joints around its centre.
      const bool attached = joint.bodies[0] == wheel.body || joint.bodies[1] == wheel.body;
      const Eigen::Vector2d centre = model.bodies[static_cast<std::size_t>(wheel.body)].position.head<2>();
      const bool turns = wheel.law.friction > 0.0;
      if (attached && turns && joint.type == multibody::JointType::revolute && (joint.point - centre).norm() > 1e-9)
        return fmt::format("its joint '{}' is beside the centre of a wheel that turns", joint.name);
    }
  return {};
}

LinearDynamics::LinearDynamics(MovingVehicle& vehicle, const double* cruise) {
  multibody::Mechanism& mechanism = vehicle.mechanism;
  multibody::MechanismState& state = vehicle.state;
  const int f = vehicle.freedom();
  c_ = Eigen::Map<const Eigen::VectorXd>(cruise, f);
  p0_.resize(f);
  for (int i = 0; i < f; ++i) p0_[i] = state.q[mechanism.partition().independent[static_cast<std::size_t>(i)]];
  for (Eigen::VectorXd* x : {&x_, &xd_, &xdd_, &force_, &R_}) x->setZero(f);
  q0_ = state.q;
  mechanism.compute_B(state);
  B_ = state.B;
  set_travel(vehicle, 0.0);
  const Eigen::VectorXd b = vehicle.speed.constant() ? state.b : rates_of_drives(vehicle, B_);
  u_ = B_ * c_ + b;
  drives_ = !mechanism.model().drivers.empty();
  columns_ = state.columns;

  state.d -= acceleration_ * b;
  mechanism.recover(state, vehicle.Q, x_.data());  // without acceleration: the reactions for K
  state.d += acceleration_ * b;
  M_ = B_.transpose() * mechanism.mass_diagonal().asDiagonal() * B_;
  Eigen::MatrixXd product;
  mechanism.multiply_tangent(state, -1.0, 0.0, 1.0, product);
  K_ = B_.transpose() * product;
  mechanism.multiply_tangent(state, 0.0, -1.0, 0.0, product);
  C_ = B_.transpose() * product;
  // r0 for the steady motion, from which the state's velocities may differ.
  r0_ = -B_.transpose() * state.g;
  for (int i = 0; i < f; ++i)
    xd_[i] = state.qd[mechanism.partition().independent[static_cast<std::size_t>(i)]] - rate_ * c_[i];
  r0_ -= C_ * xd_;
  driven_ = B_.transpose() * mechanism.mass_diagonal().cwiseProduct(u_);
  driven_mass_ = u_.dot(mechanism.mass_diagonal().cwiseProduct(u_));
  mass_.compute(M_);
  const multibody::MechanismEnergy start = mechanism.energy(state);
  initial_energy_ = start.strain + start.potential;
}

void LinearDynamics::set_travel(const MovingVehicle& vehicle, double t) {
  time_ = t;
  s_ = vehicle.travel.value(t);
  rate_ = vehicle.travel.rate(t);
  acceleration_ = vehicle.travel.acceleration(t);
}

bool LinearDynamics::set(MovingVehicle& vehicle, double t, const double* p, const double* pd) {
  const auto f = p0_.size();
  set_travel(vehicle, t);
  x_ = Eigen::Map<const Eigen::VectorXd>(p, f) - p0_ - s_ * c_;
  xd_ = Eigen::Map<const Eigen::VectorXd>(pd, f) - rate_ * c_;
  multibody::MechanismState& state = vehicle.state;
  state.time = t;
  state.q = q0_ + s_ * u_;
  state.q.noalias() += B_ * x_;
  state.qd = rate_ * u_;
  state.qd.noalias() += B_ * xd_;
  return true;
}

void LinearDynamics::shift(MovingVehicle& vehicle, const double* change, double rate) {
  const Eigen::Map<const Eigen::VectorXd> dx(change, x_.size());
  x_ += dx;
  xd_ += rate * dx;
  vehicle.state.q.noalias() += B_ * dx;
  vehicle.state.qd.noalias() += rate * (B_ * dx);
}

// Only the rows of wheels in Q are non-zero.
void LinearDynamics::find_force(const MovingVehicle& vehicle) {
  force_ = -r0_ - acceleration_ * driven_;
  force_.noalias() -= C_ * xd_;
  force_.noalias() -= K_ * x_;
  for (const Wheel& wheel : vehicle.wheels) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(wheel.body);
    const auto [first, last] = columns_[static_cast<std::size_t>(wheel.body)];
    force_.segment(first, last - first).noalias() +=
        B_.block(row, first, 3, last - first).transpose() * vehicle.Q.segment<3>(row);
  }
  for_actions(vehicle, time_, [&](Eigen::Index q, double action, double at_start) {
    force_ += (action - at_start) * B_.row(q).transpose();
  });
}

void LinearDynamics::accelerations(MovingVehicle& vehicle, double* pdd) {
  find_force(vehicle);
  xdd_ = mass_.solve(force_);
  Eigen::Map<Eigen::VectorXd>(pdd, xdd_.size()) = xdd_;
}

void LinearDynamics::recover(MovingVehicle&, const double* pdd) {
  xdd_ = Eigen::Map<const Eigen::VectorXd>(pdd, x_.size());
}

// The drive has the power s' u^T (N q'' - g - Q); internal springs do not contribute to it.
base::Powers LinearDynamics::powers(const MovingVehicle& vehicle) const {
  double lost = 0.0;
  for (Eigen::Index i = 0; i < xd_.size(); ++i) lost += xd_[i] * C_.col(i).dot(xd_);
  const double force = driven_.dot(xdd_) + driven_mass_ * acceleration_ - u_.dot(vehicle.Q);
  base::Powers powers{lost, drives_ ? rate_ * force : 0.0};
  for_actions(vehicle, time_, [&](Eigen::Index q, double action, double) {
    powers.work += action * ((drives_ ? 0.0 : u_[q]) + B_.row(q).dot(xd_));
  });
  return powers;
}

multibody::MechanismEnergy LinearDynamics::energy(const MovingVehicle& vehicle) const {
  const std::vector<int>& independent = vehicle.mechanism.partition().independent;
  const double s = vehicle.travel.value(vehicle.state.time), rate = vehicle.travel.rate(vehicle.state.time);
  Eigen::VectorXd x(p0_.size()), xd(p0_.size());  // computed from the state, which another rank may have sent
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const int coordinate = independent[static_cast<std::size_t>(i)];
    x[i] = vehicle.state.q[coordinate] - p0_[i] - s * c_[i];
    xd[i] = vehicle.state.qd[coordinate] - rate * c_[i];
  }
  const Eigen::VectorXd q = B_ * x, qd = rate * u_ + B_ * xd;
  const Eigen::VectorXd& mass = vehicle.mechanism.mass_diagonal();
  multibody::MechanismEnergy e;
  e.kinetic = 0.5 * qd.dot(mass.cwiseProduct(qd));
  const multibody::MechanismModel& model = vehicle.mechanism.model();
  for (Eigen::Index i = 1; i < q.size(); i += 3)
    e.potential += mass[i] * model.gravity * (q0_[i] + q[i] + model.gradient * (q0_[i - 1] + q[i - 1]));
  e.strain = initial_energy_ + r0_.dot(x) + 0.5 * x.dot(K_ * x) - e.potential;
  return e;
}

// Evaluates the mechanism at the same coordinates.
bool LinearDynamics::observe(MovingVehicle& vehicle, const double* pdd) {
  position_ = p0_ + s_ * c_ + x_;
  velocity_ = rate_ * c_ + xd_;
  pdd_ = Eigen::Map<const Eigen::VectorXd>(pdd, x_.size()) + acceleration_ * c_;
  multibody::MechanismState& state = vehicle.state;
  if (!vehicle.mechanism.set_positions(state, time_, position_.data())) {
    linearisation_residual_ = std::numeric_limits<double>::infinity();
    return true;
  }
  vehicle.mechanism.set_velocities(state, time_, velocity_.data());
  vehicle.mechanism.compute_forces(state);
  vehicle.mechanism.recover(state, vehicle.Q, pdd_.data());
  r_ = vehicle.mechanism.mass_diagonal().cwiseProduct(state.qdd) - state.g - vehicle.Q;
  state.dependent_block.project(r_, R_);
  if (R_.size() > 0)
    linearisation_residual_ = std::max(linearisation_residual_, R_.lpNorm<Eigen::Infinity>() / vehicle.scale);
  return true;
}

bool LinearDynamics::find_residual(MovingVehicle& vehicle, const double* pdd, ContactCompliance& compliance) {
  find_force(vehicle);
  R_ = -force_;
  R_.noalias() += M_ * Eigen::Map<const Eigen::VectorXd>(pdd, x_.size());
  compliance.residual = R_.size() > 0 ? R_.lpNorm<Eigen::Infinity>() / vehicle.scale : 0.0;
  return true;
}

bool LinearDynamics::matrix_is_valid(const MovingVehicle&, const StageShifts& shifts, bool) const {
  return !shifts.statics() && shifts_.like(shifts);
}

void LinearDynamics::renew(MovingVehicle&, const StageShifts& shifts, bool, ContactRows rows,
                           ContactCompliance& compliance) {
  shifts_ = shifts;
  J_ = shifts.acceleration * M_ + shifts.rate * C_ + K_;
  newton_.renew(rows, columns_, B_, nullptr, shifts.statics(), J_, compliance);
}

double linearisation_residual_at(MovingVehicle& vehicle, const double* x) {
  const LinearMatrices of = vehicle.dynamics->linear()->matrices();
  const Eigen::VectorXd p = of.p0 + Eigen::Map<const Eigen::VectorXd>(x, of.p0.size());
  const Eigen::VectorXd pd = vehicle.travel.rate(0.0) * of.c;
  Eigen::VectorXd pdd(vehicle.freedom());
  AnyDynamics moved = vehicle.dynamics;  // a copy without earlier observations
  moved->set(vehicle, 0.0, p.data(), pd.data());
  moved->accelerations(vehicle, pdd.data());
  moved->observe(vehicle, pdd.data());
  return moved->linear()->linearisation_residual();
}

std::vector<double> residual_roots(MovingVehicle vehicle) {
  constexpr double small_coordinate =
      1e-3;  // m or rad: the residual is far above rounding, and higher powers are negligible
  std::vector<double> x(static_cast<std::size_t>(vehicle.freedom()), 0.0), roots;
  for (double& coordinate : x) {
    coordinate = small_coordinate;
    roots.push_back(std::sqrt(linearisation_residual_at(vehicle, x.data())) / small_coordinate);
    coordinate = 0.0;
  }
  return roots;
}

}  // namespace traverse::train
