// Parses numbers by std::from_chars, and speeds in m/s or km/h.
#include "options/parse_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

namespace traverse::options {

bool is_quantity(double number) {
  return number == 0.0 || (std::abs(number) >= least_quantity && std::abs(number) <= greatest_quantity);
}

bool parse_number(std::string_view word, double& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), end, number);
  if (code == std::errc::result_out_of_range) number = std::strtod(std::string(word).c_str(), nullptr);
  if (std::abs(number) < least_quantity) number = 0.0;  // the rounding error of a computed 0
  return code != std::errc::invalid_argument && stop == end && !word.empty() && std::isfinite(number);
}

bool parse_number_with_comma(std::string_view word, double& number) {
  std::array<char, 64> copy{};
  const std::size_t comma = word.find(',');
  if (comma == word.npos) return parse_number(word, number);
  if (word.size() > copy.size() || word.find('.') != word.npos) return false;
  std::copy(word.begin(), word.end(), copy.begin());
  copy[comma] = '.';
  return parse_number({copy.data(), word.size()}, number);
}

bool parse_speed(std::string_view word, double& number) {
  double scale = 1.0;
  for (const auto& [ending, factor] : {std::pair<std::string_view, double>{"km/h", 1.0 / 3.6}, {"m/s", 1.0}})
    if (word.ends_with(ending)) {
      word.remove_suffix(ending.size());
      word = word.substr(0, word.find_last_not_of(' ') + 1);
      scale = factor;
    }
  if (!parse_number(word, number)) return false;
  number *= scale;
  return true;
}

}  // namespace traverse::options
