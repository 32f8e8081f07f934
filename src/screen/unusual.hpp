// Finds bridges and formations of a screen whose numbers are usual in another unit.
#pragma once

#include <string>
#include <vector>

#include "screen/screen_file.hpp"

namespace traverse::screen {

/// One line for each kind of finding, with the first bridge or formation that has it and the number of the others.
std::vector<std::string> unusual_in(const Problem& problem);

}  // namespace traverse::screen
