// Exact reference for chains of uniform Bernoulli-Euler beams, or of bars: the dynamic stiffness matrix of each piece
// from the solution of its differential equation, without shape functions.
//
//   bending  EI v'''' + (m s^2 + c s + k) v = q        along x  -EA u'' + (m s^2 + c s + k) u = q
//
// s = i omega: natural frequencies; s = 0: statics; any s: damped modes. All numbers are long double. Pieces are
// divided until the power series of the solutions need a few terms only. Then no terms cancel, and no piece with held
// ends has a natural frequency in the range, so that Sturm's sequence counts all modes (Wittrick and Williams 1971, Q.
// J. Mech. Appl. Math. 24, 263-284, with J_0 = 0).
#pragma once

#include <complex>
#include <vector>

namespace traverse::test::exact {

using Real = long double;

enum class Motion { bending, axial };

/// A uniform piece: length in m; EI in N m2 or EA in N; mass in kg/m; a bed in N/m2 and N s/m2; a distributed force in
/// N/m.
struct Piece {
  double length, stiffness, mass, bed_k = 0.0, bed_c = 0.0, load = 0.0;
};

/// Supports and loads of the chain between two pieces and at its ends. The first of each pair belongs to v (or u),
/// the second to the rotation.
struct Joint {
  bool held[2] = {false, false};
  double k[2] = {0.0, 0.0};
  double c[2] = {0.0, 0.0};
  double load[2] = {0.0, 0.0};  // N upward, N m counter-clockwise
};
constexpr Joint free_end{}, on_roller{{true, false}}, clamped{{true, true}}, guided{{false, true}};

struct Chain {
  Motion motion = Motion::bending;
  std::vector<Piece> pieces;
  std::vector<Joint> joints;  // pieces + 1
};

/// The `count` lowest natural frequencies, rad/s. Rigid motions have values below 1e-6 of the next frequency.
std::vector<double> frequencies(const Chain& chain, int count);

/// Static displacements at every joint, and the section forces on both sides of it. Bending: v, rotation, moment
/// (sagging positive) and shear dM/dx. Axial: u and the axial force; the other values are zero.
struct Section {
  double v = 0.0, rotation = 0.0, u = 0.0;
  double moment_left = 0.0, moment_right = 0.0, shear_left = 0.0, shear_right = 0.0;
  double axial_left = 0.0, axial_right = 0.0;
};
std::vector<Section> statics(const Chain& chain);

/// The damped mode's exponent s next to `start`, a root of the determinant by the secant method.
std::complex<double> damped_root(const Chain& chain, std::complex<double> start);

}  // namespace traverse::test::exact
