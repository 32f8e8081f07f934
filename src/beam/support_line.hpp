// The line through the supports of a bridge: straight between neighbouring supports, which may have settled or move.
// Deflections are judged relative to it, because a motion of the supports that bends no span deflects none.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "traverse/beam/model.hpp"

namespace traverse::beam {

/// The height of the line at a station as a linear combination of the displacements of two span ends.
struct SupportLine {
  std::array<std::size_t, 2> end{};  // span ends
  std::array<double, 2> share{};     // both 0 if nothing supports the bridge vertically

  /// The height, m. displacements: upward displacement of the ground at each span end, m; empty: none.
  double height(std::span<const double> displacements) const {
    return displacements.empty() ? 0.0 : share[0] * displacements[end[0]] + share[1] * displacements[end[1]];
  }
};

/// The line at a station x, m. The supports are those that hold the deflection, and the vertical springs at span ends.
/// Beyond the outermost supports the line goes on as a rigid overhang does: straight on, but level behind a support
/// that holds the rotation and beside a single support.
SupportLine support_line(const BeamModel& model, double x);

}  // namespace traverse::beam
