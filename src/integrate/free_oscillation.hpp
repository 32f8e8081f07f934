// Free oscillations, exact for any time.
#pragma once

namespace traverse::integrate {

/// (u, u') at t + dt is {uu, uw; wu, ww} (u, u') at t.
struct FreeOscillation {
  double uu, uw, wu, ww;
};

/// The free oscillation u'' + 2 sigma u' + omega^2 u = 0 over a time dt, s, also if overdamped; omega, sigma in 1/s.
FreeOscillation free_oscillation(double omega, double sigma, double dt);

}  // namespace traverse::integrate
