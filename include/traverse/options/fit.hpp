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
  double low = 0.0, high = 0.0;   // bounds
  double start = 0.0;             // the scene's value, or the middle of the bounds
  int copies = 1;                 // numbers of the option, all with this value
  int entry = 0;                  // of a list, counted from 1; 0: the whole option
  std::vector<double> list = {};  // the scene's own list of which this is an entry

  /// The option, with the number of the entry: load_forces_2.
  std::string name() const { return entry == 0 ? option : option + "_" + std::to_string(entry); }
};

/// A measured natural frequency, with the shape of its mode if it was measured.
struct MeasuredFrequency {
  std::string name;
  int number = 1;                          // 1: the lowest
  double value = 0.0, sd = 0.0;            // Hz, measured value and its standard deviation
  std::vector<double> x = {}, shape = {};  // m, and the measured deflections there in any scale; empty: not measured
  double shape_sd = 0.0;                   // standard deviation of these values, relative to the largest of them
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
  bool gain = false;                // a factor is estimated by which the computed values are multiplied
  std::optional<double> low_pass;   // Hz, cut-off frequency of the filter of measured and computed values
};

/// The values of the parameters minimise the sum of the squares of all residuals over their standard deviations.
struct Fit {
  std::vector<FitParameter> parameters;
  std::vector<MeasuredFrequency> frequencies;
  std::vector<MeasuredSeries> series;

  /// The number of values of modes: all frequencies, then the shapes of those that have one.
  std::size_t modal_size() const {
    std::size_t size = frequencies.size();
    for (const MeasuredFrequency& f : frequencies) size += f.x.size();
    return size;
  }
  int starts = 1;          // minimisations from different starts; the first one starts at the scene's values
  std::uint64_t seed = 1;  // of the other starts
};

}  // namespace traverse::options
