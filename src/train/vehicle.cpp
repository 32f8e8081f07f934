// Evaluates the Fourier series and the table of a force that varies over time.
#include "traverse/train/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace traverse::train {

double ForceVariation::at(double t) const {
  double sum = table ? table->value(t) : 0.0;
  for (std::size_t k = 0; k < amplitudes.size(); ++k)
    sum += amplitudes[k] * std::sin(2.0 * std::numbers::pi * static_cast<double>(k + 1) * frequency * t + phases[k]);
  return sum;
}

double ForceVariation::highest_frequency() const {
  for (std::size_t k = amplitudes.size(); k > 0; --k)
    if (amplitudes[k - 1] != 0.0) return static_cast<double>(k) * frequency;
  return 0.0;
}

}  // namespace traverse::train
