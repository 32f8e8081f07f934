// Natural frequencies and mode shapes by SLEPc, and the Rayleigh coefficients of eqs. 19-20.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "traverse/beam/beam.hpp"

namespace traverse::modes {

struct Modes {
  std::vector<double> omega;               // rad/s, ascending, repeated as often as they occur
  std::vector<char> axial;                 // per mode: non-zero for motion along x, else bending
  std::vector<std::vector<double>> shape;  // per mode: deflection at every node of the beam, largest magnitude 1;
                                           // of an axial mode the displacement along x. All zero where a mode turns
                                           // its nodes without moving them (one element a span)
};

/// Collective; the same result on every rank, to the last bit. The `count` lowest frequencies of M, K*.
/// What does not couple (isolated spans, pieces between clamped nodes, axial motion and bending) is solved one by
/// one, equal pieces once; copies of a repeated frequency are counted by inertia and none is missed. Rigid modes
/// come out as exactly 0. count may exceed the number of unknowns: then all of them. Throws SolverError when SLEPc
/// fails. The relative error, by rounding, of the lowest frequency is about 0.02 eps n^4 for n elements between
/// supports: 3e-6 for 1,000, 2 % for 10,000.
Modes natural_modes(const beam::Beam& beam, int count, bool shapes);

/// The first two distinct non-zero natural frequencies of bending (rad/s), however often each one occurs; distinct:
/// by more than 1e-6 of their value. Motion along x is left out, so that damping does not depend on whether it is
/// modelled. Throws InputError where there are not two: with one or two free unknowns.
std::pair<double, double> distinct_pair(const beam::Beam& beam);

/// Eq. 20 (with its exact limit when zeta1 = zeta2). omega1 != omega2. Ratios that differ much at neighbouring
/// frequencies give a negative a or b.
beam::Rayleigh rayleigh(double omega1, double omega2, double zeta1, double zeta2);

}  // namespace traverse::modes
