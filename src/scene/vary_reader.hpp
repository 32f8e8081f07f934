// Reads the values of one option that a study varies.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/options/options.hpp"

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
  /// A number in the option's unit, the text `word` of the option `given`; speeds may be given in km/h.
  double number(const std::string& given, const std::string& word) const;

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

}  // namespace traverse::scene
