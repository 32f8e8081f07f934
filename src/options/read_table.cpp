// Chooses columns by their names or numbers, and converts their numbers as they are read.
#include "options/read_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/text.hpp"
#include "options/parse_number.hpp"
#include "options/table_units.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/options.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t most_lines = 5'000'000;

/// The unit at a place of "s, N, N, N m"; of a table of two columns the first and the last one.
std::string_view unit_at(std::string_view units, std::size_t place, std::size_t columns) {
  const std::size_t last = std::count(units.begin(), units.end(), ',');
  std::size_t skip = place == 0 ? 0 : columns == 2 ? last : std::min(place, last);
  for (; skip > 0; --skip) units.remove_prefix(units.find(',') + 1);
  units = units.substr(units.find_first_not_of(' ') == units.npos ? 0 : units.find_first_not_of(' '));
  return units.substr(0, units.find(','));
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// A column of the result: the number in a cell, or the mean of two.
struct Column {
  std::size_t cell = 0;
  std::optional<std::size_t> other = {};
  std::optional<TableUnit> unit = {};
  double factor = 1.0, shift = 0.0;
  bool chainage = false;  // may be written as kilometres + metres
};

/// The number of 12+345.6, 12 km and 345.6 m, by its digits, so that it is that of 12345.6.
bool parse_chainage(std::string_view word, const TableText& table, double& number) {
  const std::size_t plus = word.find('+', 1);
  if (plus == word.npos || word.find_first_not_of("0123456789", plus + 1) == plus + 1) return false;
  std::string metres(word.substr(plus + 1));
  const std::size_t digits = std::min(metres.find_first_not_of("0123456789"), metres.size());
  if (digits > 3 || word.substr(0, plus).find_first_not_of("0123456789", 1) != word.npos) return false;
  return table.parse(std::string(word.substr(0, plus)) + metres.insert(0, 3 - digits, '0'), number);
}

class ColumnReader {
 public:
  ColumnReader(const std::string& path, const WantedColumns& wanted, const TableChoice& choice)
      : path_(path),
        wanted_(wanted),
        choice_(choice),
        table_(path, choice.decimal, choice.option.empty() ? "" : choice.option + "_decimal") {
    for (const std::string& name : table_.names()) names_.push_back(unit_name(name));
  }

  std::vector<std::vector<double>> read() {
    if (!table_.next()) throw InputError(path_ + ": contains no numbers");
    const std::size_t cells = names_.empty() ? table_.size() : names_.size();
    choose(cells);
    std::vector<std::vector<double>> columns(columns_.size());
    do {
      if (columns[0].size() == most_lines)
        throw InputError(fmt::format("{}: has too many lines; allowed: at most {}", path_, most_lines));
      if (table_.size() != cells) refuse_size(cells);
      for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(value(columns_[i]));
      if (const std::vector<double>& x = columns[0];
          wanted_.order == Order::rising && x.size() > 1 && !(x.back() > x[x.size() - 2]))
        throw InputError(fmt::format("{}the first column must increase strictly: row {} has {:g} after {:g}",
                                     table_.where(), x.size(), x.back(), x[x.size() - 2]));
    } while (table_.next());
    return columns;
  }

  /// How the file is written and what was converted; empty if that is usual.
  std::string note() const {
    std::vector<std::string> parts = said_;
    if (const std::string form = table_.form(); !form.empty()) parts.insert(parts.begin(), form);
    return parts.empty() ? "" : fmt::format("{}: {}", path_, fmt::join(parts, ", "));
  }

 private:
  std::string decimal_hint() const {
    return table_.record().find(',') != std::string_view::npos ? fmt::format("; {}", decimal_point) : "";
  }
  std::string column_names() const {
    std::string text;
    for (const UnitName& one : names_) text += (text.empty() ? "" : ", ") + one.name;
    return text;
  }

  [[noreturn]] void refuse_size(std::size_t cells) const {
    throw InputError(fmt::format("{}has {} {}, expected {}{}", table_.where(), table_.size(),
                                 names_.empty() ? "numbers" : "cells", cells, decimal_hint()));
  }

  /// Refuses a number of columns that nobody wants.
  void check_count(std::size_t cells) const {
    if (cells >= wanted_.least && cells <= wanted_.most) return;
    const std::string expected = wanted_.least == wanted_.most ? std::to_string(wanted_.least)
                                                               : fmt::format("{} to {}", wanted_.least, wanted_.most);
    const std::string which =
        names_.empty() || choice_.option.empty()
            ? decimal_hint()
            : fmt::format(" ({}); {}_columns names those to be read", column_names(), choice_.option);
    throw InputError(fmt::format("{}has {} numbers, expected {}{}", table_.where(), cells, expected, which));
  }

  /// The cells of the columns left and right, if there is one of each.
  std::optional<std::pair<std::size_t, std::size_t>> rails() const {
    std::optional<std::size_t> left, right;
    for (std::size_t i = 0; i < names_.size(); ++i)
      for (const auto& [side, found] : {std::pair("left", &left), std::pair("right", &right)}) {
        if (lower(names_[i].name).find(side) == std::string::npos) continue;
        if (found->has_value()) return {};
        *found = i;
      }
    if (!left || !right) return {};
    return std::pair(*left, *right);
  }

  void choose(std::size_t cells) {
    if (!choice_.columns.empty()) {
      if (choice_.columns.size() == 1) columns_.push_back({0});
      for (const std::string& word : choice_.columns) columns_.push_back({cell_of(word, cells)});
      if (columns_.size() < wanted_.least || columns_.size() > wanted_.most)
        refuse_choice("columns",
                      fmt::format("{} columns; allowed: {} to {}", columns_.size(), wanted_.least, wanted_.most));
    } else if (const auto both = rails(); wanted_.two_rails && both && cells > wanted_.most) {
      columns_ = {{0}, {both->first, both->second}};
      said_.push_back(fmt::format("mean of {} and {}", names_[both->first].name, names_[both->second].name));
    } else {
      check_count(cells);
      for (std::size_t i = 0; i < cells; ++i) columns_.push_back({i});
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) convert(i);
  }

  std::size_t cell_of(const std::string& word, std::size_t cells) const {
    for (const bool exact : {true, false}) {
      const auto is = [&](const UnitName& one) { return exact ? one.name == word : lower(one.name) == lower(word); };
      const auto count = std::count_if(names_.begin(), names_.end(), is);
      if (count > 1)
        refuse_choice("columns", fmt::format("{} has {} columns '{}'; give the number of one", path_, count, word));
      if (count == 1) return static_cast<std::size_t>(std::find_if(names_.begin(), names_.end(), is) - names_.begin());
    }
    double number = 0.0;
    if (parse_number(word, number) && number >= 1.0 && number <= static_cast<double>(cells) &&
        number == static_cast<double>(static_cast<std::size_t>(number)))
      return static_cast<std::size_t>(number) - 1;
    refuse_choice("columns", fmt::format("{} has no column '{}'; allowed: {}a number from 1 to {}", path_, word,
                                         names_.empty() ? "" : column_names() + ", or ", cells));
  }

  [[noreturn]] void refuse_choice(const char* row, const std::string& why) const {
    throw InputError(fmt::format("{}_{}: {}", choice_.option, row, why));
  }

  /// Sets the conversion of a column: by the given unit, or by that of its name.
  void convert(std::size_t i) {
    Column& column = columns_[i];
    const std::string si(unit_at(wanted_.units, i, columns_.size()));
    if (i == 0)
      column.shift = choice_.shift;
    else
      column.factor = choice_.factor;
    column.chainage = i == 0 && si == "m";
    const std::vector<std::string>& given = choice_.units;
    if (given.size() > 1 || (given.size() == 1 && i > 0)) {
      const std::string& unit = given[std::min(i, given.size() - 1)];
      column.unit = table_unit(unit, si);
      if (!column.unit) refuse_choice("unit", fmt::format("'{}' is not known; allowed: {}", unit, table_units(si)));
      return;
    }
    if (names_.empty() || (i > 0 && !wanted_.units_of_names)) return;
    column.unit = unit_of(names_[column.cell], si);
    if (column.other &&
        unit_of(names_[*column.other], si).value_or(TableUnit()).factor != column.unit.value_or(TableUnit()).factor)
      throw InputError(fmt::format("{}:{}: left and right have different units", path_, table_.names_line()));
  }

  /// The unit of a name with a unit in brackets, or after its last _; none without a unit and for SI units.
  std::optional<TableUnit> unit_of(const UnitName& name, const std::string& si) {
    const std::size_t end = name.name.rfind('_');
    const std::string word = !name.unit.empty() ? name.unit : end != std::string::npos ? name.name.substr(end + 1) : "";
    if (word.empty() || (name.unit.empty() && si.empty())) return {};
    const std::optional<TableUnit> unit = table_unit(word, si);
    if (!unit && !name.unit.empty() && !table_.names_in_comment())
      throw InputError(fmt::format("{}:{}: column {}: the unit '{}' is not known{}{}", path_, table_.names_line(),
                                   name.name, word, si.empty() ? "" : "; allowed: " + table_units(si),
                                   choice_.option.empty() ? "" : fmt::format(", or {}_unit", choice_.option)));
    if (!unit || unit->factor == 1.0) return {};
    if (const std::string said = fmt::format("{} in {}", name.name, word);
        std::find(said_.begin(), said_.end(), said) == said_.end())
      said_.push_back(said);
    return unit;
  }

  double value(const Column& column) const {
    double number = parse(column, column.cell);
    if (column.other) number = 0.5 * (number + parse(column, *column.other));
    if (column.unit) number = column.unit->to_si(number);
    return number * column.factor + column.shift;
  }

  double parse(const Column& column, std::size_t cell) const {
    const std::string_view word = table_.cell(cell);
    double number = 0.0;
    const bool parsed = table_.parse(word, number) || (column.chainage && parse_chainage(word, table_, number));
    if (parsed && is_quantity(number)) return number;
    const std::string where = table_.where() + (names_.empty() ? "" : fmt::format("column {}: ", names_[cell].name));
    throw InputError(parsed ? fmt::format("{}'{}' is not a possible quantity in SI units", where, word)
                            : fmt::format("{}'{}' is not a finite number{}", where, word, thousands_hint(word)));
  }

  const std::string& path_;
  const WantedColumns& wanted_;
  const TableChoice& choice_;
  TableText table_;
  std::vector<UnitName> names_;
  std::vector<Column> columns_;
  std::vector<std::string> said_;
};

}  // namespace

