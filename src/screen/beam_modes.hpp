// Exact natural modes of a continuous Bernoulli-Euler beam with uniform EI and mass on simple supports.
//
//   phi'''' = beta^4 phi,  omega = beta^2 sqrt(EI / mass)
//
// On a span of length L, with xi from its left end:
//   phi = a sin(beta xi) + b cos(beta xi) + c exp(-beta xi) + d exp(-beta (L - xi))
#pragma once

#include <array>
#include <span>
#include <vector>

namespace traverse::screen {

struct SpanShape {
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};

struct BeamMode {
  double beta = 0.0;             // 1/m
  std::vector<SpanShape> spans;  // 1/sqrt(m): the integral of phi^2 along the beam is 1
};

/// The `count` lowest modes; the wavenumbers by the count of Wittrick and Williams (Q. J. Mech. Appl. Math. 24, 1971),
/// which misses none.
std::vector<BeamMode> beam_modes(std::span<const double> spans, int count);

/// phi at a distance xi from the left end of a span of length L.
double shape_at(const SpanShape& shape, double beta, double L, double xi);
/// phi, phi' and phi'' there.
std::array<double, 3> shape_and_derivatives(const SpanShape& shape, double beta, double L, double xi);

}  // namespace traverse::screen
