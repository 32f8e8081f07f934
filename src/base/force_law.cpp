// Piecewise linear characteristics of springs and dampers with slope, integral and inverse, and the tension of a spring
// with a gap or with one-sided action.
#include "traverse/base/force_law.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/table_rows.hpp"

namespace traverse::base {

namespace {

constexpr double engagement =
    1e-9;  // m or rad: range over which the damper of a spring that can disengage increases from zero
constexpr double rounding_of_zero =
    1e-12;  // relative to a table's largest value: rounding error of an interpolated zero

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string point(double x, double y) { return text(y) + " at " + text(x); }

/// The elongation relative to the end of the loose range; 0 if the spring is loose.
double engaged(const ForceLaw& law, double elongation) {
  if (elongation > law.gap && law.side != Side::compression) return elongation - law.gap;
  if (elongation < -law.gap && law.side != Side::tension) return elongation + law.gap;
  return 0.0;
}

}  // namespace

Polyline::Polyline(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  check_rows(x_, y_, "a table");
  area_ = {0.0};
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double width = x_[i + 1] - x_[i];
    slope_.push_back((y_[i + 1] - y_[i]) / width);
    area_.push_back(area_.back() + 0.5 * (y_[i] + y_[i + 1]) * width);
  }
  origin_ = from_start(0.0);
}

std::size_t Polyline::segment(double x) const {
  return static_cast<std::size_t>(std::upper_bound(x_.begin() + 1, x_.end() - 1, x) - x_.begin()) - 1;
}

Polyline Polyline::reversed() const {
  std::vector<double> x(x_.rbegin(), x_.rend()), y(y_.rbegin(), y_.rend());
  for (std::vector<double>* numbers : {&x, &y})
    for (double& number : *numbers) number = -number;
  return {std::move(x), std::move(y)};
}

double Polyline::value(double x) const {
  const std::size_t k = segment(x);
  return y_[k] + slope_[k] * (x - x_[k]);
}

double Polyline::slope(double x) const { return slope_[segment(x)]; }

double Polyline::from_start(double x) const {
  const std::size_t k = segment(x);
  const double along = x - x_[k];
  return area_[k] + (y_[k] + 0.5 * slope_[k] * along) * along;
}

double Polyline::integral(double x) const { return from_start(x) - origin_; }

std::optional<double> Polyline::inverse(double y) const {
  if (!std::all_of(slope_.begin(), slope_.end(), [](double s) { return s > 0.0; })) return {};
  const auto next = std::upper_bound(y_.begin() + 1, y_.end() - 1, y);
  const auto k = static_cast<std::size_t>(next - y_.begin()) - 1;
  return x_[k] + (y - y_[k]) / slope_[k];
}

std::string Polyline::opposing() const {
  double largest = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (x_[i] * y_[i] < 0.0) return "it has " + point(x_[i], y_[i]);
    largest = std::max(largest, std::abs(y_[i]));
  }
  if (std::abs(value(0.0)) > rounding_of_zero * largest) return "it has " + point(0.0, value(0.0));
  if (slope_.front() < 0.0) return "its first line, continued, falls";
  if (slope_.back() < 0.0) return "its last line, continued, falls";
  return {};
}

std::optional<double> ForceLaw::elongation_at(double tension) const {
  if (tension == 0.0 && can_disengage()) return 0.0;
  const std::optional<double> x = elastic.inverse(tension);
  if (!x || !can_disengage()) return x;
  const double e = *x + std::copysign(gap, *x);
  return engaged(*this, e) != 0.0 ? std::optional(e) : std::nullopt;
}

Tension tension(const ForceLaw& law, double elongation, double rate) {
  const double x = law.can_disengage() ? engaged(law, elongation) : elongation;
  if (law.can_disengage() && x == 0.0) return {};
  const ForceWithSlope spring{law.elastic.value(x), law.elastic.slope(x)},
      damper{law.damper.value(rate), law.damper.slope(rate)};
  if (law.can_disengage()) return one_sided_tension(x, rate, spring, damper);
  return {spring.force + damper.force, spring.slope, damper.slope, damper.force * rate};
}

Tension one_sided_tension(double engaged, double rate, ForceWithSlope spring, ForceWithSlope damper) {
  const double share = std::min(1.0, std::abs(engaged) / engagement), damping = share * damper.force;
  Tension t;
  if (!((spring.force + damping) * engaged > 0.0)) {
    t.dissipation = -spring.force * rate;
    return t;
  }
  t.tension = spring.force + damping;
  t.by_elongation = spring.slope;
  if (share < 1.0) t.by_elongation += (engaged > 0.0 ? damper.force : -damper.force) / engagement;
  t.by_rate = share * damper.slope;
  t.dissipation = damping * rate;
  return t;
}

double stored_energy(const ForceLaw& law, double elongation) {
  return law.elastic.integral(law.can_disengage() ? engaged(law, elongation) : elongation);
}

}  // namespace traverse::base
