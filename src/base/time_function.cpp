// Tables over time as natural cubic splines, as piecewise linear functions or as integrals of piecewise linear rates,
// with first and second derivatives.
#include "traverse/base/time_function.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "traverse/base/error.hpp"

namespace traverse::base {

namespace {

void check_table(const std::vector<double>& times, const std::vector<double>& values) {
  if (times.size() != values.size()) {
    throw InputError("a table over time needs as many values as times, it has " + std::to_string(times.size()) +
                     " times and " + std::to_string(values.size()) + " values");
  }
  if (times.size() < 2) throw InputError("a table over time needs at least two rows");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !std::isfinite(values[i])) {
      throw InputError("row " + std::to_string(i + 1) + " of a table over time is not a finite number");
    }
    if (i > 0 && !(times[i] > times[i - 1])) {
      throw InputError("the times of a table must increase strictly: row " + std::to_string(i + 1) + " has " +
                       std::to_string(times[i]) + " after " + std::to_string(times[i - 1]));
    }
  }
}

/// Second derivatives of the natural cubic spline: a tridiagonal, diagonally dominant system, eliminated downwards.
std::vector<double> natural_curvatures(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t n = t.size();
  std::vector<double> curvature(n, 0.0);
  std::vector<double> above(n, 0.0);  // the upper diagonal after elimination
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = t[i] - t[i - 1];
    const double right = t[i + 1] - t[i];
    const double slope_change = (y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left;
    const double pivot = 2.0 * (left + right) - left * above[i - 1];
    above[i] = right / pivot;
    curvature[i] = (6.0 * slope_change - left * curvature[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) curvature[i] -= above[i] * curvature[i + 1];
  return curvature;
}

/// The index k of the interval [k, k+1] of `times` that contains t.
std::size_t interval(const std::vector<double>& times, double t) {
  const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, t);
  return static_cast<std::size_t>(next - times.begin()) - 1;
}

}  // namespace

TimeFunction::TimeFunction(std::vector<double> times, std::vector<double> values)
    : times_(std::move(times)), values_(std::move(values)) {
  check_table(times_, values_);
  curvatures_ = natural_curvatures(times_, values_);
}

TimeFunction TimeFunction::piecewise_linear(std::vector<double> times, std::vector<double> values) {
  TimeFunction f(std::move(times), std::move(values));
  f.curvatures_.clear();
  return f;
}

TimeFunction TimeFunction::integral(double value, std::vector<double> times, std::vector<double> rates) {
  TimeFunction f;
  check_table(times, rates);
  f.times_ = std::move(times);
  f.rates_ = std::move(rates);
  f.values_.assign(f.times_.size(), 0.0);
  for (std::size_t i = 1; i < f.times_.size(); ++i)
    f.values_[i] = f.values_[i - 1] + 0.5 * (f.rates_[i - 1] + f.rates_[i]) * (f.times_[i] - f.times_[i - 1]);
  f.shift(value - f.value(0.0));
  return f;
}

// A cubic with the given second derivatives between two rows, from the value and the rate at the first of them.
TimeFunction TimeFunction::second_integral(std::vector<double> times, std::vector<double> accelerations) {
  check_table(times, accelerations);
  std::vector<double> values(times.size(), 0.0);
  double rate = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double h = times[i] - times[i - 1];
    values[i] = values[i - 1] + h * (rate + h * (2.0 * accelerations[i - 1] + accelerations[i]) / 6.0);
    rate += 0.5 * h * (accelerations[i - 1] + accelerations[i]);
  }
  TimeFunction f(std::move(times), std::move(values));
  f.curvatures_ = std::move(accelerations);
  return f;
}

// Piece k of an integral ends at time k; the last piece begins at the last time.
int TimeFunction::piece_at(double t) const {
  return static_cast<int>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin());
}

bool TimeFunction::select_piece(double t) { return std::exchange(piece_, piece_at(t)) != piece_; }

TimeFunction::Piece TimeFunction::piece(double t) const {
  const int number = piece_ < 0 ? piece_at(t) : piece_;
  const std::size_t k = number == 0 ? 0 : static_cast<std::size_t>(number) - 1;
  const bool inside = number > 0 && k + 1 < times_.size();
  const double acceleration = inside ? (rates_[k + 1] - rates_[k]) / (times_[k + 1] - times_[k]) : 0.0;
  return {times_[k], values_[k], rates_[k], acceleration};
}

double TimeFunction::value(double t) const {
  if (times_.empty()) return value_ + rate_ * t;
  if (jumps()) {
    const Piece p = piece(t);
    const double since = t - p.from;
    return p.value + since * (p.rate + 0.5 * p.acceleration * since);
  }
  if (curvatures_.empty()) {
    t = std::clamp(t, times_.front(), times_.back());
    const std::size_t k = interval(times_, t);
    return values_[k] + (values_[k + 1] - values_[k]) * ((t - times_[k]) / (times_[k + 1] - times_[k]));
  }
  if (t < times_.front()) return values_.front() + rate(times_.front()) * (t - times_.front());
  if (t > times_.back()) return values_.back() + rate(times_.back()) * (t - times_.back());
  const std::size_t k = interval(times_, t);
  const double h = times_[k + 1] - times_[k];
  const double a = (times_[k + 1] - t) / h;
  const double b = (t - times_[k]) / h;
  return a * values_[k] + b * values_[k + 1] +
         (a * (a * a - 1.0) * curvatures_[k] + b * (b * b - 1.0) * curvatures_[k + 1]) * h * h / 6.0;
}

double TimeFunction::rate(double t) const {
  if (times_.empty()) return rate_;
  if (jumps()) {
    const Piece p = piece(t);
    return p.rate + p.acceleration * (t - p.from);
  }
  if (curvatures_.empty() && (t < times_.front() || t >= times_.back())) return 0.0;
  t = std::clamp(t, times_.front(), times_.back());
  const std::size_t k = interval(times_, t);
  const double h = times_[k + 1] - times_[k];
  const double a = (times_[k + 1] - t) / h;
  const double b = (t - times_[k]) / h;
  const double chord = (values_[k + 1] - values_[k]) / h;
  if (curvatures_.empty()) return chord;
  return chord + ((1.0 - 3.0 * a * a) * curvatures_[k] + (3.0 * b * b - 1.0) * curvatures_[k + 1]) * h / 6.0;
}

double TimeFunction::acceleration(double t) const {
  if (jumps()) return piece(t).acceleration;
  if (curvatures_.empty() || t <= times_.front() || t >= times_.back()) return 0.0;
  const std::size_t k = interval(times_, t);
  const double b = (t - times_[k]) / (times_[k + 1] - times_[k]);
  return (1.0 - b) * curvatures_[k] + b * curvatures_[k + 1];
}

void TimeFunction::reverse() {
  value_ = -value_;
  rate_ = -rate_;
  for (std::vector<double>* numbers : {&values_, &curvatures_, &rates_})
    for (double& number : *numbers) number = -number;
}

void TimeFunction::delay(double time) {
  for (double& t : times_) t += time;
}

void TimeFunction::shift(double offset) {
  value_ += offset;
  for (double& value : values_) value += offset;
}

}  // namespace traverse::base
