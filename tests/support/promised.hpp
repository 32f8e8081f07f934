// Peaks of a run and their error estimates.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "support/scene_run.hpp"

namespace traverse::test {

inline double peak_of(const Results& run, const std::string& quantity) {
  return std::abs(run.attribute("/summary", quantity == "wheel_force" ? "greatest_wheel_force" : quantity));
}

/// The run's error estimate of a quantity; none if the run has no estimate.
inline std::optional<double> expected(const Results& run, const std::string& quantity) {
  const double error = run.attribute("/summary", "expected_error_" + quantity);
  return std::isnan(error) ? std::nullopt : std::optional(error);
}

}  // namespace traverse::test
