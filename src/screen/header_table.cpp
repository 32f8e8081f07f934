// Splits a table into cells, with limits on its size.
#include "screen/header_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/text.hpp"
#include "options/data_file.hpp"
#include "options/input_texts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

constexpr std::size_t longest_line = 1 << 16, most_characters = std::size_t{1} << 28, most_rows = 2'000'000;

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  while (true) {
    const std::size_t end = line.find_first_of(",;");
    cells.push_back(base::trimmed(line.substr(0, end)));
    if (end == line.npos) return cells;
    line.remove_prefix(end + 1);
  }
}

void check_names(const std::vector<std::string>& names, const std::vector<std::string_view>& allowed,
                 const std::string& where) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(allowed.begin(), allowed.end(), *name) == allowed.end())
      throw InputError(where + fmt::format("there is no column '{}'; the first line names the columns; allowed: {}",
                                           *name, fmt::join(allowed, ", ")));
    if (std::find(names.begin(), name, *name) != name)
      throw InputError(where + fmt::format("the column {} is given twice", *name));
  }
}

}  // namespace

HeaderTable::HeaderTable(const std::string& path, const std::vector<std::string_view>& allowed) : path_(path) {
  const std::string text = options::read_text(path, {"", "a table", most_characters, true});
  int number = 0;
  for (std::string_view remaining = text; !remaining.empty();) {
    const std::size_t size = std::min(remaining.find('\n'), remaining.size());
    std::string_view line = remaining.substr(0, size);
    remaining.remove_prefix(std::min(size + 1, remaining.size()));
    const std::string where = fmt::format("{}:{}: ", path, ++number);
    if (line.size() > longest_line)
      throw InputError(where + fmt::format("longer than {} characters, so this is not a table", longest_line));
    line = line.substr(0, line.find('#'));
    if (base::trimmed(line).empty()) continue;
    if (line.find(';') != line.npos && line.find(',') != line.npos)
      throw InputError(fmt::format("{}commas and semicolons in one row; {}", where, options::decimal_point));
    std::vector<std::string> cells = cells_of(line);
    if (columns_.empty()) {
      check_names(cells, allowed, where);
      columns_ = std::move(cells);
      header_line_ = number;
      continue;
    }
    if (cells.size() != columns_.size())
      throw InputError(where +
                       fmt::format("{} cells, expected {}{}", cells.size(), columns_.size(),
                                   line.find(',') == line.npos ? "" : fmt::format("; {}", options::decimal_point)));
    if (lines_.size() == most_rows) throw InputError(where + fmt::format("allowed: at most {} rows", most_rows));
    lines_.push_back(number);
    std::move(cells.begin(), cells.end(), std::back_inserter(cells_));
  }
  if (lines_.empty()) throw InputError(path + ": expected a line of column names and at least one row");
}

int HeaderTable::index_of(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

std::string HeaderTable::text(std::size_t row, std::string_view column) const {
  const int index = index_of(column);
  return index < 0 ? std::string() : cells_[row * columns_.size() + static_cast<std::size_t>(index)];
}

double HeaderTable::number(std::size_t row, std::string_view column) const {
  const std::string word = text(row, column);
  double value = 0.0;
  if (!options::parse_number(word, value) || !options::is_quantity(value))
    refuse(row, fmt::format("{}: '{}' is not a possible number", column, word));
  return value;
}

double HeaderTable::positive(std::size_t row, std::string_view column) const {
  const double value = number(row, column);
  if (!(value > 0.0)) refuse(row, fmt::format("{}: {:g}; allowed: above 0", column, value));
  return value;
}

double HeaderTable::speed(std::size_t row, std::string_view column) const {
  const std::string word = text(row, column);
  double value = 0.0;
  if (!options::parse_speed(word, value) || !(value > 0.0) || !options::is_quantity(value))
    refuse(row, fmt::format("{}: '{}'; allowed: a speed above 0 in m/s, or in km/h as in 300 km/h", column, word));
  return value;
}

void HeaderTable::refuse(std::size_t row, const std::string& why) const {
  throw InputError(fmt::format("{}:{}: {}", path_, lines_[row], why));
}

void HeaderTable::refuse_columns(const std::string& why) const {
  throw InputError(fmt::format("{}:{}: {}", path_, header_line_, why));
}

}  // namespace traverse::screen
