// The versions of the program, of the libraries that it uses now, and of the compiler.
#pragma once

#include <string>

namespace traverse::app {

/// One line for each: "traverse 1.0.0", "PETSc 3.18.5", ...
std::string versions();

}  // namespace traverse::app
