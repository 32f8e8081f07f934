// Expands lists and ranges of values, and draws samples of uniform, normal and lognormal distributions from a
// reproducible random stream. Places dimensions on axes of their own or on a shared one, and computes the designs of
// sensitivity analyses.
#include "vary_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <utility>

#include "base/random_stream.hpp"
#include "base/sampling_design.hpp"
#include "traverse/base/error.hpp"

namespace traverse::scene {
namespace {
constexpr double range_tolerance = 1e-3;  // relative to a step: ends are often rounded values in km/h
}

std::string VaryReader::name(std::string_view how) const {
  return std::string(prefix) + option_ + (how.empty() ? "" : "_" + std::string(how));
}

void VaryReader::add_others(const std::string& also, options::StudyDimension& dimension) const {
  if (!o_.has(also)) return;
  for (const std::string& other : o_.texts(also)) {
    o_.check_known(also, other);
    dimension.options.push_back(other);
  }
}

void VaryReader::check(const std::string& given, double value, const std::string& what, const char* advice) const {
  if (row_.unit == "m/s" && value == 0.0)
    o_.refuse(given, "0 m/s: no wheel or force would leave the bridge; allowed: above 0");
  const bool fits = row_.range.contains(value) && (!whole() || (value == std::floor(value) && std::abs(value) < 2e9));
  if (!fits)
    o_.refuse(given, fmt::format("{}{:g} is not a value of {}; allowed: {}{}", what, value, option_,
                                 options::allowed(row_), advice));
}

/// The values from, from + step, ... up to `to`.
std::vector<double> VaryReader::range(const std::string& given, double from, double to, double step,
                                      double& count) const {
  if (!(step > 0.0)) o_.refuse(given, fmt::format("the step is {:g}; allowed: above 0", step));
  if (to < from) o_.refuse(given, fmt::format("an empty range: from {:g} is above to {:g}", from, to));
  count = std::floor((to - from) / step + range_tolerance) + 1.0;
  std::vector<double> values;
  for (int i = 0; count <= most_values && i < static_cast<int>(count); ++i) values.push_back(from + i * step);
  return values;
}

std::vector<double> VaryReader::list(double& count) const {
  std::vector<double> values;
  count = 0.0;
  for (const std::string& word : o_.texts(name())) {
    const std::size_t first = word.find(':'), second = word.find(':', first == word.npos ? first : first + 1);
    if (first == word.npos) {
      values.push_back(number(name(), word));
      count += 1.0;
      continue;
    }
    const std::string middle = word.substr(first + 1, second == word.npos ? word.npos : second - first - 1);
    const double step = second == word.npos ? 1.0 : number(name(), word.substr(second + 1));
    double own = 0.0;
    const std::vector<double> more =
        range(name(), number(name(), word.substr(0, first)), number(name(), middle), step, own);
    values.insert(values.end(), more.begin(), more.end());
    count += own;
  }
  if (count == 0.0) o_.refuse(name(), "an empty list; give values of " + option_);
  return values;
}

std::vector<double> VaryReader::block(double& count) const {
  for (const char* end : {"from", "to"})
    if (!has(end))
      o_.refuse(name(has("from")   ? "from"
                     : has("to")   ? "to"
                     : has("step") ? "step"
                                   : "count"),
                fmt::format("needs from, to, and step or count; {} is missing", name(end)));
  const double from = number("from"), to = number("to");
  if (has("step") == has("count")) o_.refuse(name("from"), "needs from, to, and either step or count");
  if (has("step")) return range(name("step"), from, to, number("step"), count);
  const int requested = o_.integer(name("count"));
  if (to < from) o_.refuse(name("from"), fmt::format("an empty range: from {:g} is above to {:g}", from, to));
  count = requested;
  std::vector<double> values;
  for (int i = 0; i < requested; ++i)
    values.push_back(requested == 1 ? from : from + (to - from) * i / (requested - 1));
  return values;
}

std::string VaryReader::law() const {
  for (const char* law : {"uniform", "normal", "lognormal"})
    if (has(law)) return law;
  return "";
}

VaryReader::Parameters VaryReader::parameters() const {
  const std::string of = law(), given = name(of);
  const std::vector<std::string> words = o_.texts(given);
  const double a = number(given, words[0]), b = number(given, words[1]);
  const bool uniform = of == "uniform";
  if (uniform ? !(b > a) : !(b > 0.0))
    o_.refuse(given, uniform ? "allowed: the least, then the greatest value" : "allowed: a deviation above 0");
  if (of == "lognormal" && !(a > 0.0)) o_.refuse(given, "allowed: a mean above 0");
  if (whole() && !uniform) o_.refuse(given, "the option has whole numbers; allowed: uniform, or a list");
  return {a, b};
}

double VaryReader::mean() const {
  const auto [a, b] = parameters();
  return law() == "uniform" ? 0.5 * (a + b) : a;
}

double VaryReader::deviation() const {
  const auto [a, b] = parameters();
  return law() == "uniform" ? (b - a) / std::sqrt(12.0) : b;
}

double VaryReader::quantile(double probability) const {
  const auto [a, b] = parameters();
  if (law() == "uniform") return a + probability * (b - a);
  const double normal = boost::math::quantile(boost::math::normal(), probability);
  const double wide = std::sqrt(std::log1p(b * b / (a * a)));
  return law() == "normal" ? a + b * normal : a * std::exp(wide * normal - 0.5 * wide * wide);
}

std::vector<double> VaryReader::draws(std::uint64_t seed, std::size_t count) const {
  const std::string of = law(), given = name(of);
  const auto [a, b] = parameters();
  const bool uniform = of == "uniform";
  const double wide = std::sqrt(std::log1p(b * b / (a * a)));
  const base::RandomStream stream(seed, option_);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    double value = 0.0;
    if (uniform)
      value = whole() ? std::floor(a + stream.uniform(i) * (b - a + 1.0)) : a + stream.uniform(i) * (b - a);
    else if (of == "normal")
      value = a + b * stream.normal(i);
    else
      value = a * std::exp(wide * stream.normal(i) - 0.5 * wide * wide);
    check(given, value, fmt::format("draw {}: ", i + 1),
          of == "normal" ? "; use lognormal, or a smaller deviation" : "");
    values.push_back(value);
  }
  return values;
}

