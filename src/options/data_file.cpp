// Parses numbers and speeds in m/s or km/h, and reads tables line by line with limits on line length, number of lines
// and magnitude.
#include "options/data_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

#include "options/input_texts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t longest_line = 4096, most_table_characters = std::size_t{1} << 30;
constexpr int most_lines = 5'000'000;

/// Whether a comma stands between two digits, as in 0,25.
bool has_comma_in_number(std::string_view line) {
  const auto digit = [&](std::size_t i) { return i < line.size() && line[i] >= '0' && line[i] <= '9'; };
  for (std::size_t i = line.find(','); i != line.npos; i = line.find(',', i + 1))
    if (i > 0 && digit(i - 1) && digit(i + 1)) return true;
  return false;
}

/// The numbers of a row without its comment.
std::vector<double> numbers_of(std::string line, const std::string& where) {
  if (has_decimal_comma(line))
    throw InputError(fmt::format("{}a comma between two digits, and another separator; {}", where, decimal_point));
  for (char& c : line) {
    if (c == ',' || c == ';') c = ' ';
  }
  std::vector<double> numbers;
  const bool names = line.find_first_of("0123456789") == std::string::npos;
  const char* hint = names ? "; a line of column names must begin with #" : "";
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    double number = 0.0;
    if (!parse_number(word, number))
      throw InputError(fmt::format("{}'{}' is not a finite number{}", where, word, hint));
    if (!is_quantity(number))
      throw InputError(fmt::format("{}'{}' is not a possible quantity in SI units", where, word));
    numbers.push_back(number);
  }
  return numbers;
}

/// Removes the first line from the text and returns it. InputError for a line that is too long for a table.
std::string next_line(std::string_view& text, const std::string& path) {
  const std::size_t size = text.find('\n');
  std::string line(text.substr(0, size));
  text.remove_prefix(size == std::string_view::npos ? text.size() : size + 1);
  if (line.size() >= longest_line)
    throw InputError(
        fmt::format("{}: a line is longer than {} characters, so this is not a table", path, longest_line));
  return line;
}

}  // namespace

bool has_decimal_comma(std::string_view line) {
  constexpr std::string_view separators = " \t\r;";
  int words = 0;
  bool comma = false;
  for (std::size_t i = line.find_first_not_of(separators); i < line.size(); ++words) {
    const std::size_t end = std::min(line.find_first_of(separators, i), line.size());
    comma = comma || has_comma_in_number(line.substr(i, end - i));
    i = line.find_first_not_of(separators, end);
  }
  return comma && words > 1;
}

bool is_quantity(double number) {
  return number == 0.0 || (std::abs(number) >= least_quantity && std::abs(number) <= greatest_quantity);
}

bool parse_number(const std::string& word, double& number) {
  const char* begin = word.data();
  const char* end = begin + word.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [stop, code] = std::from_chars(begin, end, number);
  if (code == std::errc::result_out_of_range) number = std::strtod(begin, nullptr);
  if (std::abs(number) < least_quantity) number = 0.0;  // the rounding error of a computed 0
  return code != std::errc::invalid_argument && stop == end && begin != end && std::isfinite(number);
}

bool parse_speed(std::string word, double& number) {
  double scale = 1.0;
  for (const auto& [ending, factor] : {std::pair{"km/h", 1.0 / 3.6}, std::pair{"m/s", 1.0}})
    if (word.ends_with(ending)) {
      word.resize(word.size() - std::string_view(ending).size());
      word.resize(word.find_last_not_of(' ') + 1);
      scale = factor;
    }
  if (!parse_number(word, number)) return false;
  number *= scale;
  return true;
}

std::vector<std::vector<double>> read_columns(const std::string& path, std::size_t least, std::size_t most,
                                              Order order) {
  const std::string text = read_text(path, {"", "a table", most_table_characters, true});
  std::vector<std::vector<double>> columns;
  int number = 0;
  for (std::string_view remaining = text; !remaining.empty();) {
    std::string line = next_line(remaining, path);
    line.resize(std::min(line.find('#'), line.size()));
    const std::string where = fmt::format("{}:{}: ", path, ++number);
    if (number > most_lines)
      throw InputError(fmt::format("{}: has too many lines; allowed: at most {}", path, most_lines));
    const std::vector<double> row = numbers_of(line, where);
    if (row.empty()) continue;
    if (columns.empty()) columns.resize(row.size());
    if (row.size() < least || row.size() > most || row.size() != columns.size()) {
      const std::string expected = least == most ? std::to_string(least)
                                   : columns.size() >= least && columns.size() <= most
                                       ? std::to_string(columns.size())
                                       : std::to_string(least) + " to " + std::to_string(most);
      throw InputError(fmt::format("{}has {} numbers, expected {}{}", where, row.size(), expected,
                                   line.find(',') == line.npos ? "" : fmt::format("; {}", decimal_point)));
    }
    if (order == Order::rising && !columns[0].empty() && !(row[0] > columns[0].back())) {
      throw InputError(fmt::format("{}the first column must increase strictly: row {} has {:g} after {:g}", where,
                                   columns[0].size() + 1, row[0], columns[0].back()));
    }
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
  }
  if (columns.empty()) throw InputError(path + ": contains no numbers");
  return columns;
}

}  // namespace traverse::options
