// A study: a scene with some of its options varied, in one dimension or in several.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace traverse::options {

/// A number that is varied.
struct StudyDimension {
  std::vector<std::string> options;  // that take its values, the first one names the dimension
  std::string unit;
  bool whole = false;          // whole numbers only
  std::string law;             // "list", "uniform", "normal" or "lognormal", as drawn
  std::vector<double> values;  // along its axis
  std::size_t axis = 0;

  /// The first of its options.
  const std::string& name() const { return options.front(); }
};

/// Runs are numbered through the axes, the last of which runs fastest; the dimensions of one axis go side by side.
struct Study {
  struct Axis {
    std::string name;  // of its dimension, or "draw" or "row" where it has several
    std::size_t length = 0;
  };
  std::vector<StudyDimension> dimensions;
  std::vector<Axis> axes;
  std::vector<std::size_t> over;  // axes that statistics go over; empty: none
  std::vector<double> quantiles;  // of the statistics
  double confidence = 0.95;       // of their intervals
  double refine = 0.0;            // of each peak over the speed, to which speeds are added; 0: none are
  std::size_t speeds = 0;         // the dimension that these are added to
  bool resume = false;            // the results file holds runs of it that need not be run again
  bool sweep = false;             // its axes are the trains and the speeds of a sweep (results/sweep.hpp)

  /// The product of the axes' lengths.
  std::size_t runs() const {
    std::size_t product = 1;
    for (const Axis& axis : axes) product *= axis.length;
    return product;
  }
  /// Where a run stands on an axis.
  std::size_t place(std::size_t run, std::size_t axis) const {
    for (std::size_t i = axes.size(); i-- > axis + 1;) run /= axes[i].length;
    return run % axes[axis].length;
  }
  double value(std::size_t run, const StudyDimension& dimension) const {
    return dimension.values[place(run, dimension.axis)];
  }
};

}  // namespace traverse::options
