// The mechanism's own equations of motion at coordinates of its linear model.
#include "train/linearisation_residual.hpp"

#include <cmath>

namespace traverse::train {

double linearisation_residual_at(MovingVehicle& vehicle, const double* x) {
  const LinearMatrices of = vehicle.dynamics->linear()->matrices();
  const Eigen::VectorXd p = of.p0 + Eigen::Map<const Eigen::VectorXd>(x, of.p0.size());
  Eigen::VectorXd pdd(vehicle.freedom());
  AnyDynamics moved = vehicle.dynamics;  // a copy without earlier observations
  moved->set(vehicle, 0.0, p.data(), of.c.data());
  moved->accelerations(vehicle, pdd.data());
  moved->observe(vehicle, pdd.data());
  return moved->linearisation_residual();
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
