// Reads the natural modes of a bridge from a file: text, or HDF5 as described in results/origin.hpp.
#pragma once

#include <string>

#include "traverse/beam/model.hpp"

namespace traverse::scene {

/// The modes with their shapes along one of the tracks of the file, counted from 1. InputError with file and line.
///
/// A line has words and numbers separated by commas; # begins a comment.
///   frequency, f1, f2, ...            Hz
///   modal_mass, m1, m2, ...           kg, for the given shapes
///   damping_ratio, z1, z2, ...        1; a single one applies to all modes
///   output, NAME, UNIT, c1, c2, ...   the value per unit coordinate of each mode
///   track, 1                          the following lines are of this track; not needed for one track
///   x, shape1, shape2, ...            a station, m, with all shapes, or with all shapes and then all slopes
beam::GivenModes read_given_modes(const std::string& path, int track);

}  // namespace traverse::scene
