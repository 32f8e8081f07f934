// Values of a few consecutive nodes, one array for each unknown of a column, for products with many nodes at a time.
#pragma once

#include <array>

#include "beam/line.hpp"

namespace traverse::beam {

/// The arrays, indexed by the unknown's place in a column.
using Planes = std::array<double*, kinds>;

/// Largest number of nodes of one call with planes.
inline constexpr int tile = 128;

/// Number of nodes per step of a product. As many values behind those of a call may be read; their values are
/// arbitrary.
inline constexpr int nodes_per_step = 32;

}  // namespace traverse::beam
