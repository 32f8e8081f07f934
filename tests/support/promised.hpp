// Peaks of a run and what it promises of them.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "support/scene_run.hpp"

namespace traverse::test {

inline double peak_of(const Results& run, const std::string& quantity) {
  return std::abs(run.attribute("/summary", quantity == "wheel_force" ? "greatest_wheel_force" : quantity));
}

/// What the run says it expects; none where it does not promise the quantity.
inline std::optional<double> expected(const Results& run, const std::string& quantity) {
  const double error = run.attribute("/summary", "expected_error_" + quantity);
  return std::isnan(error) ? std::nullopt : std::optional(error);
}

}  // namespace traverse::test
