// The load models of EN 1991-2, clause 6.3: static loads that represent rail traffic.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "norm/influence_line.hpp"

namespace traverse::norm {

/// The load model with the user's name lm71, sw0 or sw2. Characteristic values, without alpha and Phi.
LoadModel load_model(std::string_view name);
/// Whether the classification factor alpha applies to the load model: 6.3.2 (3).
bool classified(std::string_view name);

/// A train of forces (N, downward) at x, m.
LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x);

}  // namespace traverse::norm
