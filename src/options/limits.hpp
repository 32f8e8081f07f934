// The greatest permitted number of entries of a list: more than any real scene needs, and few enough for the memory.
#pragma once

#include <cstddef>
#include <string_view>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// The greatest permitted number of entries of an option with this row.
std::size_t most_entries(std::string_view name, const Row& row);

}  // namespace traverse::options
