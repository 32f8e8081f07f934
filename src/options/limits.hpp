// How many entries a list may have: so many that nobody misses one, so few that memory holds what is made of them.
#pragma once

#include <cstddef>
#include <string_view>

#include "traverse/options/table.hpp"

namespace traverse::options {

std::size_t most_entries(std::string_view name, const Row& row);

}  // namespace traverse::options