std::vector<std::vector<double>> read_columns(const std::string& path, const WantedColumns& wanted,
                                              const TableChoice& choice, std::string& note) {
  ColumnReader reader(path, wanted, choice);
  std::vector<std::vector<double>> columns = reader.read();
  note = reader.note();
  return columns;
}

std::vector<std::vector<double>> read_columns(const Options& o, const std::string& name, WantedColumns wanted) {
  const Row& row = *o.find_known(name);
  const std::string of_x = row.kind == Kind::number_or_file ? fmt::format("m, {}", row.unit) : std::string(row.unit);
  if (wanted.units.empty()) wanted.units = of_x;
  TableChoice choice;
  choice.option = name;
  const auto key = [&](const char* word) { return name + "_" + word; };
  if (o.has(key("columns"))) choice.columns = o.texts(key("columns"));
  if (o.has(key("unit"))) choice.units = o.texts(key("unit"));
  choice.factor = o.number(key("factor"));
  choice.shift = o.number(key("shift"));
  if (o.has(key("decimal"))) choice.decimal = o.choice(key("decimal")) == "comma" ? Decimal::comma : Decimal::point;
  std::string note;
  std::vector<std::vector<double>> columns = read_columns(o.path(name), wanted, choice, note);
  if (!note.empty()) o.note(note);
  return columns;
}

}  // namespace traverse::options
