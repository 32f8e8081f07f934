// Reads the values of one option that a study varies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/options/options.hpp"
#include "traverse/options/study.hpp"

namespace traverse::scene {

/// Reads study_vary_OPTION, study_vary_OPTION_from and so on. Throws InputError with one line.
class VaryReader {
 public:
  static constexpr std::string_view prefix = "study_vary_";
  static constexpr double most_values = 1e6;

  VaryReader(const options::Options& o, std::string option)
      : o_(o), option_(std::move(option)), row_(*o.find_known(option_)) {}

  /// The name of the option study_vary_OPTION or study_vary_OPTION_how.
  std::string name(std::string_view how = "") const;
  bool has(std::string_view how = "") const { return o_.entries().has(name(how)); }
  bool whole() const { return row_.kind == options::Kind::integer || row_.kind == options::Kind::integers; }
  std::string_view unit() const { return row_.unit; }

  /// Refuses a number that is not a value of the option.
  void check(const std::string& given, double value, const std::string& what = "", const char* advice = "") const;
  /// The values of a list, whose words may be from:to or from:to:step. `count` is their number; if it is above
  /// most_values, not all values are returned.
  std::vector<double> list(double& count) const;
  /// The values of from, to and step or count, with `count` as for a list.
  std::vector<double> block(double& count) const;
  /// "uniform", "normal" or "lognormal"; empty for listed values.
  std::string law() const;
  /// Draws `count` values from the law.
  std::vector<double> draws(std::uint64_t seed, std::size_t count) const;
  /// Mean, standard deviation and quantiles of the law.
  double mean() const;
  double deviation() const;
  double quantile(double probability) const;
  /// Checks that the values are given in one way only.
  void check_one_way() const;
  /// Adds the options of the list `also` that take the same value in every run.
  void add_others(const std::string& also, options::StudyDimension& dimension) const;
  /// A number in the option's unit, the text `word` of the option `given`; speeds may be given in km/h.
  double number(const std::string& given, const std::string& word) const { return o_.to_quantity(given, word, row_); }

 private:
  /// The two numbers of the law, checked.
  struct Parameters {
    double a = 0.0, b = 0.0;
  };
  Parameters parameters() const;
  double number(std::string_view how) const { return number(name(how), o_.text(name(how))); }
  std::vector<double> range(const std::string& given, double from, double to, double step, double& count) const;

  const options::Options& o_;
  std::string option_;
  const options::Row& row_;
};

/// The axes of a study: combines listed and drawn dimensions by study_combine, and gives the factors of a sensitivity
/// analysis the values of its design.
class StudyAxes {
 public:
  /// Fills the axes and dimensions of `study`. Both must outlive this object.
  StudyAxes(const options::Options& o, options::Study& study);

  /// Adds a dimension with `count` listed values, or with draws from them.
  void add_listed(options::StudyDimension dimension, double count);
  /// Adds a dimension whose values are drawn, or are set by a design.
  void add_drawn(options::StudyDimension dimension, const VaryReader& reader);
  /// Gives the factors of a sensitivity analysis the values of its design.
  void finish_design();
  /// The number of all runs, which may be too great for an integer, and its factors in words.
  double runs() const { return runs_; }
  /// The allowed number. A sensitivity analysis stores the points of its design only.
  double most_runs() const { return study_.sensitivity ? 1e8 : VaryReader::most_values; }
  const std::string& sizes() const { return sizes_; }

 private:
  static constexpr double tail = 0.025;  // of a distribution, outside the range of elementary effects

  void add_factor(options::StudyDimension dimension, const VaryReader& reader);
  /// The values of factor i at the points of a design in the unit cube.
  std::vector<double> values_of(const VaryReader& reader, const std::vector<double>& cube, std::size_t i,
                                std::size_t factors) const;
  /// The values of factor i for central differences about the means.
  static std::vector<double> local_values(const VaryReader& reader, std::size_t i, std::size_t factors);
  std::size_t draws(const std::string& dimension) const;
  /// Assigns a dimension to the shared axis.
  void merge(const char* name, std::size_t length, options::StudyDimension& dimension);
  void draw_from_list(options::StudyDimension& dimension) const;

  const options::Options& o_;
  options::Study& study_;
  std::string combine_, sizes_;
  std::uint64_t seed_ = 1;
  std::size_t draws_ = 0;
  double runs_ = 1.0;
  std::optional<std::size_t> joint_;  // the axis that several dimensions share
  std::size_t first_factor_ = 0;      // dimension of the first factor of a sensitivity analysis
  std::vector<VaryReader> readers_;   // of its factors
};

}  // namespace traverse::scene
