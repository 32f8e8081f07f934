// Properties of a foundation, the force and energy of its nonlinear law and of an elastic-perfectly plastic spring, and
// piecewise linear tables along the beam, whose value jumps where a station occurs twice.
#include "traverse/beam/foundation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "traverse/base/error.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr double engagement = 1e-9;  // m or rad, over which the damper force increases from zero

void check_table(const std::vector<double>& x, const std::vector<double>& values, const std::string& name) {
  if (x.empty() || x.size() != values.size()) {
    throw InputError(name + ": the table has " + std::to_string(x.size()) + " stations and " +
                     std::to_string(values.size()) + " values; as many of both are needed, at least one");
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::string row = name + ": row " + std::to_string(i + 1) + " of the table ";
    if (!std::isfinite(x[i]) || !std::isfinite(values[i])) throw InputError(row + "holds a number that is not finite");
    if (i > 0 && x[i] < x[i - 1]) {
      throw InputError(row + "has x = " + std::to_string(x[i]) + " after " + std::to_string(x[i - 1]) +
                       "; x must not decrease");
    }
    if (i > 1 && x[i] == x[i - 2]) {
      throw InputError(row + "has x = " + std::to_string(x[i]) + " for the third time; twice makes a step");
    }
  }
}

}  // namespace

bool Foundation::nonlinear() const {
  bool found = false;
  for_points(*this, [&](const FoundationKind&, const std::vector<PointFoundation>& points) {
    for (const PointFoundation& p : points) found = found || p.law.nonlinear();
  });
  for_beds(*this, [&](const FoundationKind&, const Bed& bed) { found = found || bed.law.nonlinear(); });
  return found;
}

std::size_t foundation_kind(std::string_view name) {
  const auto same = [&](const FoundationKind& kind) { return kind.name == name; };
  const auto kind = std::find_if(foundation_kinds.begin(), foundation_kinds.end(), same);
  if (kind == foundation_kinds.end()) throw InputError("there is no foundation_" + std::string(name));
  return static_cast<std::size_t>(kind - foundation_kinds.begin());
}

double bending_decay_rate(Direction direction, double k, double EI) {
  if (direction == Direction::vertical) return std::pow(k / (4.0 * EI), 0.25);
  return direction == Direction::rotational ? std::sqrt(std::abs(k) / EI) : 0.0;
}

bool present(const Foundation& foundation, const FoundationKind& kind) {
  return kind.points != nullptr ? !(foundation.*kind.points).empty() : (foundation.*kind.bed).has_value();
}

bool present(const Foundation& foundation, Direction direction) {
  return std::any_of(foundation_kinds.begin(), foundation_kinds.end(), [&](const FoundationKind& kind) {
    return kind.direction == direction && present(foundation, kind);
  });
}

FoundationForce foundation_force(const FoundationLaw& law, double k, double c, double d, double w) {
  const bool can_separate = law.one_sided || law.gap > 0.0;
  const double s = std::abs(d) - law.gap;
  if (can_separate && (!(s > 0.0) || (law.one_sided && d > 0.0))) return {};
  const double side = d > 0.0 ? 1.0 : -1.0, rate = side * w;
  const double share = can_separate ? std::min(1.0, s / engagement) : 1.0;
  const double spring = k * s + law.cubic * s * s * s, damper = share * c * rate;
  FoundationForce f;
  f.energy = (0.5 * k + 0.25 * law.cubic * s * s) * s * s;
  if (can_separate && !(spring + damper > 0.0)) {
    f.dissipation = -spring * rate;
    return f;
  }
  f.force = -side * (spring + damper);
  f.by_displacement = k + 3.0 * law.cubic * s * s + (share < 1.0 ? c * rate / engagement : 0.0);
  f.by_rate = share * c;
  f.dissipation = damper * rate;
  return f;
}

FoundationForce sliding_force(double k, double limit, double previous, double d) {
  const double trial = std::clamp(previous, -limit, limit) - k * d;
  FoundationForce f;
  f.force = std::clamp(trial, -limit, limit);
  f.by_displacement = f.force == trial ? k : 0.0;
  f.energy = 0.5 * f.force * f.force / k;
  return f;
}

Distribution::Distribution(std::vector<double> x, std::vector<double> values, const std::string& name)
    : x_(std::move(x)), values_(std::move(values)) {
  check_table(x_, values_, name);
}

double Distribution::at(double x, double inside) const {
  if (x_.empty()) return values_.front();
  // The interval (right - 1, right) of the table that contains x; at a station the one on the side of
  // `inside`, an x inside the element.
  const auto it = inside < x ? std::lower_bound(x_.begin(), x_.end(), x) : std::upper_bound(x_.begin(), x_.end(), x);
  if (it == x_.begin()) return values_.front();
  if (it == x_.end()) return values_.back();
  const auto right = static_cast<std::size_t>(it - x_.begin()), left = right - 1;
  const double width = x_[right] - x_[left];
  return values_[left] + (values_[right] - values_[left]) * ((x - x_[left]) / width);
}

double Distribution::minimum() const { return *std::min_element(values_.begin(), values_.end()); }
double Distribution::maximum() const { return *std::max_element(values_.begin(), values_.end()); }

Distribution Distribution::plus(double value) const {
  Distribution sum = *this;
  for (double& v : sum.values_) v += value;
  return sum;
}

Distribution Distribution::with_factor(double from, double to, double factor) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> stations = breaks(-infinity, infinity);
  stations.insert(stations.end(), {from, to});
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  std::vector<double> x, values;
  for (const double s : stations) {
    const double left = at(s, -infinity) * (s > from && s <= to ? factor : 1.0);
    const double right = at(s, infinity) * (s >= from && s < to ? factor : 1.0);
    x.push_back(s);
    values.push_back(left);
    if (left == right) continue;
    x.push_back(s);
    values.push_back(right);
  }
  return {std::move(x), std::move(values), "a stretch of another stiffness"};
}

std::vector<double> Distribution::breaks(double a, double b) const {
  std::vector<double> inside;
  for (auto it = std::upper_bound(x_.begin(), x_.end(), a); it != x_.end() && *it < b; ++it) {
    if (inside.empty() || inside.back() != *it) inside.push_back(*it);
  }
  return inside;
}

std::vector<double> Distribution::steps(double a, double b) const {
  std::vector<double> inside;
  for (std::size_t i = 1; i < x_.size(); ++i)
    if (x_[i] == x_[i - 1] && x_[i] > a && x_[i] < b && values_[i] != values_[i - 1]) inside.push_back(x_[i]);
  return inside;
}

}  // namespace traverse::beam
