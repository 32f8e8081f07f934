// Where the files are that are installed for all users.
#pragma once

#include <string>

namespace traverse::options {

/// The path of a file or folder of share/traverse, which is installed for all users: under the prefix of the running
/// program, under that of the shared library, or under that which the build was configured for, for programs of others
/// that contain the library. path: relative to share/traverse. Empty if it does not exist.
std::string installed_path(const std::string& path);

}  // namespace traverse::options
