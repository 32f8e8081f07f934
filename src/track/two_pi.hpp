#pragma once

#include <numbers>

namespace traverse::track {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

}  // namespace traverse::track
