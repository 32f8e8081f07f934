#include "error_law.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::app {
namespace {

constexpr double refining_order = 3.0;
constexpr double unsettled = 0.5, supposed_order = 1.0;  // after the one, not more than the other is believed
constexpr double no_limit = 1e3;

}  // namespace

double ErrorLaw::power() const { return std::clamp(order, 1.0, full_order); }

double ErrorLaw::power_refining() const { return std::min(power(), refining_order); }

double ErrorLaw::room(double wanted) const {
  if (value <= 0.0) return no_limit;
  const double times = wanted / value;
  return std::pow(times, 1.0 / (times < 1.0 ? power_refining() : power()));
}

double ErrorLaw::at(double times) const { return value * std::pow(times, times < 1.0 ? power_refining() : power()); }

ErrorLaw error_from(double change, double size, const ErrorLaw& before, double most) {
  ErrorLaw error{change, before.order, before.known, before.known, change, size};
  if (before.size > 1.5 * size) {
    const double halvings = std::log2(before.size / size);
    error.known = true;
    error.order = change > 0.0 ? std::log2(before.change / change) / halvings : full_order;
    if (before.known && before.order < unsettled) error.order = std::min(error.order, supposed_order);
    change = std::max(change, before.change / std::exp2((refining_order + 1.0) * halvings));
  }
  error.order = std::min(error.order, most);
  error.value = change / (std::exp2(error.power_refining()) - 1.0);
  return error;
}

}  // namespace traverse::app
