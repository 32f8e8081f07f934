// The layout of the numbers that kernels read for each mode at each speed (bridge_model.hpp), and for each mode and
// event (train_events.hpp).
#pragma once

namespace traverse::screen {

/// The numbers of a mode at one speed v; Omega = beta v.
enum Coefficient {
  decay,         // zeta omega / v, 1/m
  turn,          // omega_d / v, 1/m
  real_gain,     // of 1 / (omega^2 - Omega^2 + 2 i zeta omega Omega), s2
  imag_gain,     // its imaginary part
  falling_gain,  // 1 / (omega^2 + Omega^2 - 2 zeta omega Omega), s2, for exp(-beta xi)
  rising_gain,   // 1 / (omega^2 + Omega^2 + 2 zeta omega Omega), s2, for exp(-beta (L - xi))
  omega2_drive,  // Omega^2, 1/s2
  coefficients   // their number; the jumps at the supports follow, real and imaginary part of each
};

inline constexpr int sums_of_mode = 8;  // numbers of ModeSums

}  // namespace traverse::screen
