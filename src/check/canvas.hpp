// Pictures and headings made of characters, as far as the output can show them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::app {

/// What standard output shows.
struct Looks {
  bool utf8 = false;    // a terminal whose locale is UTF-8
  bool colour = false;  // a terminal that is not told otherwise (NO_COLOR, TERM=dumb)
  int width = 78;       // columns; elsewhere than on a terminal always so many
};
Looks looks_of_output();

/// One character, in ASCII and beyond, and what it stands for.
struct Symbol {
  char ascii;
  std::string_view utf8;
  std::string_view meaning;
};

class Canvas {
 public:
  Canvas(int columns, int rows, bool utf8);

  int columns() const { return columns_; }
  int rows() const { return static_cast<int>(cells_.size()) / columns_; }
  /// Beyond the edges nothing is put.
  void put(int column, int row, const Symbol& symbol);
  void text(int column, int row, std::string_view ascii);
  bool empty(int column, int row) const { return cell(column, row) == " "; }
  /// Without the blanks at their ends.
  std::vector<std::string> lines() const;
  /// "o wheel, ^ pinned": of what was put and has a meaning, in the order in which it first was.
  std::string legend() const;

 private:
  const std::string& cell(int column, int row) const {
    return cells_[static_cast<std::size_t>(row * columns_ + column)];
  }
  bool inside(int column, int row) const { return column >= 0 && column < columns_ && row >= 0 && row < rows(); }

  int columns_;
  bool utf8_;
  std::vector<std::string> cells_;
  std::vector<std::string> legend_;
};

}  // namespace traverse::app
