// Deviation of the radius by polygonal harmonics and by a flat of cosine shape, with derivatives with respect to the
// angle, and the angles at which a flat begins and ends.
#include "traverse/track/wheel_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "traverse/base/error.hpp"
#include "two_pi.hpp"

namespace traverse::track {
namespace {

constexpr double max_turns = 1e6;  // limit of turns of a wheel with a flat, because each turn is an event of the run

}  // namespace

double flat_depth(double length, double radius) { return length * length / (16.0 * radius); }

RadiusGain radius_gain(const WheelShape& shape, double radius, double angle) {
  RadiusGain g;
  if (shape.polygon_amplitude != 0.0) {
    const double n = shape.polygon_order, A = shape.polygon_amplitude;
    const double at = n * angle + shape.polygon_phase;
    g = {A * std::cos(at), -n * A * std::sin(at), -n * n * A * std::cos(at)};
  }
  if (shape.flat_length > 0.0) {
    const double from_middle = std::remainder(angle - shape.flat_angle, two_pi);
    const double k = two_pi * radius / shape.flat_length;
    if (std::abs(k * from_middle) < std::numbers::pi) {
      const double half = 0.5 * flat_depth(shape.flat_length, radius);
      const double c = std::cos(k * from_middle);
      g.value -= half * (1.0 + c);
      g.slope += half * k * std::sin(k * from_middle);
      g.curvature += half * k * k * c;
    }
  }
  return g;
}

std::vector<double> flat_ends(const WheelShape& shape, double radius, double last) {
  std::vector<double> angles;
  if (!(shape.flat_length > 0.0)) return angles;
  if (last / two_pi > max_turns)
    throw InputError("a wheel with a flat and a radius of " + std::to_string(radius) + " m turns " +
                     std::to_string(last / two_pi) + " times in this run; allowed: " + std::to_string(max_turns) +
                     ", with a shorter run or a larger radius");
  const double half = 0.5 * shape.flat_length / radius;
  for (double end : {shape.flat_angle - half, shape.flat_angle + half})
    for (double turn = std::floor(-end / two_pi); end + two_pi * turn < last; turn += 1.0)
      if (end + two_pi * turn > 0.0) angles.push_back(end + two_pi * turn);
  std::sort(angles.begin(), angles.end());
  return angles;
}

}  // namespace traverse::track
