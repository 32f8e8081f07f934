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

namespace traverse::app {
namespace {

constexpr int narrowest = 40, widest = 160;

/// Of the user's locale, which the program itself does not take over: its numbers have points.
bool speaks_utf8() {
  locale_t users = newlocale(LC_CTYPE_MASK, "", nullptr);
  if (users == nullptr) return false;
  const bool utf8 = std::string_view(nl_langinfo_l(CODESET, users)) == "UTF-8";
  freelocale(users);
  return utf8;
}

bool is_dumb() {
  const char* terminal = std::getenv("TERM");
  return terminal == nullptr || std::string_view(terminal) == "dumb";
}

}  // namespace

Looks looks_of_output() {
  Looks sampling_interval;
  // Ranks of Open MPI's mpirun write to a terminal of its own, wherever it passes that on to.
  const bool under_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  if (isatty(STDOUT_FILENO) != 1 || under_mpirun) return sampling_interval;
  sampling_interval.utf8 = speaks_utf8();
  sampling_interval.colour = std::getenv("NO_COLOR") == nullptr && !is_dumb();
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    sampling_interval.width = std::clamp(static_cast<int>(size.ws_col) - 1, narrowest, widest);
  return sampling_interval;
}

Canvas::Canvas(int columns, int rows, bool utf8)
    : columns_(columns), utf8_(utf8), cells_(static_cast<std::size_t>(columns * rows), " ") {}

void Canvas::put(int column, int row, const Symbol& symbol) {
  if (!inside(column, row)) return;
  const std::string shown = utf8_ ? std::string(symbol.utf8) : std::string(1, symbol.ascii);
  cells_[static_cast<std::size_t>(row * columns_ + column)] = shown;
  if (symbol.meaning.empty()) return;
  const std::string said = fmt::format("{} {}", shown, symbol.meaning);
  if (std::find(legend_.begin(), legend_.end(), said) == legend_.end()) legend_.push_back(said);
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

}  // namespace traverse::app
