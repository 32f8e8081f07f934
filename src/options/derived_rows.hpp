// Rows of the option table that follow from a table of what there is: of joint types, of kinds of foundation.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// Options vehicle_<name>_<joint>_<row>.
std::span<const Row> joint_rows();
/// Options foundation_<kind>_<row>, with their full names.
std::span<const Row> foundation_rows();

/// Options of a layered track, with their full names.
std::span<const Row> track_rows();

/// Keeps a text for as long as the program runs: rows only look at theirs.
std::string_view kept(std::string text);

}  // namespace traverse::options
