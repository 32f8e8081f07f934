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

}  // namespace

std::vector<double> worst_of_probes(const results::Sweep& sweep, const std::vector<double>& values, std::size_t train) {
  const std::size_t speeds = sweep.speed.size(), probes = sweep.probes.size();
  return largest_of(values, train * speeds * probes, speeds, probes);
}

std::vector<SpeedCurve> curves_of(const results::Sweep& sweep) {
  std::vector<SpeedCurve> curves;
  const std::size_t speeds = sweep.speed.size(), probes = sweep.probes.size(), limits = sweep.judged.limits.size();
  for (std::size_t train = 0; train < sweep.rows(); ++train) {
    const std::string of_train = sweep.trains.empty() ? "" : fmt::format(" of A{}", sweep.trains[train]);
    const std::size_t first = train * speeds;
    const auto add = [&](const char* name, const std::vector<double>& values, std::size_t width) {
      if (!values.empty()) curves.push_back({name + of_train, largest_of(values, first * width, speeds, width)});
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
      if (quantity == "contact_loss" || !known.insert(quantity).second) continue;
      SpeedCurve curve{quantity + of_train, {}};
      for (std::size_t i = 0; i < speeds; ++i) curve.value.push_back(sweep.judged.value[(first + i) * limits + l]);
      std::replace(curve.name.begin(), curve.name.end(), '_', ' ');
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace traverse::app
