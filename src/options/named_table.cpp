// Keeps the cells of a table by row and column, with a limit on its size.
#include "options/named_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.hpp"
#include "options/parse_number.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t most_table_rows = 2'000'000;

}  // namespace

NamedTable::NamedTable(const std::string& path, std::span<const KnownColumn> known)
    : path_(path), table_(path, Decimal::found, ""), known_(known) {
  for (const std::string& cell : table_.names()) add_column(cell);
  while (!columns_.empty() && table_.next()) {
    const bool comma = table_.record().find(',') != std::string_view::npos;
    if (table_.size() != columns_.size() && comma && table_.record().find(';') != std::string_view::npos)
      throw InputError(fmt::format("{}commas and semicolons in one row; {}", table_.where(), decimal_point));
    if (table_.size() != columns_.size())
      throw InputError(fmt::format("{}{} cells, expected {}{}", table_.where(), table_.size(), columns_.size(),
                                   comma ? fmt::format("; {}", decimal_point) : ""));
    if (lines_.size() == most_table_rows)
      throw InputError(fmt::format("{}allowed: at most {} rows", table_.where(), most_table_rows));
    lines_.push_back(table_.line());
    for (std::size_t i = 0; i < table_.size(); ++i) cells_.emplace_back(table_.cell(i));
  }
  if (lines_.empty()) throw InputError(path + ": expected a line of column names and at least one row");
}

/// Adds a column by the name that the reader knows, if its cell has that name with a unit.
void NamedTable::add_column(const std::string& cell) {
  const UnitName parts = unit_name(cell);
  std::string name = cell;
  TableUnit unit;
  for (const KnownColumn& column : known_) {
    if (parts.unit.empty()) break;
    if (column.name == parts.name + "_" + parts.unit) name = column.name;
    if (column.name != parts.name || column.unit.empty()) continue;
    const std::optional<TableUnit> found = table_unit(parts.unit, column.unit);
    if (!found)
      refuse_columns(fmt::format("column {}: the unit '{}' is not known; allowed: {}", parts.name, parts.unit,
                                 table_units(column.unit)));
    name = column.name;
    unit = *found;
  }
  if (has(name)) refuse_columns(fmt::format("the column {} is given twice", name));
  columns_.push_back(name);
  units_.push_back(unit);
}

void NamedTable::check_names() const {
  for (const std::string& name : columns_) {
    if (std::ranges::any_of(known_, [&](const KnownColumn& column) { return column.name == name; })) continue;
    std::string allowed;
    for (const KnownColumn& column : known_) allowed += (allowed.empty() ? "" : ", ") + std::string(column.name);
    refuse_columns(
        fmt::format("there is no column '{}'; the first line names the columns; allowed: {}", name, allowed));
  }
}

int NamedTable::index_of(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

std::string_view NamedTable::text(std::size_t row, std::string_view column) const {
  const int index = index_of(column);
  return index < 0 ? std::string_view() : cells_[row * columns_.size() + static_cast<std::size_t>(index)];
}

double NamedTable::converted(std::size_t row, std::string_view column, std::string_view word) const {
  double value = 0.0;
  if (!table_.parse(word, value) || !is_quantity(value))
    refuse(row, fmt::format("{}: '{}' is not a possible number{}", column, word, thousands_hint(word)));
  return units_[static_cast<std::size_t>(index_of(column))].to_si(value);
}

double NamedTable::number(std::size_t row, std::string_view column) const {
  return converted(row, column, text(row, column));
}

double NamedTable::positive(std::size_t row, std::string_view column) const {
  const double value = number(row, column);
  if (!(value > 0.0)) refuse(row, fmt::format("{}: {:g}; allowed: above 0", column, value));
  return value;
}

double NamedTable::speed(std::size_t row, std::string_view column) const {
  const std::string_view word = text(row, column);
  double value = 0.0;
  if (table_.parse(word, value))
    value = number(row, column);
  else if (!parse_speed(word, value) || !is_quantity(value))
    value = 0.0;
  if (!(value > 0.0))
    refuse(row, fmt::format("{}: '{}'; allowed: a speed above 0 in m/s, or in km/h as in 300 km/h", column, word));
  return value;
}

std::vector<double> NamedTable::numbers(std::size_t row, std::string_view column) const {
  std::vector<double> values;
  for (std::string rest = base::trimmed(text(row, column)); !rest.empty();) {
    const std::string word = rest.substr(0, rest.find(' '));
    values.push_back(converted(row, column, word));
    rest = base::trimmed(std::string_view(rest).substr(word.size()));
  }
  return values;
}

void NamedTable::refuse(std::size_t row, const std::string& why) const {
  throw InputError(fmt::format("{}:{}: {}", path_, lines_[row], why));
}

void NamedTable::refuse_columns(const std::string& why) const {
  throw InputError(fmt::format("{}:{}: {}", path_, table_.names_line(), why));
}

}  // namespace traverse::options
