// Elastic forces of a beam with stiffness-proportional damping, where loads act inside elements.
#pragma once

#include <array>
#include <vector>

#include "traverse/beam/recovery.hpp"

namespace traverse::beam {

/// With damping b K (eq. 19) a section carries M + b dM/dt, M = EI v''. Equilibrium within an element gives this sum,
/// so what loads, inertia and foundation inside it add, c, reaches the elastic forces by m + b dm/dt = c: the moment
/// under a passing wheel has no kink, but follows b behind.
class ViscousLag {
 public:
  /// b in s, above 0.
  explicit ViscousLag(double b) : b_(b) {}

  /// Of all stations at ascending times: replaces what c adds to moment, shear and axial force by m. Between calls c is
  /// linear; at the first one the beam is at rest, m = c. Fills in moment_rate.
  void apply(double t, std::vector<Response>& responses);

 private:
  struct Inner {
    double c = 0.0, m = 0.0;
  };
  void follow(double& force, double nodal, Inner& inner) const;

  double b_;
  double time_ = 0.0, interval_ = 0.0, decay_ = 1.0;  // since the call before, and exp(-interval/b)
  std::vector<std::array<Inner, 3>> inner_;           // of each station: moment, shear, axial force
};

}  // namespace traverse::beam
