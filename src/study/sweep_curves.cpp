#include "study/sweep_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace traverse::app {
namespace {

/// At each speed the largest of `width` numbers, the first of which is number `from`.
std::vector<double> largest_of(const std::vector<double>& values, std::size_t from, std::size_t speeds,
                               std::size_t width) {
  std::vector<double> largest;
  for (std::size_t i = 0; i < speeds; ++i) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from + i * width);
    largest.push_back(*std::max_element(begin, begin + static_cast<std::ptrdiff_t>(width)));
  }
  return largest;
}

std::string of_train(const results::Sweep& sweep, std::size_t train) {
  return sweep.trains.empty() ? "" : fmt::format(" of A{}", sweep.trains[train]);
}

/// What limit number `l` is on.
SpeedCurve judged_curve(const results::Sweep& sweep, std::size_t train, std::size_t l) {
  const std::size_t speeds = sweep.speed.size(), limits = sweep.judged.limits.size();
  SpeedCurve curve{sweep.judged.limits[l].quantity + of_train(sweep, train), {}};
  for (std::size_t i = 0; i < speeds; ++i) curve.value.push_back(sweep.judged.value[(train * speeds + i) * limits + l]);
  std::replace(curve.name.begin(), curve.name.end(), '_', ' ');
  return curve;
}

}  // namespace

std::vector<double> worst_of_probes(const results::Sweep& sweep, const std::vector<double>& values, std::size_t train) {
  const std::size_t speeds = sweep.speed.size(), probes = sweep.probes.size();
  return largest_of(values, train * speeds * probes, speeds, probes);
}

std::vector<SpeedCurve> curves_of(const results::Sweep& sweep) {
  std::vector<SpeedCurve> curves;
  const std::size_t speeds = sweep.speed.size(), probes = sweep.probes.size(), limits = sweep.judged.limits.size();
  for (std::size_t train = 0; train < sweep.rows(); ++train) {
    const std::size_t first = train * speeds;
    const auto add = [&](const char* name, const std::vector<double>& values, std::size_t width) {
      if (!values.empty())
        curves.push_back({name + of_train(sweep, train), largest_of(values, first * width, speeds, width)});
    };
    if (probes > 0) {
      add("deflection", sweep.deflection.value, probes);
      add("acceleration", sweep.acceleration.value, probes);
      add("moment", sweep.moment.value, probes);
    }
    add("greatest wheel force", sweep.greatest_wheel_force, 1);
    std::set<std::string> known;
    for (std::size_t l = 0; l < limits; ++l) {
      const std::string& quantity = sweep.judged.limits[l].quantity;
      if (quantity != "contact_loss" && known.insert(quantity).second) curves.push_back(judged_curve(sweep, train, l));
    }
  }
  return curves;
}

std::vector<LimitedCurve> curves_in_doubt(const results::Sweep& sweep) {
  std::vector<LimitedCurve> curves;
  const std::size_t limits = sweep.judged.limits.size();
  for (std::size_t l = 0; l < limits; ++l) {
    const options::VerdictLimit& limit = sweep.judged.limits[l];
    double largest = 0.0;
    for (std::size_t i = l; i < sweep.judged.value.size(); i += limits)
      largest = std::fmax(largest, sweep.judged.value[i]);
    if (limit.quantity == "contact_loss" || largest > limit.value) continue;
    for (std::size_t train = 0; train < sweep.rows(); ++train)
      curves.push_back({judged_curve(sweep, train, l), limit.value});
  }
  return curves;
}

}  // namespace traverse::app
