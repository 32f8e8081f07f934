// Tables over time as cubic splines, as piecewise linear functions or as integrals of piecewise linear functions: each
// is a polynomial between two rows, with another one before the first and after the last row.
#include "traverse/base/time_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>

#include "base/spline.hpp"
#include "base/table_rows.hpp"
#include "traverse/base/error.hpp"

namespace traverse::base {

namespace {

constexpr double rounding = 1e-12;     // relative to the terms of a rate
constexpr double least_rate = 0.01;    // of a moving end, relative to the greatest rate
constexpr double max_overshoot = 0.3;  // of a spline beyond two rows, relative to the range of all rows

}  // namespace

// A table without pieces: its times, all of which are kinks.
TimeFunction TimeFunction::table(std::vector<double> times) {
  TimeFunction f;
  f.kinks_ = times;
  f.times_ = std::move(times);
  f.last_ = f.times_.size();
  f.pieces_.reserve(f.times_.size() + 1);
  return f;
}

TimeFunction::TimeFunction(std::vector<double> times, std::vector<double> values) {
  check_rows(times, values, "a table over time");
  *this = table(std::move(times));
  const std::size_t last = times_.size() - 1;
  set_spline(values, {});
  const double first_rate = pieces_[1].rate, last_rate = pieces_[last].rate_at(times_[last]);
  double greatest = std::max(std::abs(first_rate), std::abs(last_rate));
  for (const Piece& piece : pieces_) greatest = std::max(greatest, std::abs(piece.rate));
  std::array<std::optional<double>, 2> rates;
  if (values[0] == values[1] || std::abs(first_rate) < least_rate * greatest) rates[0] = 0.0;
  if (values[last - 1] == values[last] || std::abs(last_rate) < least_rate * greatest) rates[1] = 0.0;
  if (rates[0] || rates[1]) set_spline(values, rates);
  find_kinks_at_ends();
  check_overshoot();
}

// Sets the pieces of the spline, which has no curvature at an end without a rate.
void TimeFunction::set_spline(const std::vector<double>& values,
                              const std::array<std::optional<double>, 2>& end_rates) {
  const std::vector<double> curvatures = spline_curvatures(times_, values, end_rates);
  pieces_.assign(1, {times_.front(), values.front()});
  for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
    const double h = times_[k + 1] - times_[k];
    pieces_.push_back({times_[k], values[k],
                       (values[k + 1] - values[k]) / h - h * (2.0 * curvatures[k] + curvatures[k + 1]) / 6.0,
                       curvatures[k], (curvatures[k + 1] - curvatures[k]) / h});
  }
  pieces_.push_back({times_.back(), values.back()});
  if (end_rates[0]) pieces_[1].rate = *end_rates[0];
}

// Each piece is a cubic between two rows, whose extremes are at the roots of its rate.
void TimeFunction::check_overshoot() const {
  const auto [low, high] = std::minmax_element(pieces_.begin(), pieces_.end(),
                                               [](const Piece& a, const Piece& b) { return a.value < b.value; });
  for (std::size_t k = 1; k < times_.size(); ++k) {
    const Piece& p = pieces_[k];
    const auto [from, to] = std::minmax(p.value, pieces_[k + 1].value);
    const double root = std::sqrt(std::max(p.acceleration * p.acceleration - 2.0 * p.rate * p.jerk, 0.0));
    const double q = -(p.acceleration + std::copysign(root, p.acceleration));
    for (const double s : {q / p.jerk, 2.0 * p.rate / q}) {
      if (!(s > 0.0 && s < times_[k] - p.from)) continue;
      const double extreme = p.value_at(p.from + s);
      if (!(std::max(from - extreme, extreme - to) > max_overshoot * (high->value - low->value))) continue;
      std::ostringstream text;
      text.precision(4);
      text << "the cubic spline between the rows " << k << " and " << k + 1 << " reaches " << extreme << " at "
           << p.from + s << " s, far beyond the rows, which are between " << low->value << " and " << high->value
           << "; allowed: rows at more even times, or more of them";
      throw InputError(text.str());
    }
  }
}

