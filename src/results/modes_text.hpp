// Natural modes in an HDF5 file as text: what scene/given_modes.hpp reads, and what results keep of their input.
#pragma once

#include <string>

namespace traverse::results {

/// The group /modes of a file: frequency, modal_mass, modal_damping_ratio [m], x [p], shape [m,p] or [tracks,m,p],
/// slope likewise (may be left out), axial [m] (modes with 1 are left out), outputs/NAME [m] with the attribute `unit`.
/// InputError naming file and dataset.
std::string modes_as_text(const std::string& path);

}  // namespace traverse::results
