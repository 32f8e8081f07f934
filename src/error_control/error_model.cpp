// Richardson extrapolation: order and size of a discretisation error from the changes by two successive halvings of
// step or element length.
#include "error_control/error_model.hpp"

#include <algorithm>
#include <cmath>

#include "error_control/search_constants.hpp"

namespace traverse::error_control {
namespace {

constexpr double max_ratio = 1e3;

}  // namespace

double ErrorModel::power() const { return std::clamp(order, 1.0, search::full_order); }

double ErrorModel::power_refining() const { return std::min(power(), search::refining_order); }

double ErrorModel::allowed_ratio(double wanted) const {
  if (value <= 0.0) return max_ratio;
  const double ratio = wanted / value;
  return std::pow(ratio, 1.0 / (ratio < 1.0 ? power_refining() : power()));
}

double ErrorModel::at(double ratio) const { return value * std::pow(ratio, ratio < 1.0 ? power_refining() : power()); }

ErrorModel error_from(double change, double size, const ErrorModel& before, double max_order) {
  ErrorModel error{change, before.order, before.known, before.known, change, size};
  if (before.size > 1.5 * size) {
    const double halvings = std::log2(before.size / size);
    error.known = true;
    error.order = change > 0.0 ? std::log2(before.change / change) / halvings : search::full_order;
    if (before.known && before.order < search::least_order) error.order = std::min(error.order, 1.0);
    change = std::max(change, before.change / std::exp2((search::refining_order + 1.0) * halvings));
  }
  error.order = std::min(error.order, max_order);
  error.value = change / (std::exp2(error.power_refining()) - 1.0);
  return error;
}

}  // namespace traverse::error_control
