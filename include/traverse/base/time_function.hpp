// A prescribed quantity over time with its first two derivatives: a polynomial of degree one or a table.
#pragma once

#include <vector>

namespace traverse::base {

/// value(t) = value + rate*t, or a natural cubic spline through a table (twice continuously differentiable;
/// outside the table it goes on with its end value and end slope's straight line).
class TimeFunction {
 public:
  TimeFunction() = default;
  TimeFunction(double value, double rate) : value_(value), rate_(rate) {}
  /// Times strictly increasing, at least two; throws InputError otherwise.
  TimeFunction(std::vector<double> times, std::vector<double> values);
  /// A force's table: straight lines between its rows, the end values outside; its rate jumps at its times.
  static TimeFunction piecewise_linear(std::vector<double> times, std::vector<double> values);

  double value(double t) const;
  double rate(double t) const;
  double acceleration(double t) const;
  /// Whether it is value + rate*t at all times.
  bool straight() const { return times_.empty(); }
  /// Times at which the rate jumps.
  std::vector<double> kinks() const { return curvatures_.empty() ? times_ : std::vector<double>(); }
  /// Adds a constant to the value at all times.
  void shift(double offset);

 private:
  double value_ = 0.0;
  double rate_ = 0.0;
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> curvatures_;  // second derivatives at the table's times; empty: straight lines
};

}  // namespace traverse::base
