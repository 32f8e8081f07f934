// The text that -help prints.
#pragma once

#include <string>

namespace traverse::app {

/// Help text on everything (empty `what`), on a group of options, on one option or on `integrators`; `man`: the manual
/// page; `bash`: the completion for that shell. InputError for any other word.
std::string help_about(const std::string& what);

}  // namespace traverse::app
