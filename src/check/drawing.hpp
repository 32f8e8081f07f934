// A drawing of a scene to scale in characters, the bridge with its train from the side or a mechanism, and headings,
// according to the capabilities of the output.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "traverse/scene/scene.hpp"

namespace traverse::check {

/// Capabilities of the standard output.
struct OutputStyle {
  bool utf8 = false;    // a terminal whose locale is UTF-8
  bool colour = false;  // a terminal with colours (not NO_COLOR, TERM=dumb)
  int width = 78;       // columns; constant if the output is not a terminal
};
OutputStyle output_style();

/// One character, in ASCII and in UTF-8, with its meaning.
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
  /// Ignores positions outside the grid.
  void put(int column, int row, const Symbol& symbol);
  void text(int column, int row, std::string_view ascii);
  bool empty(int column, int row) const { return cell(column, row) == " "; }
  /// The rows without trailing blanks.
  std::vector<std::string> lines() const;
  /// "o wheel, ^ pinned": the symbols that have a meaning, in the order of their first use.
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

/// Lines of at most style.width columns; the last two are the legend and the scale.
std::vector<std::string> drawing_of(const scene::Scene& scene, const OutputStyle& style);

}  // namespace traverse::check
