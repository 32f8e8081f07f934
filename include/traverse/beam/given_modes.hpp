// A bridge by natural modes from another program's model of the whole bridge, or from a measurement. Between stations
// the shapes are cubic polynomials through the values and slopes at the stations.
#pragma once

#include <string>
#include <vector>

namespace traverse::beam {

struct GivenModes {
  /// A further result that follows from the modal coordinates: a stress, a moment, a bearing's force.
  struct Output {
    std::string name, unit;
    std::vector<double> of_mode;  // value for each mode at a modal coordinate of 1 m kg^(1/2), in `unit`
  };

  std::string source;                      // the file of the modes, for messages
  std::vector<double> x;                   // m, ascending from 0, the left end of the bridge, to its right end
  std::vector<double> omega, ratio;        // rad/s, ascending, above 0; damping ratios
  std::vector<std::vector<double>> shape;  // [mode][station]: upward, m for 1 m kg^(1/2) of the mode's coordinate
  std::vector<std::vector<double>> slope;  // slope of the shapes, 1/m
  std::vector<Output> outputs;
};

/// Slopes of a cubic spline through values at x. The curvature is continuous. The slope at each end is the slope of the
/// cubic through the four stations there, or of the polynomial through all stations if there are fewer than four.
std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& values);

}  // namespace traverse::beam
