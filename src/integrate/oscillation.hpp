// Free oscillations of single modes and of modes that damping couples, exact for any time.
#pragma once

#include <Eigen/Core>

#include "base/bytes.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::integrate {

/// (u, u') at t + dt is {uu, uw; wu, ww} (u, u') at t.
struct FreeOscillation {
  double uu, uw, wu, ww;
};

/// The free oscillation u'' + 2 sigma u' + omega^2 u = 0 over a time dt, s, also if overdamped; omega, sigma in 1/s.
FreeOscillation free_oscillation(double omega, double sigma, double dt);

class CoupledOscillation {
 public:
  /// The oscillation of a bridge with coupled modes; the bridge must outlive this object.
  explicit CoupledOscillation(const structure::ModalBridge& bridge);

  /// Starts from u and its rate w.
  void start(const Eigen::VectorXd& u, const Eigen::VectorXd& w);
  /// The factors e^(lambda dt) of every complex mode for a time dt.
  Eigen::VectorXcd propagator(double dt) const;
  void move(const Eigen::VectorXcd& propagator);
  /// u and w, now or after a propagator's time.
  void evaluate(Eigen::VectorXd& u, Eigen::VectorXd& w);
  void keep(base::Bytes& bytes) { bytes(y_); }
  void evaluate_after(const Eigen::VectorXcd& propagator, Eigen::VectorXd& u, Eigen::VectorXd& w);

 private:
  const structure::ComplexModes& modes_;
  Eigen::Map<const Eigen::ArrayXd> omega_;
  Eigen::VectorXd y_, later_;  // coordinates of the complex modes: real parts, then imaginary parts
  Eigen::VectorXd state_;      // (Omega u, w)
};

}  // namespace traverse::integrate
