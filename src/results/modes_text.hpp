// Natural modes of an HDF5 file as text, the input of scene/given_modes.hpp, which results files also store.
#pragma once

#include <string>

namespace traverse::results {

/// Reads the group /modes of a file: frequency, modal_mass, modal_damping_ratio [m], x [p], shape [m,p] or
/// [tracks,m,p], slope with the same shape (optional), axial [m] (modes with 1 are ignored), outputs/NAME [m] with the
/// attribute `unit`. Throws InputError that names file and dataset.
std::string modes_as_text(const std::string& path);

}  // namespace traverse::results
