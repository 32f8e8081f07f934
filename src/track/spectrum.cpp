// Power of a displacement spectrum within a band in closed form, and the parameters of ISO 8608 classes, German
// railways and FRA track classes.
#include "traverse/track/spectrum.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "traverse/base/error.hpp"

namespace traverse::track {

double Spectrum::density(double wavenumber) const {
  const double squared = wavenumber * wavenumber;
  return strength / ((squared + flat_below * flat_below) * (1.0 + squared / (steep_above * steep_above)));
}

// 1/((x^2 + r^2)(1 + x^2/c^2)) is c^2/(c^2 - r^2) (1/(x^2 + r^2) - 1/(x^2 + c^2)).
double Spectrum::power(double low, double high) const {
  // Integral of 1/(x^2 + a^2); one arctangent in place of the difference of two.
  const auto part = [&](double a) {
    if (std::isinf(a)) return 0.0;
    if (a == 0.0) return 1.0 / low - 1.0 / high;
    return std::atan(a * (high - low) / (a * a + low * high)) / a;
  };
  const double ratio = flat_below / steep_above;
  return strength / (1.0 - ratio * ratio) * (part(flat_below) - part(steep_above));
}

Spectrum iso8608(char grade) {
  if (grade < 'A' || grade > 'E') throw InputError(std::string("ISO 8608 class '") + grade + "': allowed are A to E");
  constexpr double n0 = 0.1;  // cycles/m
  const double at_n0 = 16e-6 * std::pow(4.0, grade - 'A');
  return {2.0 * std::numbers::pi * at_n0 * n0 * n0, 0.0, std::numeric_limits<double>::infinity(), 0.1, 100.0};
}

Spectrum german(bool high_disturbance) { return {high_disturbance ? 1.080e-6 : 4.032e-7, 0.0206, 0.8246, 0.5, 80.0}; }

Spectrum fra(int grade) {
  constexpr std::array<double, 6> roughness = {1.2107e-4, 1.0181e-4, 0.6816e-4, 0.5376e-4, 0.2095e-4, 0.0339e-4};
  if (grade < 1 || grade > 6) throw InputError("FRA track class " + std::to_string(grade) + ": allowed are 1 to 6");
  return {0.25 * roughness[static_cast<std::size_t>(grade - 1)], 0.0, 0.8245, 1.5, 300.0};
}

std::optional<Spectrum> spectrum_of(std::string_view name) {
  for (const SpectrumRow& row : spectra) {
    if (row.grades.empty() && name == row.name) return row.make(' ');
    if (name.size() == row.name.size() + 1 && name.starts_with(row.name) &&
        row.grades.find(name.back()) != std::string_view::npos)
      return row.make(name.back());
  }
  return {};
}

}  // namespace traverse::track
