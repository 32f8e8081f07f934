// Tables with a line of column names, as spreadsheets export them: columns in any order, text and numbers in the cells.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/table_text.hpp"
#include "options/table_units.hpp"

namespace traverse::options {

/// A column that a reader knows.
struct KnownColumn {
  std::string_view name;
  std::string_view unit = {};  // SI; empty: text, or the name says it
};

class NamedTable {
 public:
  /// InputError with file and line if there are no column names, one is given twice, or a row has another number of
  /// cells. A name may have a unit in brackets: "mass [t/m]"; "load [kN]" also stands for load_kN.
  NamedTable(const std::string& path, std::span<const KnownColumn> known);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Throws InputError for a column that is not known.
  void check_names() const;

  std::size_t rows() const { return lines_.size(); }
  bool has(std::string_view column) const { return index_of(column) >= 0; }
  /// The text of a cell without blanks around it; empty if the table does not have the column.
  std::string_view text(std::size_t row, std::string_view column) const;
  /// A number above 0 in SI units. InputError with file, line and column for anything else, as the next two.
  double positive(std::size_t row, std::string_view column) const;
  /// A finite number in SI units.
  double number(std::size_t row, std::string_view column) const;
  /// A speed above 0 in m/s; "300 km/h" is one, too.
  double speed(std::size_t row, std::string_view column) const;
  /// The numbers of a cell in SI units, separated by blanks; none of an empty cell.
  std::vector<double> numbers(std::size_t row, std::string_view column) const;
  /// A note on how the file is written; empty for decimal points.
  std::string note() const { return table_.form().empty() ? "" : path_ + ": " + table_.form(); }
  /// Throws InputError "FILE:LINE: why".
  [[noreturn]] void refuse(std::size_t row, const std::string& why) const;
  [[noreturn]] void refuse_columns(const std::string& why) const;

 private:
  void add_column(const std::string& cell);
  int index_of(std::string_view column) const;
  double converted(std::size_t row, std::string_view column, std::string_view word) const;

  std::string path_;
  TableText table_;
  std::span<const KnownColumn> known_;
  std::vector<std::string> columns_;
  std::vector<TableUnit> units_;         // of each column
  std::vector<int> lines_;               // of each row
  std::vector<std::string_view> cells_;  // [row][column]
};

}  // namespace traverse::options
