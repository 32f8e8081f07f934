// A quantity that varies along the beam.
#pragma once

#include <string>
#include <vector>

namespace traverse::beam {

/// A quantity over x: a constant, or a piecewise linear table. The quantity jumps at an x that occurs twice. Outside
/// the table the end value applies.
class Distribution {
 public:
  Distribution(double value = 0.0) : values_{value} {}  // NOLINT: a number is a distribution
  /// x must not decrease, and at most two successive values may be equal; otherwise an InputError that names `name` is
  /// thrown.
  Distribution(std::vector<double> x, std::vector<double> values, const std::string& name);

  /// The value at x; at a jump the value on the side of `inside`.
  double at(double x, double inside) const;
  bool uniform() const { return x_.empty(); }
  double minimum() const;
  double maximum() const;
  /// This distribution increased by `value` everywhere.
  Distribution plus(double value) const;
  /// This distribution multiplied by `factor` between `from` and `to`, with a jump at both ends.
  Distribution with_factor(double from, double to, double factor) const;
  /// Stations of the table strictly inside (a, b), each once, at which an integration must be divided.
  std::vector<double> breaks(double a, double b) const;
  /// Stations strictly inside (a, b) at which the value jumps.
  std::vector<double> steps(double a, double b) const;

 private:
  std::vector<double> x_;
  std::vector<double> values_;
};

}  // namespace traverse::beam