void VaryReader::check_one_way() const {
  std::vector<std::string> ways;
  for (const char* way : {"", "from", "uniform", "normal", "lognormal"})
    if (has(way)) ways.push_back(name(way));
  if (ways.size() > 1) o_.refuse(ways[1], "give either these or " + ways[0]);
}

using options::Study;
using options::StudyDimension;

StudyAxes::StudyAxes(const options::Options& o, Study& study)
    : o_(o), study_(study), combine_(o.choice("study_combine")) {
  seed_ = static_cast<std::uint64_t>(o.integer("study_seed"));
  if (o.has("study_draws")) draws_ = static_cast<std::size_t>(o.integer("study_draws"));
  const std::string method = o.choice("study_sensitivity");
  if (method == "none") return;
  using Method = options::Sensitivity::Method;
  study_.sensitivity.emplace();
  study_.sensitivity->method = method == "local" ? Method::local : method == "morris" ? Method::morris : Method::sobol;
  study_.sensitivity->seed = seed_;
}

void StudyAxes::add_listed(StudyDimension dimension, double count) {
  if (combine_ != "grid")
    o_.check_at_most("study_combine", count, VaryReader::most_values, "values of " + dimension.name());
  if (combine_ == "grid") {
    dimension.axis = study_.axes.size();
    study_.axes.push_back({dimension.name(), static_cast<std::size_t>(std::min(count, 1e15))});
    runs_ *= count;
    sizes_ += fmt::format("{}{:g} of {}", sizes_.empty() ? "" : " times ", count, dimension.name());
  } else if (combine_ == "together") {
    merge("row", static_cast<std::size_t>(count), dimension);
    runs_ = count;
  } else {
    draw_from_list(dimension);
    merge("draw", draws(dimension.name()), dimension);
    runs_ = static_cast<double>(draws_);
  }
  study_.dimensions.push_back(std::move(dimension));
}

void StudyAxes::add_drawn(StudyDimension dimension, const VaryReader& reader) {
  if (study_.sensitivity) return add_factor(std::move(dimension), reader);
  std::size_t count = draws_;
  if (combine_ == "together" && joint_) count = study_.axes[*joint_].length;
  if (count == 0) count = draws(dimension.name());
  if (!joint_ && combine_ != "together") {
    runs_ *= static_cast<double>(count);
    sizes_ += fmt::format("{}{} draws", sizes_.empty() ? "" : " times ", count);
  } else if (combine_ == "together") {
    runs_ = static_cast<double>(count);
  }
  if (runs_ <= VaryReader::most_values) dimension.values = reader.draws(seed_, count);
  merge(combine_ == "together" ? "row" : "draw", count, dimension);
  study_.dimensions.push_back(std::move(dimension));
}

