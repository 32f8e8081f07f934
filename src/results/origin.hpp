// What a results file came from: the options and the texts of all files that the scene was read from, as they were.
#pragma once

#include <string>
#include <vector>

#include "options/input_texts.hpp"
#include "traverse/options/entry.hpp"

namespace traverse::results {

namespace hdf5 {
class File;
}

/// Stores what is in force, under /input. Nothing where no options are in force.
void record_origin(hdf5::File& file);

/// Whether there is an HDF5 file of that name.
bool is_hdf5(const std::string& path);

/// The options that the run of a results file had, but for its output file and what belongs to that one run; from now
/// on files that they name are read out of it. InputError where it holds none.
std::vector<options::Entry> origin_of(const std::string& path);
/// The results file that origin_of has read; empty: none.
const std::string& opened_origin();
/// Whether an output file is the new name that origin_of gives where the user gives none.
bool is_new_name(const options::Entry& output_file);

}  // namespace traverse::results
