// Sine and cosine of a body's angle, by power series for angles below 0.1 rad.
#include "traverse/multibody/frame.hpp"

#include <cmath>

namespace traverse::multibody {
namespace {

constexpr double small_angle = 0.1;  // rad: for smaller angles the series below are exact to rounding

}  // namespace

void Frame::set_angle(double value) {
  angle = value;
  if (std::abs(value) < small_angle) {
    const double x = value * value;
    cosine = 1.0 - x * (1.0 / 2.0) *
                       (1.0 - x * (1.0 / 12.0) *
                                  (1.0 - x * (1.0 / 30.0) * (1.0 - x * (1.0 / 56.0) * (1.0 - x * (1.0 / 90.0)))));
    sine = value *
           (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 20.0) * (1.0 - x * (1.0 / 42.0) * (1.0 - x * (1.0 / 72.0)))));
    return;
  }
  cosine = std::cos(value);
  sine = std::sin(value);
}

}  // namespace traverse::multibody
