// A bridge by natural modes that were found elsewhere: by another program's model of the whole bridge, or by a
// measurement. Between stations shapes are cubic, through the values and slopes there.
#pragma once

#include <string>
#include <vector>

namespace traverse::beam {

struct GivenModes {
  /// A further quantity that the modes' coordinates give: a stress, a moment, a bearing's force.
  struct Output {
    std::string name, unit;
    std::vector<double> of_mode;  // in its unit for 1 m kg^(1/2) of each mode's coordinate
  };

  std::string source;                      // the file that they came from, for messages
  std::vector<double> x;                   // m, ascending from 0, where the bridge begins, to its end
  std::vector<double> omega, ratio;        // rad/s, ascending, above 0; damping ratios
  std::vector<std::vector<double>> shape;  // [mode][station]: upward, m for 1 m kg^(1/2) of the mode's coordinate
  std::vector<std::vector<double>> slope;  // of these, 1/m
  std::vector<Output> outputs;
};

/// Slopes of a cubic spline through values at x: continuous curvature, and at both ends the slope of the cubic through
/// the four stations there (with fewer stations that of the polynomial through all).
std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& values);

}  // namespace traverse::beam
