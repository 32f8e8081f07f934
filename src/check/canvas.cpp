// A character grid with its legend; UTF-8, colour and width follow from the locale, TERM, NO_COLOR and the size of the
// terminal window.
#include "canvas.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <langinfo.h>
#include <locale.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace traverse::check {
namespace {

constexpr int min_width = 40, max_width = 160;

/// Whether the user's locale is UTF-8. The program itself keeps the C locale, whose numbers have decimal points.
bool is_utf8() {
  locale_t user_locale = newlocale(LC_CTYPE_MASK, "", nullptr);
  if (user_locale == nullptr) return false;
  const bool utf8 = std::string_view(nl_langinfo_l(CODESET, user_locale)) == "UTF-8";
  freelocale(user_locale);
  return utf8;
}

bool is_dumb() {
  const char* terminal = std::getenv("TERM");
  return terminal == nullptr || std::string_view(terminal) == "dumb";
}

}  // namespace

OutputStyle output_style() {
  OutputStyle style;
  // Open MPI's mpirun runs ranks in a pseudo terminal, whatever its own output is.
  const bool under_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  if (isatty(STDOUT_FILENO) != 1 || under_mpirun) return style;
  style.utf8 = is_utf8();
  style.colour = std::getenv("NO_COLOR") == nullptr && !is_dumb();
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    style.width = std::clamp(static_cast<int>(size.ws_col) - 1, min_width, max_width);
  return style;
}

Canvas::Canvas(int columns, int rows, bool utf8)
    : columns_(columns), utf8_(utf8), cells_(static_cast<std::size_t>(columns * rows), " ") {}

void Canvas::put(int column, int row, const Symbol& symbol) {
  if (!inside(column, row)) return;
  const std::string shown = utf8_ ? std::string(symbol.utf8) : std::string(1, symbol.ascii);
  cells_[static_cast<std::size_t>(row * columns_ + column)] = shown;
  if (symbol.meaning.empty()) return;
  const std::string entry = fmt::format("{} {}", shown, symbol.meaning);
  if (std::find(legend_.begin(), legend_.end(), entry) == legend_.end()) legend_.push_back(entry);
}

void Canvas::text(int column, int row, std::string_view ascii) {
  for (const char c : ascii) {
    if (inside(column, row)) cells_[static_cast<std::size_t>(row * columns_ + column)] = std::string(1, c);
    ++column;
  }
}

std::vector<std::string> Canvas::lines() const {
  std::vector<std::string> lines;
  for (int row = 0; row < rows(); ++row) {
    std::string line;
    for (int column = 0; column < columns_; ++column) line += cell(column, row);
    line.resize(line.find_last_not_of(' ') + 1);
    lines.push_back(line);
  }
  return lines;
}

std::string Canvas::legend() const { return fmt::format("{}", fmt::join(legend_, ", ")); }

}  // namespace traverse::check
