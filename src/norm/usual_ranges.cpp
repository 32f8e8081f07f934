// Sentences on numbers that are usual in another unit.
#include "norm/usual_ranges.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "norm/en1991.hpp"

namespace traverse::norm {
namespace {

constexpr double unit_ratio = 31.6227766;  // ratio of frequencies for a factor of 1000 in EI or mass
constexpr double bounds_margin = 2.0;      // factor of the bounds
constexpr double high_damping = 0.1;
constexpr double fastest_train = 160.0;  // m/s: the record of a train on rails is 574.8 km/h

bool between(double value, const std::pair<double, double>& bounds, double slack) {
  return value >= bounds.first / slack && value <= bounds.second * slack;
}

}  // namespace

std::string unusual_frequency(double n0, double length, const char* EI, const char* mass) {
  const auto bounds = frequency_bounds(length);
  if (!(n0 > 0.0) || !bounds || between(n0, *bounds, 1.0)) return "";
  std::string line = fmt::format(
      "the first frequency, {:.3g} Hz, is {} the range of railway bridges of {:.3g} m: {:.3g} to {:.3g} Hz "
      "(EN 1991-2, figure 6.10)",
      n0, n0 < bounds->first ? "below" : "above", length, bounds->first, bounds->second);
  if (between(n0, *bounds, bounds_margin)) return line;
  if (between(n0 * unit_ratio, *bounds, bounds_margin))
    line += fmt::format("; {} is possibly given in kN m2; its unit is N m2", EI);
  else if (between(n0 / unit_ratio, *bounds, bounds_margin))
    line += fmt::format("; {} is possibly given in t/m; its unit is kg/m", mass);
  return line;
}

std::string unusual_bridge_mass(double value, double span, const char* mass) {
  if (span < min_bridge_span || value >= lightest_bridge) return "";
  return fmt::format("{}: {:g} kg/m is small for spans of {:g} m; it is possibly given in t/m", mass, value, span);
}

std::string unusual_damping(double ratio) {
  if (!(ratio > high_damping)) return "";
  return fmt::format("a damping ratio of {:.3g} is {:.3g} % of critical damping, bridges have 0.5 to 3 %", ratio,
                     100.0 * ratio);
}

std::string unusual_speed(const std::string& what, double speed) {
  if (!(speed > fast_speed)) return "";
  return fmt::format("{}: {:g} m/s is {:g} km/h, faster than any train {}; speeds are in m/s", what, speed, 3.6 * speed,
                     speed > fastest_train ? "has run" : "in service");
}

bool is_possibly_in_kilonewtons(double force) { return force > 0.0 && force < 1e-3 * heaviest_axle * earth; }

}  // namespace traverse::norm