void StudyAxes::finish_design() {
  if (!study_.sensitivity) return;
  options::Sensitivity& analysis = *study_.sensitivity;
  const std::size_t factors = readers_.size();
  if (factors == 0)
    o_.refuse("study_sensitivity",
              "no option has a distribution; allowed: study_vary with uniform, normal or lognormal");
  using Method = options::Sensitivity::Method;
  if (analysis.method != Method::local) {
    analysis.base_samples = draws(study_.dimensions[first_factor_].name());
    if (analysis.base_samples < 2)
      o_.refuse("study_draws", "one sample has no scatter, so that its intervals would have no width; allowed: from 2");
  }
  const auto points = static_cast<double>(analysis.method == Method::local ? 1 + base::local_points_per_factor * factors
                                          : analysis.method == Method::morris ? base::morris_block(factors)
                                                                              : base::saltelli_block(factors)) *
                      static_cast<double>(std::max<std::size_t>(analysis.base_samples, 1));
  runs_ *= points;
  sizes_ += fmt::format("{}{:g} points of the design", sizes_.empty() ? "" : " times ", points);
  o_.check_at_most("study_draws", points, VaryReader::most_values, "points of the design");
  if (runs_ > most_runs()) return;
  study_.axes[analysis.axis].length = static_cast<std::size_t>(points);
  const std::vector<double> cube =
      analysis.method == Method::sobol    ? base::saltelli_design(analysis.base_samples, factors, seed_)
      : analysis.method == Method::morris ? base::morris_design(analysis.base_samples, factors, seed_)
                                          : std::vector<double>();
  for (std::size_t i = 0; i < factors; ++i) {
    StudyDimension& factor = study_.dimensions[first_factor_ + i];
    factor.values = cube.empty() ? local_values(readers_[i], i, factors) : values_of(readers_[i], cube, i, factors);
    factor.deviation = readers_[i].deviation();
    for (const double value : factor.values)
      readers_[i].check(readers_[i].name(readers_[i].law()), value,
                        "value of the design: ", "; use another distribution");
  }
}

void StudyAxes::add_factor(StudyDimension dimension, const VaryReader& reader) {
  if (reader.whole()) o_.refuse(reader.name(reader.law()), "the option has whole numbers, and no sensitivity analysis");
  if (readers_.empty()) {
    study_.sensitivity->axis = study_.axes.size();
    study_.axes.push_back({"point", 0});
    first_factor_ = study_.dimensions.size();
  }
  dimension.axis = study_.sensitivity->axis;
  study_.dimensions.push_back(std::move(dimension));
  readers_.push_back(reader);
}

std::vector<double> StudyAxes::values_of(const VaryReader& reader, const std::vector<double>& cube, std::size_t i,
                                         std::size_t factors) const {
  const bool whole_range =
      reader.law() == "uniform" || study_.sensitivity->method == options::Sensitivity::Method::sobol;
  std::vector<double> values;
  for (std::size_t at = i; at < cube.size(); at += factors)
    values.push_back(reader.quantile(whole_range ? cube[at] : tail + (1.0 - 2.0 * tail) * cube[at]));
  return values;
}

std::vector<double> StudyAxes::local_values(const VaryReader& reader, std::size_t i, std::size_t factors) {
  const double mean = reader.mean(), scale = mean != 0.0 ? std::abs(mean) : reader.deviation();
  std::vector<double> values(1 + base::local_points_per_factor * factors, mean);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(1 + base::local_points_per_factor * i);
  at[0] += base::local_step * scale;
  at[1] -= base::local_step * scale;
  return values;
}

std::size_t StudyAxes::draws(const std::string& dimension) const {
  if (draws_ == 0)
    throw InputError(
        fmt::format("study_draws is missing: the number of values drawn of {}; allowed: a whole number from 1 to "
                    "{:g}",
                    dimension, VaryReader::most_values));
  return draws_;
}

void StudyAxes::merge(const char* name, std::size_t length, StudyDimension& dimension) {
  if (!joint_) {
    joint_ = study_.axes.size();
    study_.axes.push_back({name, length});
  }
  if (const std::size_t other = study_.axes[*joint_].length; other != length) {
    const auto shares_axis = [this](const StudyDimension& d) { return d.axis == *joint_; };
    const auto first = std::find_if(study_.dimensions.begin(), study_.dimensions.end(), shares_axis);
    o_.refuse("study_combine",
              fmt::format("needs lists of equal length; {} ({}) and {} ({}) differ; use study_combine grid",
                          first->name(), other, dimension.name(), length));
  }
  dimension.axis = *joint_;
}

void StudyAxes::draw_from_list(StudyDimension& dimension) const {
  const std::vector<double> list = std::move(dimension.values);
  const base::RandomStream stream(seed_, dimension.name());
  dimension.values.clear();
  for (std::size_t i = 0; i < draws(dimension.name()); ++i)
    dimension.values.push_back(list[static_cast<std::size_t>(stream.uniform(i) * static_cast<double>(list.size()))]);
}

}  // namespace traverse::scene
