// The text of a table as rows of cells. Commas, semicolons, tabs or blanks separate the cells, decimals have a point or
// a comma, cells may be quoted (RFC 4180, without line breaks in a cell), # begins a comment, and a line of names may
// stand above the rows, with or without #. How a table is written is found from all of its lines.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "options/parse_number.hpp"

namespace traverse::options {

/// The decimal sign of a table.
enum class Decimal { found, point, comma };

class TableText {
 public:
  /// Reads the file and finds how it is written. decider: the name of the option that gives the decimal sign; empty if
  /// there is none. InputError with file and line for a text that is no table or could be read in two ways.
  TableText(std::string path, Decimal decimal, const std::string& decider);

  /// The cells of the line of names. A line of numbers has none; a comment directly above the first row has them if it
  /// has one name for each cell of that row, each a word or words with or without a unit in brackets.
  const std::vector<std::string>& names() const { return names_; }
  int names_line() const { return names_line_; }
  bool names_in_comment() const { return names_in_comment_; }

  TableText(const TableText&) = delete;
  TableText& operator=(const TableText&) = delete;

  /// Moves to the next row; false after the last one. Empty cells at its end that no name belongs to are left out.
  bool next();
  std::size_t size() const { return cells_.size(); }
  /// Without blanks and quotation marks around it; valid as long as the table.
  std::string_view cell(std::size_t i) const { return cells_[i]; }
  /// The number of the line of the row, from 1.
  int line() const { return line_; }
  /// "FILE:LINE: " of the row.
  std::string where() const;
  /// The line of the row without its comment.
  std::string_view record() const { return record_; }

  /// Converts a word that is a finite number as a whole, by the decimal sign of the table.
  bool parse(std::string_view word, double& number) const { return parser()(word, number); }
  auto parser() const -> bool (*)(std::string_view, double&) {
    return decimal_comma_ ? parse_number_with_comma : parse_number;
  }
  /// "columns separated by semicolons, decimal commas"; empty for decimal points.
  std::string form() const;

 private:
  struct Survey;
  Survey survey() const;
  void choose_separators(const Survey& found, Decimal decimal);
  void choose_decimal(const Survey& found, Decimal decimal, const std::string& decider);
  void find_names();
  void rewind();
  bool next_record();
  void split(std::string_view record);
  std::string_view quoted(std::string_view record, std::size_t& at);

  std::string path_, text_;
  std::string_view separators_ = ",";  // one of which separates, or a run of which if runs_
  bool runs_ = false, decimal_comma_ = false, quotes_ = false;
  std::size_t at_ = 0;  // of the next line
  int line_ = 0;
  std::string_view record_, comment_;  // the line of the row; the last comment above it
  std::vector<std::string_view> cells_;
  std::deque<std::string> unescaped_;  // texts of quoted cells with quotation marks in them
  std::vector<std::string> names_;
  int names_line_ = 0;
  bool names_in_comment_ = false;
};

/// A hint for a word that is no number because of its separators of thousands; empty for other words.
std::string thousands_hint(std::string_view word);

}  // namespace traverse::options
