// The load models of EN 1991-2, clause 6.3: static loads that represent rail traffic.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "norm/influence_line.hpp"

namespace traverse::norm {

/// The load model of a row of options::load_models. Characteristic values, without alpha and Phi. InputError for any
/// other name.
LoadModel load_model(std::string_view name);

/// A train of forces (N, downward) at x, m.
LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x);

}  // namespace traverse::norm
