// The mechanism's own equations of motion at coordinates where its linear model has been.
#include "train/linearisation_residual.hpp"

#include <cmath>

namespace traverse::train {

double linearisation_residual_at(MovingVehicle& vehicle, const double* x) {
  const LinearMatrices of = vehicle.dynamics->linear()->matrices();
  const Eigen::VectorXd p = of.p0 + Eigen::Map<const Eigen::VectorXd>(x, of.p0.size());
  Eigen::VectorXd pdd(vehicle.freedom());
  AnyDynamics moved = vehicle.dynamics;  // one that has not seen anything else
  moved->set(vehicle, 0.0, p.data(), of.c.data());
  moved->accelerations(vehicle, pdd.data());
  moved->observe(vehicle, pdd.data());
  return moved->defect();
}

std::vector<double> residual_roots(MovingVehicle vehicle) {
  constexpr double little = 1e-3;  // m or rad: the square is far from rounding, all higher powers are far below it
  std::vector<double> x(static_cast<std::size_t>(vehicle.freedom()), 0.0), roots;
  for (double& one : x) {
    one = little;
    roots.push_back(std::sqrt(linearisation_residual_at(vehicle, x.data())) / little);
    one = 0.0;
  }
  return roots;
}

}  // namespace traverse::train
