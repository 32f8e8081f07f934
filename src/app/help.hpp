// What -help says.
#pragma once

#include <string>

namespace traverse::app {

/// Of everything, a group of options, one option, or `integrators`; `man`: the manual page; `bash`: completion for that
/// shell. InputError for something else.
std::string help_about(const std::string& what);

}  // namespace traverse::app
