// A prescribed function of time with its first two derivatives: a linear function, a table, or the integral of a table.
#pragma once

#include <vector>

namespace traverse::base {

/// value(t) = value + rate*t, or a natural cubic spline through a table. The spline is twice continuously
/// differentiable and continues outside the table as a straight line with the end value and end slope.
class TimeFunction {
 public:
  TimeFunction() = default;
  TimeFunction(double value, double rate) : value_(value), rate_(rate) {}
  /// At least two times, which must increase strictly; otherwise InputError is thrown.
  TimeFunction(std::vector<double> times, std::vector<double> values);
  /// A table of a force, linear between its rows, with the end values outside. The rate jumps at the times of the rows.
  static TimeFunction piecewise_linear(std::vector<double> times, std::vector<double> values);

  /// value plus the integral from time 0 of a rate that is linear between the rows of the table, with the end rates
  /// outside. The acceleration jumps at the times of the rows; select_piece determines the side. Throws as a table
  /// does.
  static TimeFunction integral(double value, std::vector<double> times, std::vector<double> rates);

  /// The second integral of a table of accelerations that is linear between its rows, without value and rate at the
  /// first time; before and after the table there is no acceleration. Throws as a table does.
  static TimeFunction second_integral(std::vector<double> times, std::vector<double> accelerations);

  /// The value at a time t (s), and its first and second derivatives in time.
  double value(double t) const;
  double rate(double t) const;
  double acceleration(double t) const;
  /// Whether the function is value + rate*t at all times.
  bool straight() const { return times_.empty(); }
  /// Times at which the rate jumps; for an integral the times at which the acceleration jumps.
  std::vector<double> kinks() const { return curvatures_.empty() ? times_ : std::vector<double>(); }
  /// Whether the function is an integral, whose acceleration jumps.
  bool jumps() const { return !rates_.empty(); }
  /// For an integral: the piece that contains t applies at all times until the next call, so that the acceleration at
  /// the end of a time step is the acceleration within this step. Returns whether the piece has changed.
  bool select_piece(double t);
  /// Changes the sign of value and rate at all times.
  void reverse();
  /// Adds a constant to the value at all times.
  void shift(double offset);
  /// Moves a table to later times by `time` (s).
  void delay(double time);

 private:
  double value_ = 0.0;
  double rate_ = 0.0;
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> curvatures_;  // second derivatives at the table's times; empty: piecewise linear
  std::vector<double> rates_;       // only for an integral: its rates at the times, where its values are values_
  int piece_ = -1;  // only for an integral: the piece that applies at all times; -1: the piece that contains the time

  struct Piece {
    double from, value, rate, acceleration;
  };
  int piece_at(double t) const;  // index of the piece at t
  Piece piece(double t) const;   // the piece that applies at t
};

}  // namespace traverse::base
