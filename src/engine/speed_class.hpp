// Classes of speeds with the same steps in distance, and octaves with the same windows, so that the steps of a run
// depend on its own speed only, not on the other runs of a batch.
#pragma once

#include <cmath>
#include <limits>

namespace traverse::engine {

inline constexpr double classes_an_octave =
    4.0;  // classes of speeds; time steps are at most a fifth shorter than requested

inline int speed_class(double speed) {
  if (!(speed > 0.0)) return std::numeric_limits<int>::min();  // at rest
  return static_cast<int>(std::floor(classes_an_octave * std::log2(speed) + 1e-9));
}

/// The lowest speed of a class, m/s.
inline double speed_of_class(int number) { return std::exp2(number / classes_an_octave); }

/// The power of two that a speed (m/s) is in the octave of.
inline int speed_octave(double speed) { return static_cast<int>(std::floor(speed_class(speed) / classes_an_octave)); }

}  // namespace traverse::engine
