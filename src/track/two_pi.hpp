// The constant 2 pi, for angles of a full turn and for wavenumbers.
#pragma once

#include <numbers>

namespace traverse::track {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

}  // namespace traverse::track
