// Tables with a line of column names, as spreadsheets export them: columns in any order, text and numbers in the cells,
// separated by commas or semicolons; # begins a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::screen {

class HeaderTable {
 public:
  /// InputError with file and line if there are no column names, one is not in `allowed`, one is given twice, or a row
  /// has another number of cells.
  HeaderTable(const std::string& path, const std::vector<std::string_view>& allowed);

  std::size_t rows() const { return lines_.size(); }
  bool has(std::string_view column) const { return index_of(column) >= 0; }
  /// The text of a cell without blanks around it; empty if the table does not have the column.
  std::string text(std::size_t row, std::string_view column) const;
  /// A number above 0. InputError with file and line for anything else.
  double positive(std::size_t row, std::string_view column) const;
  /// A finite number. InputError with file and line for anything else.
  double number(std::size_t row, std::string_view column) const;
  /// A speed above 0 in m/s, or in km/h as in "300 km/h".
  double speed(std::size_t row, std::string_view column) const;
  /// Throws InputError "FILE:LINE: why".
  [[noreturn]] void refuse(std::size_t row, const std::string& why) const;
  [[noreturn]] void refuse_columns(const std::string& why) const;

 private:
  int index_of(std::string_view column) const;

  std::string path_;
  int header_line_ = 0;
  std::vector<std::string> columns_;
  std::vector<int> lines_;          // of each row
  std::vector<std::string> cells_;  // [row][column]
};

}  // namespace traverse::screen
