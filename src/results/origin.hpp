// The origin of a results file: the options and the texts of all input files, unchanged; and natural modes of an HDF5
// file as text, the input of scene/given_modes.hpp, which results files also store.
#pragma once

#include <string>
#include <vector>

#include "options/input_texts.hpp"
#include "traverse/options/entry.hpp"

namespace traverse::results {
namespace hdf5 {
class File;
}

/// Stores the present options under /input; nothing if there are none.
void record_origin(hdf5::File& file);

/// Whether the path is an existing HDF5 file.
bool is_hdf5(const std::string& path);

/// The options of the run of a results file, except for its output file and options that apply to a single run only.
/// Afterwards files that the options name are read from the results file. InputError if it contains no options.
std::vector<options::Entry> origin_of(const std::string& path);
/// The results file that origin_of has read; empty: none.
const std::string& opened_origin();
/// Whether an output file is the default name that origin_of sets.
bool is_new_name(const options::Entry& output_file);

/// Reads the group /modes of a file: frequency, modal_mass, modal_damping_ratio [m], x [p], shape [m,p] or
/// [tracks,m,p], slope with the same shape (optional), axial [m] (modes with 1 are ignored), outputs/NAME [m] with the
/// attribute `unit`. Throws InputError that names file and dataset.
std::string modes_as_text(const std::string& path);

}  // namespace traverse::results
