// Peaks of sampled curves, and the combination of a run's options.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "support/scene_run.hpp"

namespace traverse::test {

/// A peak between samples: the parabola through the sample of largest magnitude and its neighbours.
struct Peak {
  double value, time;
};
inline Peak refined_peak(const std::vector<double>& time, const std::vector<double>& values) {
  const auto [largest, i] = peak(values);
  if (i == 0 || i + 1 >= values.size()) return {largest, time[i]};
  const double before = time[i] - time[i - 1], after = time[i + 1] - time[i];
  if (std::abs(after - before) > 1e-6 * before) return {largest, time[i]};  // the last interval may be cut
  const double slope = 0.5 * (values[i + 1] - values[i - 1]);
  const double bend = values[i + 1] - 2.0 * largest + values[i - 1];
  if (bend == 0.0) return {largest, time[i]};
  return {largest - 0.5 * slope * slope / bend, time[i] - slope / bend * before};
}

/// Every `step`-th value.
inline std::vector<double> every(int step, const std::vector<double>& values) {
  std::vector<double> out;
  for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(step)) out.push_back(values[i]);
  return out;
}

/// Column c of a table's rows.
inline std::vector<double> column(const std::vector<std::vector<double>>& rows, std::size_t c) {
  std::vector<double> out;
  for (const auto& row : rows) out.push_back(row.at(c));
  return out;
}

/// A number as an option's value, to the last bit.
inline std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

inline Values operator+(Values a, const Values& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace traverse::test
