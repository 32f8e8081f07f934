// A quantity along the beam.
#pragma once

#include <string>
#include <vector>

namespace traverse::beam {

/// A quantity along x: one value, or a piecewise linear table in which a repeated x is a step.
/// Outside the table the end value holds.
class Distribution {
 public:
  Distribution(double value = 0.0) : values_{value} {}  // NOLINT: a number is a distribution
  /// x not decreasing, at most two equal in a row; throws InputError naming `name` otherwise.
  Distribution(std::vector<double> x, std::vector<double> values, const std::string& name);

  /// Value at x seen from inside the interval that lies towards `inside` (matters at a step only).
  double at(double x, double inside) const;
  bool uniform() const { return x_.empty(); }
  double minimum() const;
  double maximum() const;
  /// The same quantity with `value` more everywhere.
  Distribution plus(double value) const;
  /// The same quantity `factor` times as large from `from` to `to`, with a step at either.
  Distribution with_factor(double from, double to, double factor) const;
  /// Stations of the table strictly inside (a, b), without repetition: where an integration has to be split.
  std::vector<double> breaks(double a, double b) const;
  /// Stations strictly inside (a, b) at which the value steps.
  std::vector<double> steps(double a, double b) const;

 private:
  std::vector<double> x_;
  std::vector<double> values_;
};

}  // namespace traverse::beam
