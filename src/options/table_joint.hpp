// Rows of the option table that follow from the table of joint types.
#pragma once

#include <span>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// Options vehicle_<name>_<joint>_<row>.
std::span<const Row> joint_rows();

}  // namespace traverse::options
