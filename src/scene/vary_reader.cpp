// Expands lists and ranges of values, and draws samples of uniform, normal and lognormal distributions from a
// reproducible random stream.
#include "vary_reader.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "base/random_stream.hpp"
#include "options/data_file.hpp"

namespace traverse::scene {
namespace {
constexpr double range_tolerance = 1e-3;  // relative to a step: ends are often rounded values in km/h
}

std::string VaryReader::name(std::string_view how) const {
  return std::string(prefix) + option_ + (how.empty() ? "" : "_" + std::string(how));
}

double VaryReader::number(const std::string& given, const std::string& word) const {
  double value = 0.0;
  const bool parsed = row_.unit == "m/s" ? options::parse_speed(word, value) : options::parse_number(word, value);
  if (!parsed || !options::is_quantity(value))
    o_.refuse(given, fmt::format("'{}' is not a finite number; allowed: values of {}, {}", word, option_,
                                 options::allowed(row_)));
  return value;
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

}  // namespace traverse::scene
