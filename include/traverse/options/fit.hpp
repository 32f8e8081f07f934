// A fit: options of a scene whose values are estimated from measurements by weighted least squares.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace traverse::options {

/// An option whose value is estimated.
struct FitParameter {
  std::string option;
  std::string unit;
  double low = 0.0, high = 0.0;  // bounds
  double start = 0.0;            // the scene's value, or the middle of the bounds
  int copies = 1;                // numbers of the option, all with this value
};

/// A measured natural frequency.
struct MeasuredFrequency {
  std::string name;
  int number = 1;                // 1: the lowest
  double value = 0.0, sd = 0.0;  // Hz, measured value and its standard deviation
};

/// A measured series of a number that a run stores over time.
struct MeasuredSeries {
  std::string name;
  std::string dataset;              // its path in the results file, such as /probes/deflection
  std::optional<double> x;          // m, the station of a dataset of the probes
  int component = 1;                // the number in each row of any other dataset
  std::vector<double> time, value;  // s, by the clock of the measurement; SI units
  std::optional<double> sd;         // standard deviation of a value; none: from the residuals
  bool align = false;               // the difference of the clocks is estimated
  bool offset = false;              // a constant is estimated that is added to the computed values
  std::optional<double> low_pass;   // Hz, cut-off frequency of the filter of measured and computed values
};

/// The values of the parameters minimise the sum of the squares of all residuals over their standard deviations.
struct Fit {
  std::vector<FitParameter> parameters;
  std::vector<MeasuredFrequency> frequencies;
  std::vector<MeasuredSeries> series;
  int starts = 1;          // minimisations from different starts; the first one starts at the scene's values
  std::uint64_t seed = 1;  // of the other starts
};

}  // namespace traverse::options
