// Fleets: the formations of a table or of a folder of tables.
#pragma once

#include <string>
#include <vector>

#include "scene/formations.hpp"

namespace traverse::screen {

using scene::Formation;

/// The formations of a table, or of all tables of a folder in the order of their names; all names differ. notes: on how
/// the files are written. InputError with file and line.
std::vector<Formation> read_fleet(const std::string& path, std::vector<std::string>& notes);

}  // namespace traverse::screen
