// Closed-form solution of q'' + 2 sigma q' + omega^2 q = 0 after a time dt, for underdamped, critically damped and
// overdamped modes without loss of digits. Each complex modal coordinate is multiplied by exp(lambda dt), in real
// arithmetic on real and imaginary parts.
#include "integrate/oscillation.hpp"

#include <cmath>

namespace traverse::integrate {
namespace {

/// Multiplies y by the propagator, in place.
void multiply_by(const Eigen::VectorXcd& propagator, Eigen::VectorXd& y) {
  const Eigen::Index count = propagator.size();
  for (Eigen::Index j = 0; j < count; ++j) {
    const double re = y[j], im = y[count + j], c = propagator[j].real(), s = propagator[j].imag();
    y[j] = c * re - s * im;
    y[count + j] = s * re + c * im;
  }
}

}  // namespace

CoupledOscillation::CoupledOscillation(const structure::ModalBridge& bridge)
    : modes_(bridge.complex_modes()), omega_(bridge.omega().data(), static_cast<Eigen::Index>(bridge.modes())) {
  y_.setZero(modes_.state.cols());
  state_.setZero(modes_.state.rows());
}

void CoupledOscillation::start(const Eigen::VectorXd& u, const Eigen::VectorXd& w) {
  state_.head(u.size()) = u.array() * omega_;
  state_.tail(w.size()) = w;
  y_.noalias() = modes_.coordinates * state_;
}

Eigen::VectorXcd CoupledOscillation::propagator(double dt) const { return (modes_.lambda.array() * dt).exp(); }

void CoupledOscillation::move(const Eigen::VectorXcd& propagator) { multiply_by(propagator, y_); }

void CoupledOscillation::evaluate(Eigen::VectorXd& u, Eigen::VectorXd& w) {
  state_.noalias() = modes_.state * y_;
  u = state_.head(omega_.size()).array() / omega_;
  w = state_.tail(omega_.size());
}

void CoupledOscillation::evaluate_after(const Eigen::VectorXcd& propagator, Eigen::VectorXd& u, Eigen::VectorXd& w) {
  later_ = y_;
  multiply_by(propagator, y_);
  evaluate(u, w);
  y_.swap(later_);
}

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
