// A prescribed quantity over time with its first two derivatives: a polynomial of degree one, a table, or the integral
// of one.
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

  /// value plus the integral of a rate from time 0 on: straight lines between the table's rows, the end rates outside.
  /// Its acceleration jumps at the times, where that of either side is meant: see take_piece. Throws as a table does.
  static TimeFunction integral(double value, std::vector<double> times, std::vector<double> rates);

  /// The value at a time t (s), and its first and second derivatives in time.
  double value(double t) const;
  double rate(double t) const;
  double acceleration(double t) const;
  /// Whether it is value + rate*t at all times.
  bool straight() const { return times_.empty(); }
  /// Times at which the rate jumps, or of an integral its acceleration.
  std::vector<double> kinks() const { return curvatures_.empty() ? times_ : std::vector<double>(); }
  /// Of an integral: whether its acceleration jumps at times.
  bool jumps() const { return !rates_.empty(); }
  /// Of an integral: goes on by the piece that holds t, at all times, until another one is taken: the acceleration at
  /// the end of a step is then that of the step. True when it is another piece than before.
  bool take_piece(double t);
  /// Gives value and rate the other sign at all times.
  void reverse();
  /// Adds a constant to the value at all times.
  void shift(double offset);

 private:
  double value_ = 0.0;
  double rate_ = 0.0;
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> curvatures_;  // second derivatives at the table's times; empty: straight lines
  std::vector<double> rates_;       // of an integral, whose values at the times are values_; else empty
  int piece_ = -1;                  // of an integral: the one that holds at all times; below 0: that of the time

  struct Piece {
    double from, value, rate, acceleration;
  };
  int piece_at(double t) const;  // its number
  Piece piece(double t) const;   // and what holds there
};

}  // namespace traverse::base
