// Numbers of a few consecutive nodes, an array for each unknown of a column, for products with many nodes at a time.
#pragma once

#include <array>

#include "beam/line.hpp"

namespace traverse::beam {

/// The arrays, by the unknown's place in a column.
using Planes = std::array<double*, kinds>;

/// Most nodes of one call with planes.
inline constexpr int tile = 128;

/// Nodes that products take at a time; as many numbers behind those of a call may be read, whatever they are.
inline constexpr int abreast = 32;

}  // namespace traverse::beam
