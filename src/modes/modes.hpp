// Natural frequencies and mode shapes by SLEPc, without and with damping, and the Rayleigh coefficients of eqs. 19-20.
#pragma once

#include <complex>
#include <utility>
#include <vector>

#include "beam/beam.hpp"
#include "beam/shape_points.hpp"

namespace traverse::modes {

struct Modes {
  std::vector<double> omega;               // rad/s, ascending, repeated as often as they occur
  std::vector<char> axial;                 // per mode: non-zero for motion along x, else bending
  std::vector<std::vector<double>> shape;  // per mode: deflection at every point asked for, largest magnitude 1;
                                           // of an axial mode the displacement along x. All zero where a mode turns
                                           // the points without moving them (the nodes of one element a span)
  std::vector<double> x{};                 // of these points, m
  /// Of these shapes, where all of them go through without a kink: the slope at every point (1/m) and the modal mass,
  /// phi^T M phi (kg).
  std::vector<std::vector<double>> slope{};
  std::vector<double> mass{};
  std::vector<double> ratio{};  // damping of each, where modes move each by itself
};

/// Collective; the same result on every rank, to the last bit. The `count` lowest frequencies of M, K*.
/// What does not couple (isolated spans, pieces between clamped nodes, axial motion and bending) is solved one by
/// one, equal pieces once; copies of a repeated frequency are counted by inertia and none is missed. Rigid modes
/// come out as exactly 0. count may exceed the number of unknowns: then all of them. Throws SolverError when SLEPc
/// fails. The relative error, by rounding, of the lowest frequency is about 0.02 eps n^4 for n elements between
/// supports: 3e-6 for 1,000, 2 % for 10,000.
/// `shapes`: at the nodes.
Modes natural_modes(const beam::Beam& beam, int count, bool shapes);
/// With shapes at these points of the bridge.
Modes natural_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points);

/// Modes of bending as vectors of all unknowns of the beam (all ranks'), with phi^T M phi = 1 kg.
struct Basis {
  std::vector<double> omega;               // rad/s, ascending
  std::vector<std::vector<double>> shape;  // m for 1 m kg^(1/2) of the mode's coordinate
};

/// Collective; the same on every rank. The `count` lowest modes of bending, and the remaining copies of the last
/// one's frequency, so that nothing depends on which of equal spans comes first. Not for layered tracks.
Basis bending_basis(const beam::Beam& beam, int count);

/// The `count` lowest of the modes that the beam's model gives.
Basis given_basis(const beam::Beam& beam, int count);

/// A basis as modes are stored: deflections at these points of the bridge, the largest 1.
Modes as_stored(const beam::Beam& beam, const Basis& basis, const beam::ShapePoints& points);

/// Solutions v = Re(shape exp(lambda t)) of M a + C* w + K* v = 0: of each pair of conjugates the one with Im >= 0.
struct DampedModes {
  std::vector<std::complex<double>> lambda;              // 1/s, ascending in magnitude
  std::vector<char> axial;                               // per mode: non-zero for motion along x, else bending
  std::vector<std::vector<std::complex<double>>> shape;  // as in Modes; the displacement of largest magnitude is 1

  std::size_t size() const { return lambda.size(); }
  double omega(std::size_t i) const { return std::abs(lambda[i]); }          // rad/s
  double damped_omega(std::size_t i) const { return lambda[i].imag(); }      // rad/s, 0 where nothing oscillates
  double decay_rate(std::size_t i) const { return 0.0 - lambda[i].real(); }  // 1/s
  /// -Re/|lambda|: 1 for a real mode that decays, 0 for a rigid one.
  double ratio(std::size_t i) const { return omega(i) > 0.0 ? decay_rate(i) / omega(i) : 0.0; }
};

/// Collective; the same result on every rank, to the last bit. After Beam::set_rayleigh. The `count` modes of lowest
/// |lambda| of lambda^2 M + lambda C* + K*: oscillating pairs once each, every real mode by itself, rigid motions as
/// exactly 0, once each (where dampers resist one, its decay is a mode of its own). Segments as for natural_modes, so
/// equal isolated spans keep all their copies; of a frequency that one connected part has more than once, copies may
/// be missed, except where C* of the part is a combination of M and K*.
///
/// There (C* = a M + b K*) every natural mode gives a pair lambda^2 + (a + b omega^2) lambda + omega^2 = 0, and
/// the `count` lowest natural modes are taken. Elsewhere, and with b > 0, every high frequency of the mesh has a real
/// mode near -1/b: modes with |lambda| >= 1/b mean nothing, and the list may end there before `count`.
///
/// Relative error against the exact modes of the mesh below 1e-8, and by rounding as in natural_modes; more, up to
/// 1e-5, for modes 1e4 and more times faster than a creeping one. Crowded modes of a long bridge cost far more than
/// without damping. Throws SolverError when SLEPc fails.
DampedModes damped_modes(const beam::Beam& beam, int count, bool shapes);
DampedModes damped_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points);

/// Whether C* has any entry that is not zero. Collective, after Beam::set_rayleigh.
bool damped(const beam::Beam& beam);

/// The first `count` distinct non-zero natural frequencies of bending (rad/s) or as many as there are, as distinct_pair
/// has them.
std::vector<double> distinct_frequencies(const beam::Beam& beam, std::size_t count);

/// The first two distinct non-zero natural frequencies of bending (rad/s), however often each one occurs; distinct:
/// by more than 1e-6 of their value, or 1 % where they belong to spans that nothing couples. Motion along x is left
/// out, so that damping does not depend on whether it is modelled. Throws InputError where there are not two: with one
/// or two free unknowns.
std::pair<double, double> distinct_pair(const beam::Beam& beam);

/// Eq. 20 (with its exact limit when zeta1 = zeta2). omega1 != omega2. Throws InputError where zeta2/zeta1 is not
/// between omega1/omega2 and omega2/omega1: a or b would be negative, and negative damping feeds energy.
beam::Rayleigh rayleigh(double omega1, double omega2, double zeta1, double zeta2);

}  // namespace traverse::modes
