// Values of a few consecutive nodes, one array for each unknown of a column, for products with many nodes at a time.
#pragma once

#include <array>

#include "beam/line.hpp"

namespace traverse::beam {

/// The arrays, by the unknown's index in a column.
using Planes = std::array<double*, kinds>;

/// Largest number of nodes of one call with planes.
inline constexpr int tile = 128;

/// Number of nodes that a product processes at a time. A call may read as many values behind its own ones; they are
/// arbitrary.
inline constexpr int nodes_per_chunk = 32;

}  // namespace traverse::beam
