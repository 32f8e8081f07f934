// Natural frequencies and mode shapes by SLEPc, without and with damping, and the Rayleigh coefficients of eqs. 19-20.
#pragma once

#include <algorithm>
#include <complex>
#include <utility>
#include <vector>

#include "beam/beam.hpp"
#include "beam/shape.hpp"

namespace traverse::modes {

/// What a mode moves. Bending and twist are coupled if the mass is beside the shear centre.
enum class Motion { along, bending, twist, bending_and_twist };

struct Modes {
  std::vector<double> omega;  // rad/s, ascending, repeated frequencies as often as they occur
  std::vector<Motion> motion;
  std::vector<std::vector<double>>
      shape;  // per mode: deflection at every requested point, the displacement along x, or the twist; largest
              // magnitude 1. All zero if a mode only rotates the points (nodes, with one element per span)
  std::vector<double> x{};  // stations of the points, m
  /// The slope at every point (1/m) and the modal mass phi^T M phi (kg) of these shapes, if no shape can have a kink.
  std::vector<std::vector<double>> slope{};
  std::vector<double> mass{};
  std::vector<double> ratio{};  // damping ratio of each mode, if the modes are not coupled
  /// The terms of phi^T C* phi/(2 omega), also of coupled modes: by the beam's own damping, by dampers; 0 for a rigid
  /// mode. Empty before Beam::set_rayleigh and without shapes.
  std::vector<double> beam_ratio{}, damper_ratio{};
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
  std::vector<Motion> motion;
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

/// The first `count` distinct non-zero natural frequencies of bending (rad/s), or as many as exist. Distinct
/// frequencies differ by more than 1e-6 of their value, or by more than 1 % if they belong to uncoupled spans. Motion
/// along x is excluded, so that damping does not depend on whether it is modelled.
std::vector<double> distinct_frequencies(const beam::Beam& beam, std::size_t count);

/// A natural mode of bending, phi^T M phi = 1, with its terms outside of the beam's own damping C = a M_C + b K_C:
///
///   phi^T M_C phi = 1 - other_mass        phi^T K_C phi = omega^2 - springs
struct BendingMode {
  double omega = 0.0;       // rad/s
  double springs = 0.0;     // phi^T (K* - K_C) phi, 1/s2: foundation, cracks, tension
  double other_mass = 0.0;  // phi^T (M - M_C) phi: mass that a layered track adds
  double dampers = 0.0;     // phi^T (C* - C) phi, 1/s: dampers of the foundation

  double own_mass() const { return 1.0 - other_mass; }
  double own_stiffness() const { return std::max(0.0, omega * omega - springs); }
  /// Damping ratios by the beam's own damping, and by dampers.
  double ratio(beam::Rayleigh ab) const { return 0.5 * (ab.a * own_mass() + ab.b * own_stiffness()) / omega; }
  double damper_ratio() const { return 0.5 * dampers / omega; }
};

/// The modes of distinct_frequencies; for several modes of one frequency the means of their terms. `own_mass`: the
/// matrix M_C, if it is not the mass of this beam.
std::vector<BendingMode> distinct_modes(const beam::Beam& beam, std::size_t count, Mat own_mass = nullptr);

/// The terms of a motion with the frequency omega between those of these modes, linear in omega^2: exact at the modes,
/// on a bed, and without springs.
BendingMode between(const std::vector<BendingMode>& modes, double omega);

/// Eq. 20 for modes of the whole structure: a and b with 2 zeta omega = a phi^T M_C phi + b phi^T K_C phi for both
/// modes, whose frequencies differ. (With the exact limit if zeta1 = zeta2.) Throws InputError if a or b would be
/// negative: negative damping adds energy.
beam::Rayleigh rayleigh(const BendingMode& one, const BendingMode& other, double zeta1, double zeta2);

/// The frequencies of the first two of these distinct modes, rad/s. InputError if there are fewer.
std::pair<double, double> first_two(const std::vector<BendingMode>& modes);

struct RayleighPair {
  beam::Rayleigh ab;
  std::size_t second = 1;  // index of the second mode of the pair; the first is mode 0
};

/// a and b from the first two of these distinct modes. Where equal ratios of both would need a negative a or b, or
/// would damp the next mode beyond its critical damping, because the second mode moves the springs rather than bends
/// the beam, the next mode takes the place of the second. Throws InputError: fewer than two modes, or no such pair.
RayleighPair rayleigh_pair(const std::vector<BendingMode>& modes, double zeta1, double zeta2);

}  // namespace traverse::modes
