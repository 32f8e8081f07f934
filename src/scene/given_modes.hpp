// A bridge's natural modes out of a file: text, or HDF5 as results/modes_text.hpp has it.
#pragma once

#include <string>

#include "traverse/beam/given_modes.hpp"

namespace traverse::app {

/// The modes with their shapes along one of the file's tracks, counted from 1. InputError naming file and line.
///
/// Lines of the text hold words and numbers with commas between; # begins a comment.
///   frequency, f1, f2, ...            Hz
///   modal_mass, m1, m2, ...           kg, for the shapes as they are given
///   damping_ratio, z1, z2, ...        1; one serves all
///   output, NAME, UNIT, c1, c2, ...   what a coordinate of 1 of each shape gives
///   track, 1                          the lines that follow are of this track; left out: there is one
///   x, shape1, shape2, ...            a station, m, with every shape there; or with all slopes behind all shapes
beam::GivenModes read_given_modes(const std::string& path, int track);

}  // namespace traverse::app
