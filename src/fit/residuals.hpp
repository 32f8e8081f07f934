// The residuals of a fit: (computed - measured) / standard deviation for every measured frequency and value of a
// series.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "fit/forward_model.hpp"
#include "fit/spline.hpp"
#include "traverse/options/fit.hpp"

namespace traverse::fit {

/// A quantity that the fit estimates: an option, the difference of two clocks, or the offset or factor of a series.
struct Unknown {
  enum class Kind { option, shift, offset, gain };
  Kind kind = Kind::option;
  std::string name, unit;
  double low = 0.0, high = 0.0, start = 0.0;
  std::size_t series = 0;    // of a shift, an offset or a gain
  bool logarithmic = false;  // u is linear in the logarithm

  /// The value at u, and u at a value: u is 0 at the lowest and 1 at the highest value.
  double value(double u) const;
  double u(double value) const;
  /// d value / d u.
  double slope(double u) const;
};

/// A measured series and its computed counterpart, with the filter of both.
struct ComparedSeries {
  std::vector<double> time, measured, computed;
};

/// A measured shape of a mode, and the computed one in the scale that is closest to it.
struct ComparedShape {
  std::vector<double> measured, computed;
  double mac = 0.0;  // modal assurance criterion, 1
};

/// A shift of a series' clock with the correlation of its measured and its computed values; -1 if one of
/// them is constant.
struct Alignment {
  double shift = 0.0;  // s
  double correlation = -std::numeric_limits<double>::infinity();
};

class Residuals {
 public:
  /// Series without a standard deviation get one for the first iterations, a small part of their variation.
  /// units: of the series.
  Residuals(const options::Fit& fit, std::vector<std::string> units);

  /// Aligns the clocks by the computed samples at the start: the shift of each aligned series is the one with the
  /// least misfit, and it may vary by `range` (s). The samples are those of a model with this interval (s), from 0 on.
  void align(const std::vector<double>& response, double interval, double range);
  /// The latest time by the scene's clock of any measured value, s.
  double end() const;
  /// The shifts with the least misfit, within their bounds, and the offsets and gains of the line that is closest to
  /// the measured over the computed values, for these computed samples.
  void set_starts(const std::vector<double>& response, Eigen::VectorXd& u) const;

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  std::size_t options() const { return fit_.parameters.size(); }  // they are the first unknowns
  Eigen::VectorXd start() const;
  std::vector<double> values(const Eigen::VectorXd& u) const;  // of the options
  std::size_t size() const { return size_; }
  /// The shift from `low` to `high` (s) with the least misfit if computed values may be multiplied by a factor above 0
  /// and get an offset: the one with the largest correlation.
  Alignment best_alignment(std::size_t series, const std::vector<double>& response, double low, double high) const;
  /// All residuals; response: see ForwardModel::run.
  Eigen::VectorXd evaluate(const std::vector<double>& response, const Eigen::VectorXd& u) const;
  /// The shape of a measured frequency that has one.
  ComparedShape shape(std::size_t frequency, const std::vector<double>& response) const;
  /// A series and its computed counterpart.
  ComparedSeries compared(std::size_t series, const std::vector<double>& response, const Eigen::VectorXd& u) const;
  /// The same with a given shift (s), without an offset and a gain.
  ComparedSeries compared(std::size_t series, const std::vector<double>& response, double shift) const;

  /// The number of independent values of a series: a filter makes neighbours depend on each other.
  double independent(std::size_t series) const;
  double independent() const;                                                                  // of all measurements
  const std::vector<double>& measured(std::size_t series) const { return measured_[series]; }  // filtered
  std::size_t series_count() const { return fit_.series.size(); }
  const std::string& name(std::size_t series) const { return fit_.series[series].name; }
  const std::string& unit(std::size_t series) const { return units_[series]; }
  bool filtered(std::size_t series) const { return fit_.series[series].low_pass.has_value(); }
  /// The residuals of a series within those of all.
  Eigen::VectorXd of_series(std::size_t series, const Eigen::VectorXd& residuals) const;
  /// Standard deviation of the values of a series.
  double sd(std::size_t series) const { return sd_[series]; }
  /// Sets the standard deviations that are not given from the residuals. Returns the factors by which all residuals
  /// change.
  Eigen::VectorXd estimate_sd(const Eigen::VectorXd& residuals);

 private:
  Spline spline_of(std::size_t series, const std::vector<double>& response) const;
  std::vector<double> computed(std::size_t series, const std::vector<double>& response, double shift) const;

  const options::Fit& fit_;
  std::vector<std::string> units_;
  std::vector<Unknown> unknowns_;
  std::vector<std::vector<double>> measured_;  // filtered
  std::vector<double> sd_;
  double interval_ = 0.0;
  std::size_t size_ = 0;
};

}  // namespace traverse::fit
