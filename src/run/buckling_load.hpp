// The buckling load of a beam under compression (beam_tension below 0).
#pragma once

#include "beam/beam.hpp"

namespace traverse::run {

/// Collective. The largest magnitude of the compression along the beam, N, at which the beam buckles, for compression
/// distributed as in its model. Its rotational bed is the compression: a stiffness below 0.
double buckling_load(const beam::Beam& compressed);

}  // namespace traverse::run
