// Evaluates a piecewise linear table along the beam, whose value jumps where a station occurs twice, and checks its
// rows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "traverse/base/error.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

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
