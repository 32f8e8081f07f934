// The list of vehicles, trains and loads that come with the program, for -help vehicles.
#pragma once

#include <string>

namespace traverse::options {

/// A table for each folder of the library: file, and the sentence after `# What:` in its head. A folder is searched as
/// the files of a scene are (find_file), then beside the folder of the program, as in a build tree. InputError if there
/// is no such folder.
std::string vehicle_library();

}  // namespace traverse::options
