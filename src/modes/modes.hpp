// Natural frequencies and mode shapes by SLEPc, without and with damping, and the Rayleigh coefficients of eqs. 19-20.
#pragma once

#include <complex>
#include <utility>
#include <vector>

#include "beam/beam.hpp"
#include "beam/shape_points.hpp"

namespace traverse::modes {

struct Modes {
  std::vector<double> omega;  // rad/s, ascending, repeated frequencies as often as they occur
  std::vector<char> axial;    // per mode: non-zero for motion along x, 0 for bending
  std::vector<std::vector<double>>
      shape;  // per mode: deflection at every requested point, for an axial mode the displacement along x; largest
              // magnitude 1. All zero if a mode only rotates the points (nodes, with one element per span)
  std::vector<double> x{};  // stations of the points, m
  /// The slope at every point (1/m) and the modal mass phi^T M phi (kg) of these shapes, if no shape can have a kink.
  std::vector<std::vector<double>> slope{};
  std::vector<double> mass{};
  std::vector<double> ratio{};  // damping ratio of each mode, if the modes are not coupled
};

/// Collective; the same result on every rank, to the last bit. The `count` lowest frequencies of M, K*. Uncoupled
/// segments (isolated spans, pieces between clamped nodes, axial motion and bending) are solved separately, equal ones
/// once. Copies of a repeated frequency are counted by inertia, so that none is missed. Rigid modes have the frequency
/// 0 exactly. If count exceeds the number of unknowns, all modes are returned. Throws SolverError if SLEPc fails. The
/// relative rounding error of the lowest frequency is about 0.02 eps n^4 for n elements between supports: 3e-6 for
/// 1,000, 2 % for 10,000.
/// `shapes`: whether to return the shapes at the nodes.
Modes natural_modes(const beam::Beam& beam, int count, bool shapes);
/// Natural modes with the shapes at these points of the bridge.
Modes natural_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points);

/// Modes of bending as vectors of all unknowns of the beam (of all ranks), with phi^T M phi = 1 kg.
struct Basis {
  std::vector<double> omega;               // rad/s, ascending
  std::vector<std::vector<double>> shape;  // m for 1 m kg^(1/2) of the mode's coordinate
};

/// Collective; the same on every rank. The `count` lowest modes of bending and the remaining copies of the last
/// frequency, so that the result does not depend on the order of equal spans. Not for layered tracks.
Basis bending_basis(const beam::Beam& beam, int count);

/// The `count` lowest given modes of the beam's model.
Basis given_basis(const beam::Beam& beam, int count);

/// A basis in the form of stored modes: deflections at these points of the bridge, with the largest value 1.
Modes as_stored(const beam::Beam& beam, const Basis& basis, const beam::ShapePoints& points);

/// Solutions v = Re(shape exp(lambda t)) of M a + C* w + K* v = 0. Of each conjugate pair only lambda with Im >= 0 is
/// stored.
struct DampedModes {
  std::vector<std::complex<double>> lambda;  // 1/s, ascending in magnitude
  std::vector<char> axial;                   // per mode: non-zero for motion along x, 0 for bending
  std::vector<std::vector<std::complex<double>>>
      shape;  // same layout as in Modes; the displacement of largest magnitude is 1

  std::size_t size() const { return lambda.size(); }
  double omega(std::size_t i) const { return std::abs(lambda[i]); }          // rad/s
  double damped_omega(std::size_t i) const { return lambda[i].imag(); }      // rad/s, 0 without oscillation
  double decay_rate(std::size_t i) const { return 0.0 - lambda[i].real(); }  // 1/s
  /// Damping ratio -Re/|lambda|: 1 for a real mode that decays, 0 for a rigid mode.
  double ratio(std::size_t i) const { return omega(i) > 0.0 ? decay_rate(i) / omega(i) : 0.0; }
};

/// Collective; the same result on every rank, to the last bit. Call Beam::set_rayleigh before. The `count` modes with
/// the lowest |lambda| of lambda^2 M + lambda C* + K*: every oscillating pair once, every real mode separately, every
/// rigid motion once with exactly 0 (if dampers resist it, its decay is an additional mode). The segments are those of
/// natural_modes, so that equal isolated spans keep all their copies. If one connected part has a frequency several
/// times, copies may be missed, unless C* of the part is a combination of M and K*.
///
/// In that case (C* = a M + b K*) every natural mode results in a pair of lambda^2 + (a + b omega^2) lambda + omega^2 =
/// 0, and the `count` lowest natural modes are used. Otherwise, if b > 0, every high frequency of the mesh has a real
/// mode near -1/b: modes with |lambda| >= 1/b are not meaningful, and the list may end there before `count`.
///
/// The relative error against the exact modes of the mesh is below 1e-8, plus the rounding error of natural_modes. It
/// is up to 1e-5 for modes 1e4 times or more faster than a creeping mode. Clusters of modes of a long bridge cost far
/// more than without damping. Throws SolverError if SLEPc fails.
DampedModes damped_modes(const beam::Beam& beam, int count, bool shapes);
DampedModes damped_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points);

/// Whether C* has a non-zero entry. Collective, after Beam::set_rayleigh.
bool damped(const beam::Beam& beam);

/// The first `count` distinct non-zero natural frequencies of bending (rad/s), or as many as exist, with the
/// distinction of distinct_pair.
std::vector<double> distinct_frequencies(const beam::Beam& beam, std::size_t count);

/// The first two distinct non-zero natural frequencies of bending (rad/s). Distinct frequencies differ by more than
/// 1e-6 of their value, or by more than 1 % if they belong to uncoupled spans. Motion along x is excluded, so that
/// damping does not depend on whether it is modelled. Throws InputError if there are not two: with one or two free
/// unknowns.
std::pair<double, double> distinct_pair(const beam::Beam& beam);

/// Eq. 20 (with its exact limit if zeta1 = zeta2). omega1 != omega2. Throws InputError if zeta2/zeta1 is not between
/// omega1/omega2 and omega2/omega1: a or b would be negative, and negative damping adds energy.
beam::Rayleigh rayleigh(double omega1, double omega2, double zeta1, double zeta2);

}  // namespace traverse::modes