TimeFunction TimeFunction::piecewise_linear(std::vector<double> times, std::vector<double> values) {
  check_rows(times, values, "a table over time");
  TimeFunction f = table(std::move(times));
  f.pieces_.push_back({f.times_.front(), values.front()});
  for (std::size_t k = 0; k + 1 < f.times_.size(); ++k)
    f.pieces_.push_back({f.times_[k], values[k], (values[k + 1] - values[k]) / (f.times_[k + 1] - f.times_[k])});
  f.pieces_.push_back({f.times_.back(), values.back()});
  return f;
}

TimeFunction TimeFunction::integral(double value, std::vector<double> times, std::vector<double> rates) {
  check_rows(times, rates, "a table over time");
  TimeFunction f = table(std::move(times));
  f.pieces_.push_back({f.times_.front(), 0.0, rates.front()});
  for (std::size_t k = 0; k + 1 < f.times_.size(); ++k) {
    const double acceleration = (rates[k + 1] - rates[k]) / (f.times_[k + 1] - f.times_[k]);
    f.pieces_.push_back({f.times_[k], f.pieces_.back().value_at(f.times_[k]), rates[k], acceleration});
  }
  f.pieces_.push_back({f.times_.back(), f.pieces_.back().value_at(f.times_.back()), rates.back()});
  f.shift(value - f.value(0.0));
  return f;
}

TimeFunction TimeFunction::second_integral(std::vector<double> times, std::vector<double> accelerations) {
  check_rows(times, accelerations, "a table over time");
  TimeFunction f = table(std::move(times));
  f.pieces_.push_back({f.times_.front()});
  for (std::size_t k = 0; k + 1 < f.times_.size(); ++k) {
    const Piece& before = f.pieces_.back();
    const double t = f.times_[k], jerk = (accelerations[k + 1] - accelerations[k]) / (f.times_[k + 1] - t);
    f.pieces_.push_back({t, before.value_at(t), before.rate_at(t), accelerations[k], jerk});
  }
  const double end = f.times_.back();
  f.pieces_.push_back({end, f.pieces_.back().value_at(end), f.pieces_.back().rate_at(end)});
  f.find_kinks_at_ends();
  return f;
}

// Piece k ends at row k; the last piece begins at the last row.
std::size_t TimeFunction::piece_at(double t) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin());
}

double TimeFunction::jump_of_rate(std::size_t row) const {
  const Piece& before = pieces_[row];
  const double duration = times_[row] - before.from, jump = pieces_[row + 1].rate - before.rate_at(times_[row]);
  const double terms =
      std::abs(before.rate) + duration * (std::abs(before.acceleration) + duration * std::abs(before.jerk));
  return std::abs(jump) > rounding * terms ? jump : 0.0;
}

bool TimeFunction::jumps_at(std::size_t row) const {
  return jump_of_rate(row) != 0.0 || pieces_[row + 1].acceleration != pieces_[row].acceleration_at(times_[row]);
}

// For functions that are smooth between their ends.
void TimeFunction::find_kinks_at_ends() {
  kinks_.clear();
  for (const std::size_t end : {std::size_t{0}, times_.size() - 1})
    if (jumps_at(end)) kinks_.push_back(times_[end]);
}

bool TimeFunction::select_side(double t) {
  if (kinks_.empty()) return false;
  const auto next = std::upper_bound(kinks_.begin(), kinks_.end(), t);
  const std::size_t before = std::exchange(first_, next == kinks_.begin() ? 0 : piece_at(*(next - 1)));
  last_ = next == kinks_.end() ? times_.size() : piece_at(*next) - 1;
  return first_ != before;
}

void TimeFunction::reverse() {
  value_ = -value_;
  rate_ = -rate_;
  for (Piece& p : pieces_)
    for (double* number : {&p.value, &p.rate, &p.acceleration, &p.jerk}) *number = -*number;
}

void TimeFunction::delay(double time) {
  for (std::vector<double>* times : {&times_, &kinks_})
    for (double& t : *times) t += time;
  for (Piece& p : pieces_) p.from += time;
}

void TimeFunction::shift(double offset) {
  value_ += offset;
  for (Piece& p : pieces_) p.value += offset;
}

}  // namespace traverse::base
