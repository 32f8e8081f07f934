// Where the sources and the program are. Only one small file of each build names them, so that a cache of compiled
// files serves every checkout.
#pragma once

#include <string>

namespace traverse {

std::string source_folder();
std::string program_path();

}  // namespace traverse
