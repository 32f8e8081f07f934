// Rows of the option table that are derived from the tables of joint types, kinds of foundation and track properties.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// The options vehicle_<name>_<joint>_<row>.
std::span<const Row> joint_rows();
/// The options foundation_<kind>_<row>, with their full names.
std::span<const Row> foundation_rows();

/// The options of a layered track, with their full names.
std::span<const Row> track_rows();

/// Stores a text until the program ends, because rows have only views of their texts.
std::string_view permanent(std::string text);

}  // namespace traverse::options
