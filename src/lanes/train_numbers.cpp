#include "lanes/train_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "train/linearisation_residual.hpp"

namespace traverse::lanes {
namespace {

constexpr double same = 1e-9;  // of the largest entry: vehicles are alike, but for rounding

std::vector<double> by_rows(const Eigen::MatrixXd& A) {
  std::vector<double> numbers;
  const double none = 1e-14 * A.cwiseAbs().maxCoeff();  // what rounding leaves of a zero
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j) numbers.push_back(std::abs(A(i, j)) > none ? A(i, j) : 0.0);
  return numbers;
}

bool alike(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  for (const double value : a) scale = std::max(scale, std::abs(value));
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= same * scale; });
}

bool alike(const VehicleNumbers& a, const VehicleNumbers& b, double weight) {
  return a.freedom == b.freedom && a.wheels == b.wheels && alike(a.M, b.M, 0.0) && alike(a.C, b.C, 0.0) &&
         alike(a.K, b.K, 0.0) && alike(a.G, b.G, 0.0) && alike(a.G_along, b.G_along, 0.0) && alike(a.r0, b.r0, weight);
}

VehicleNumbers numbers_of(train::MovingVehicle& vehicle) {
  const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
  VehicleNumbers v;
  v.freedom = vehicle.freedom();
  v.wheels = static_cast<int>(vehicle.wheels.size());
  v.M = by_rows(of.M);
  v.C = by_rows(of.C);
  v.K = by_rows(of.K);
  v.r0.assign(of.r0.begin(), of.r0.end());
  const auto rows_of_wheels = [&](Eigen::Index coordinate) {
    Eigen::MatrixXd G(v.wheels, v.freedom);
    for (int j = 0; j < v.wheels; ++j)
      G.row(j) = of.B.row(3 * static_cast<Eigen::Index>(vehicle.wheels[static_cast<std::size_t>(j)].body) + coordinate);
    return by_rows(G);
  };
  v.G_along = rows_of_wheels(0);
  v.G = rows_of_wheels(1);
  v.bend = train::residual_roots(vehicle);
  v.driven.assign(of.driven.begin(), of.driven.end());
  return v;
}

/// Of every coordinate its rate at the start, but for the steady motion, over the speed.
std::vector<double> follow_of(const train::MovingVehicle& vehicle) {
  const Eigen::VectorXd& qd = vehicle.state.qd;
  const double speed = qd[3 * static_cast<Eigen::Index>(vehicle.wheels.front().body)];
  std::vector<double> follow(static_cast<std::size_t>(vehicle.freedom()), 0.0);
  for (std::size_t i = 0; i < follow.size() && speed != 0.0; ++i)
    follow[i] = (qd[vehicle.mechanism.partition().independent[i]] -
                 vehicle.dynamics->linear()->matrices().c[static_cast<Eigen::Index>(i)]) /
                speed;
  return follow;
}

}  // namespace

std::string obstacle(const train::Fleet& fleet) {
  if (!fleet.pairs.empty()) return "bodies of its vehicles touch each other";
  for (const train::MovingVehicle& vehicle : fleet.vehicles) {
    const auto no = [&](const std::string& why) { return fmt::format("vehicle '{}': {}", vehicle.name(), why); };
    if (vehicle.dynamics->linear() == nullptr) return no("it is not taken as linear");
    if (!vehicle.mechanism.model().actuators.empty()) return no("actuators act on it");
    for (const train::Wheel& wheel : vehicle.wheels) {
      const auto its = [&](const char* why) { return no(fmt::format("its wheel '{}' {}", wheel.name, why)); };
      if (wheel.law.damping != 0.0 || wheel.law.hysteresis) return its("has a contact with damping");
      if (wheel.law.friction != 0.0) return its("has a contact with friction");
      if (!wheel.shape.round()) return its("is out of round");
      if (wheel.radius != fleet.vehicles.front().wheels.front().radius) return its("has another radius than others");
    }
  }
  for (const train::WheelContact& wheel : fleet.wheels)
    if (wheel.sharp) return "a wheel may touch the track at several points";
  return {};
}

TrainNumbers train_numbers(train::Fleet& fleet) {
  TrainNumbers train;
  for (train::MovingVehicle& vehicle : fleet.vehicles) {
    const std::vector<double> follow = follow_of(vehicle);
    train.follow.insert(train.follow.end(), follow.begin(), follow.end());
    VehicleNumbers own = numbers_of(vehicle);
    const auto kind = std::find_if(train.kinds.begin(), train.kinds.end(),
                                   [&](const VehicleNumbers& known) { return alike(known, own, vehicle.scale); });
    train.vehicles.push_back(
        {static_cast<std::size_t>(kind - train.kinds.begin()), vehicle.offset, static_cast<int>(train.x.size())});
    if (kind == train.kinds.end()) train.kinds.push_back(std::move(own));
    for (std::size_t j = 0; j < vehicle.wheels.size(); ++j) {
      const train::WheelContact& contact = fleet.wheels[static_cast<std::size_t>(vehicle.first_wheel) + j];
      train.x.push_back(fleet.coordinates(contact).x());
      train.penetration.push_back(contact.kinematics.penetration);
      train.arm.push_back(vehicle.wheels[j].radius - contact.kinematics.penetration);
      train.stiffness.push_back(contact.law.stiffness);
      train.hertz.push_back(contact.law.kind == contact::LawKind::hertz ? 1 : 0);
      train.force_scale = std::max(train.force_scale, contact.force.normal);
    }
  }
  train.coordinates = fleet.freedom();
  train.radius = fleet.vehicles.front().wheels.front().radius;
  return train;
}

double defect(train::Fleet& fleet, const std::vector<double>& x) {
  double largest = 0.0;
  for (train::MovingVehicle& vehicle : fleet.vehicles)
    largest = std::max(largest, train::linearisation_residual_at(vehicle, x.data() + vehicle.offset));
  return largest;
}

}  // namespace traverse::lanes
