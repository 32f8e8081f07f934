// Free oscillations, exact for any time.
#pragma once

namespace traverse::integrate {

/// (u, u') at t + dt is {uu, uw; wu, ww} (u, u') at t.
struct FreeOscillation {
  double uu, uw, wu, ww;
};

/// For u'' + 2 sigma u' + omega^2 u = 0, in 1/s, over dt in s; also if overdamped.
FreeOscillation free_oscillation(double omega, double sigma, double dt);

}  // namespace traverse::integrate
