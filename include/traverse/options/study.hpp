// A study: a scene with some varied options, in one dimension or in several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traverse::options {

/// One varied quantity with its values.
struct StudyDimension {
  std::vector<std::string> options;  // options with these values; the first one is the name of the dimension
  std::string unit;
  bool whole = false;          // whole numbers only
  std::string law;             // "list", "uniform", "normal" or "lognormal"
  std::vector<double> values;  // values by the index along the axis
  std::size_t axis = 0;
  double deviation = 0.0;  // standard deviation of a distribution

  /// The name of the dimension: the first of its options.
  const std::string& name() const { return options.front(); }
};

/// The question for which values of one option the runs of a study keep their limits, or have a given value of a
/// quantity. Runs are added between the least and the greatest value until the ends of all intervals are known.
struct Find {
  std::size_t dimension = 0;          // the option
  std::vector<std::size_t> for_each;  // axes with a separate answer for each of their values, such as trains
  std::string quantity;               // a limited quantity, or peaks of the study; empty: all limits
  std::optional<double> value;        // of the quantity; empty: its limit
  double accuracy = 1e-3;             // of the ends of the intervals, relative to the value of the option
};

/// A sensitivity analysis: the varied options with a distribution take the values of a design of experiments.
struct Sensitivity {
  enum class Method { local, morris, sobol };
  Method method = Method::sobol;
  std::size_t axis = 0;          // the axis of the points of the design
  std::size_t base_samples = 0;  // points of each matrix of Sobol's design, or trajectories of Morris' design
  std::uint64_t seed = 1;        // of the design and of the bootstrap
};

/// The runs are all combinations of the axes, numbered with the last axis varying fastest. Dimensions of the same axis
/// vary together.
struct Study {
  struct Axis {
    std::string name;  // the name of its dimension, or "draw" or "row" if it has several
    std::size_t length = 0;
  };
  std::vector<StudyDimension> dimensions;
  std::vector<Axis> axes;
  std::vector<std::size_t> over;  // axes over which statistics are computed; empty: no statistics
  std::vector<double> quantiles;  // probabilities of the quantiles
  double confidence = 0.95;       // level of the intervals of the quantiles
  double refine =
      0.0;  // relative accuracy of the peaks over the speed, for which speeds are added; 0: no speeds are added
  std::size_t speeds = 0;  // the dimension to which speeds are added
  bool resume = false;     // finished runs in the results file are used again
  std::optional<Find> find;
  std::optional<Sensitivity> sensitivity;
  bool sweep = false;  // its axes are the trains and the speeds of a sweep (results/sweep.hpp)

  /// The product of the axes' lengths.
  std::size_t runs() const {
    std::size_t product = 1;
    for (const Axis& axis : axes) product *= axis.length;
    return product;
  }
  /// The index of a run along an axis.
  std::size_t place(std::size_t run, std::size_t axis) const {
    for (std::size_t i = axes.size(); i-- > axis + 1;) run /= axes[i].length;
    return run % axes[axis].length;
  }
  /// The value of a dimension in a run.
  double value(std::size_t run, const StudyDimension& dimension) const {
    return dimension.values[place(run, dimension.axis)];
  }
};

}  // namespace traverse::options
