// Closed-form solution of q'' + 2 sigma q' + omega^2 q = 0 after a time dt, for underdamped, critically damped and
// overdamped modes without loss of digits.
#include "integrate/free_oscillation.hpp"

#include <cmath>

namespace traverse::integrate {

FreeOscillation free_oscillation(double omega, double sigma, double dt) {
  const double square = (omega - sigma) * (omega + sigma);
  double even = 0.0, odd = 0.0;  // e^(-sigma t) cos, e^(-sigma t) sin over its frequency
  if (square > 0.0) {
    const double damped = std::sqrt(square), decay = std::exp(-sigma * dt);
    even = decay * std::cos(damped * dt);
    odd = decay * std::sin(damped * dt) / damped;
  } else {
    const double kappa = std::sqrt(-square), slow = std::exp(-omega * omega / (sigma + kappa) * dt);
    const double ratio = std::exp(-2.0 * kappa * dt);
    even = 0.5 * slow * (1.0 + ratio);
    odd = kappa * dt > 1e-8 ? -0.5 * slow * std::expm1(-2.0 * kappa * dt) / kappa : slow * dt;
  }
  return {even + sigma * odd, odd, -omega * omega * odd, even - sigma * odd};
}

}  // namespace traverse::integrate
