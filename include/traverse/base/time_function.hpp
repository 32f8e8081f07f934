// A prescribed function of time with its first two derivatives: a linear function, a table, or the integral of a table.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace traverse::base {

/// value(t) = value + rate*t, or a table over time. Before its first and after its last row a table holds the value of
/// that row. Between its rows it is a cubic polynomial, and between the rows of a force or a speed a straight line.
class TimeFunction {
 public:
  TimeFunction() = default;
  TimeFunction(double value, double rate) : value_(value), rate_(rate) {}
  /// A twice continuously differentiable cubic spline through at least two rows, whose times increase strictly. It has
  /// no curvature at its ends. Where the first or the last two values are equal, or where the rate would be below a
  /// hundredth of the greatest one, it has no rate instead. Throws InputError for other rows, and if the spline leaves
  /// two rows by more than three tenths of the range of all values.
  TimeFunction(std::vector<double> times, std::vector<double> values);
  /// A table of a force, linear between its rows. The rate jumps at the times of the rows.
  static TimeFunction piecewise_linear(std::vector<double> times, std::vector<double> values);

  /// value plus the integral from time 0 of a table of rates that is linear between its rows. The acceleration jumps at
  /// the times of the rows. Throws as a table does.
  static TimeFunction integral(double value, std::vector<double> times, std::vector<double> rates);

  /// The second integral of a table of accelerations that is linear between its rows, without value and rate at the
  /// first time; before and after the table there is no acceleration. Throws as a table does.
  static TimeFunction second_integral(std::vector<double> times, std::vector<double> accelerations);

  /// The value at a time t (s), and its first and second derivatives in time; at a jump those after it, unless
  /// select_side has determined the side.
  double value(double t) const { return straight() ? value_ + rate_ * t : piece(t).value_at(t); }
  double rate(double t) const { return straight() ? rate_ : piece(t).rate_at(t); }
  double acceleration(double t) const { return straight() ? 0.0 : piece(t).acceleration_at(t); }
  /// Whether the function is value + rate*t at all times.
  bool straight() const { return times_.empty(); }
  /// The times of the rows.
  const std::vector<double>& rows() const { return times_; }
  /// Times at which rate or acceleration may jump: the rows, of a cubic function those of its ends at which they do.
  const std::vector<double>& kinks() const { return kinks_; }
  /// The pieces between the two kinks around t apply at all times until the next call, so that rate and acceleration at
  /// the end of a time step are those within this step. Returns whether these pieces have changed.
  bool select_side(double t);
  /// The change of the rate at a row, counted from 0.
  double jump_of_rate(std::size_t row) const;
  /// Changes the sign of value and rate at all times.
  void reverse();
  /// Adds a constant to the value at all times.
  void shift(double offset);
  /// Moves a table to later times by `time` (s).
  void delay(double time);

 private:
  /// value + rate s + acceleration s^2/2 + jerk s^3/6, with the time s since `from`.
  struct Piece {
    double from = 0.0, value = 0.0, rate = 0.0, acceleration = 0.0, jerk = 0.0;
    double value_at(double t) const {
      const double s = t - from;
      return value + s * (rate + s * (0.5 * acceleration + s * jerk / 6.0));
    }
    double rate_at(double t) const { return rate + (t - from) * (acceleration + 0.5 * (t - from) * jerk); }
    double acceleration_at(double t) const { return acceleration + (t - from) * jerk; }
  };
  std::size_t piece_at(double t) const;  // index of the piece at t
  const Piece& piece(double t) const { return pieces_[std::clamp(piece_at(t), first_, last_)]; }
  bool jumps_at(std::size_t row) const;  // whether rate or acceleration jumps
  static TimeFunction table(std::vector<double> times);
  void set_spline(const std::vector<double>& values, const std::array<std::optional<double>, 2>& end_rates);
  void find_kinks_at_ends();
  void check_overshoot() const;

  double value_ = 0.0;
  double rate_ = 0.0;
  std::vector<double> times_, kinks_;
  std::vector<Piece> pieces_;         // before the first row, between the rows, after the last one
  std::size_t first_ = 0, last_ = 0;  // the pieces that apply
};

}  // namespace traverse::base
