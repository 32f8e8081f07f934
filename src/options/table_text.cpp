// Counts the signs of all lines, chooses separators and decimal sign by them, and splits the lines.
#include "options/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text.hpp"
#include "options/input_texts.hpp"
#include "options/table_units.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t longest_table_line = 1 << 16, most_table_characters = std::size_t{1} << 30;
constexpr std::string_view blanks = " \t\r";

bool is_digit(std::string_view text, std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; }

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The place of the # that begins a comment, outside of quoted cells; the end of the line without one.
std::size_t comment_of(std::string_view line, bool quotes) {
  if (!quotes) return std::min(line.find('#'), line.size());
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') inside = !inside;
    if (line[i] == '#' && !inside) return i;
  }
  return line.size();
}

/// Whether a number with a comma, such as -1,234, may have one between its thousands.
bool may_be_thousands(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  const std::size_t comma = word.find(',');
  return comma >= 1 && comma <= 3 && word.front() != '0' && word.size() == comma + 4 &&
         word.find_first_not_of("0123456789,") == word.npos;
}

/// Calls found(word) for each word of a cell whose words are all numbers, by either decimal sign or by both.
template <class Found>
void each_number(std::string_view cell, Found&& found) {
  std::array<std::string_view, 32> words;
  std::size_t count = 0;
  double number = 0.0;
  for (cell = without_blanks(cell); !cell.empty() && count < words.size();) {
    const std::string_view word = cell.substr(0, cell.find_first_of(blanks));
    const bool both = word.find(',') != word.npos && word.find('.') != word.npos;
    if (both ? word.find_first_not_of("+-.,0123456789") != word.npos : !parse_number_with_comma(word, number)) return;
    words[count++] = word;
    cell = without_blanks(cell.substr(word.size()));
  }
  for (std::size_t i = 0; i < count; ++i) found(words[i]);
}

}  // namespace

/// Numbers of lines that have a sign outside of quoted cells.
struct TableText::Survey {
  std::size_t lines = 0, commas = 0, semicolons = 0, tabs = 0;
  bool loose_comma = false;  // one that is not between two digits
  bool comma_before_tab = false;
  bool single_tabs = true;  // none beside another in the first line, and as many as there in all lines
  int inner_comma = 0;      // the first line with a comma between two digits, and another separator
};

TableText::TableText(std::string path, Decimal decimal, const std::string& decider)
    : path_(std::move(path)), text_(read_text(path_, {"", "a table", most_table_characters, true})) {
  quotes_ = text_.find('"') != std::string::npos;
  const Survey found = survey();
  choose_separators(found, decimal);
  choose_decimal(found, decimal, decider);
  find_names();
  if (found.inner_comma > 0 && names_.empty() && separators_.find(',') != std::string_view::npos &&
      decimal != Decimal::point)
    throw InputError(fmt::format("{}:{}: a comma between two digits, and another separator; {}", path_,
                                 found.inner_comma, decimal_point));
}

TableText::Survey TableText::survey() const {
  Survey found;
  int number = 0;
  std::ptrdiff_t tabs_of_first = 0;
  for (std::string_view rest = text_; !rest.empty();) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++number;
    if (line.size() > longest_table_line)
      throw InputError(
          fmt::format("{}:{}: longer than {} characters, so this is not a table", path_, number, longest_table_line));
    line = line.substr(0, comment_of(line, quotes_));
    const std::ptrdiff_t tabs = std::count(line.begin(), line.end(), '\t');
    const bool double_tab = tabs > 0 && line.find("\t\t") != line.npos;
    line = without_blanks(line);
    if (line.empty()) continue;
    if (found.lines == 0) tabs_of_first = tabs;
    found.single_tabs = found.single_tabs && tabs == tabs_of_first && !(double_tab && found.lines == 0);
    bool comma = false, semicolon = false, tab = false, blank = false, inner = false, inside = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (c == '"') inside = !inside;
      if (inside || (c >= '-' && c != ';')) continue;
      if (c == ',') {
        comma = true;
        const bool between = i > 0 && is_digit(line, i - 1) && is_digit(line, i + 1);
        inner = inner || between;
        found.loose_comma = found.loose_comma || !between;
        found.comma_before_tab = found.comma_before_tab || (i + 1 < line.size() && line[i + 1] == '\t');
      } else if (c == ';') {
        semicolon = true;
      } else if (c == '\t') {
        tab = true;
      } else if (c == ' ') {
        blank = true;
      }
    }
    ++found.lines;
    found.commas += comma ? 1 : 0;
    found.semicolons += semicolon ? 1 : 0;
    found.tabs += tab ? 1 : 0;
    if (inner && (semicolon || tab || blank) && found.inner_comma == 0) found.inner_comma = number;
  }
  return found;
}

void TableText::choose_separators(const Survey& found, Decimal decimal) {
  const bool inner = found.inner_comma > 0 && !found.loose_comma;  // a decimal sign, unless decimals have points
  const std::size_t lines = found.lines;
  const std::size_t commas = decimal == Decimal::comma || (decimal == Decimal::found && inner) ? 0 : found.commas;
  if (found.semicolons == lines)
    separators_ = ";";
  else if (found.tabs == lines && !found.comma_before_tab && found.single_tabs)
    separators_ = "\t";
  else if (commas == lines && !inner)
    separators_ = ",";
  else
    separators_ = commas > 0 ? ",; \t\r" : found.semicolons > 0 ? "; \t\r" : " \t\r";
  runs_ = separators_.size() > 1;
}

void TableText::choose_decimal(const Survey& found, Decimal decimal, const std::string& decider) {
  decimal_comma_ = decimal == Decimal::comma;
  if (decimal != Decimal::found || ((found.commas == 0 || separators_.find(',') != std::string_view::npos) && !quotes_))
    return;
  bool point = false, comma = false, thousands = true;
  int first_line = 0;
  std::string first;
  while (next_record())
    for (const std::string_view cell : cells_)
      each_number(cell, [&](std::string_view word) {
        const bool has_point = word.find('.') != word.npos, has_comma = word.find(',') != word.npos;
        if (has_point && has_comma)
          throw InputError(fmt::format("{}'{}' is not a finite number{}", where(), word, thousands_hint(word)));
        point = point || has_point;
        if (!has_comma) return;
        if (!comma) first_line = line_, first = word;
        comma = true;
        thousands = thousands && may_be_thousands(word);
      });
  rewind();
  if (!comma) return;
  const std::string where = fmt::format("{}:{}: ", path_, first_line);
  if (point)
    throw InputError(fmt::format(
        "{}{}; {}", where,
        separators_ == ";" ? "commas and semicolons in one row" : "a comma between two digits, and another separator",
        decimal_point));
  if (thousands)
    throw InputError(
        fmt::format("{}the comma of {} is either a decimal sign or between thousands, as that of every "
                    "number of the file; {}",
                    where, first, decider.empty() ? "write decimal points" : decider + " comma or point decides"));
  decimal_comma_ = true;
}

void TableText::find_names() {
  if (!next_record()) return;
  double number = 0.0;
  const auto is_number = [&](std::string_view cell) { return parse(cell, number); };
  const auto has_letter = [](std::string_view cell) {
    return cell.find_first_not_of("+-.,0123456789' ") != std::string_view::npos;
  };
  if (std::none_of(cells_.begin(), cells_.end(), is_number) && std::any_of(cells_.begin(), cells_.end(), has_letter)) {
    names_.assign(cells_.begin(), cells_.end());
    while (!names_.empty() && names_.back().empty()) names_.pop_back();
    names_line_ = line_;
    return;
  }
  const std::size_t count = cells_.size();
  const int above = line_ - 1;
  if (!comment_.empty() && comment_.find('"') == comment_.npos) {
    const std::string_view separators = separators_;
    const bool runs = runs_;
    if (const std::size_t sign = comment_.find_first_of(";,"); runs && sign != comment_.npos) {
      separators_ = comment_[sign] == ';' ? ";" : ",";
      runs_ = false;
    }
    split(comment_);
    separators_ = separators;
    runs_ = runs;
    const auto is_name = [&](std::string_view cell) {
      const UnitName parts = unit_name(cell);
      return !cell.empty() && !is_number(cell) && parts.name.find_first_of("()[]:=.") == std::string::npos;
    };
    if (cells_.size() == count && std::all_of(cells_.begin(), cells_.end(), is_name)) {
      names_.assign(cells_.begin(), cells_.end());
      names_line_ = above;
      names_in_comment_ = true;
    }
  }
  rewind();
}

void TableText::rewind() {
  at_ = 0;
  line_ = 0;
  comment_ = {};
}

bool TableText::next() {
  if (!next_record()) return false;
  while (cells_.size() > std::max<std::size_t>(names_.size(), 1) && cells_.back().empty()) cells_.pop_back();
  return true;
}

bool TableText::next_record() {
  while (at_ < text_.size()) {
    const std::string_view rest = std::string_view(text_).substr(at_), line = rest.substr(0, rest.find('\n'));
    at_ += std::min(line.size() + 1, rest.size());
    ++line_;
    const std::size_t end = comment_of(line, quotes_);
    record_ = without_blanks(line.substr(0, end));
    if (record_.empty()) {
      comment_ = end < line.size() ? without_blanks(line.substr(end + 1)) : std::string_view();
      continue;
    }
    if (separators_ == "\t") record_ = line.substr(0, line.substr(0, end).find_last_not_of(" \r") + 1);
    split(record_);
    return true;
  }
  return false;
}

void TableText::split(std::string_view record) {
  cells_.clear();
  for (std::size_t at = 0; at <= record.size();) {
    if (quotes_ || runs_) at = std::min(record.find_first_not_of(runs_ ? separators_ : " ", at), record.size());
    if (quotes_ && at < record.size() && record[at] == '"') {
      cells_.push_back(quoted(record, at));
      continue;
    }
    if (runs_ && at == record.size()) return;
    const std::size_t end = std::min(record.find_first_of(separators_, at), record.size());
    cells_.push_back(without_blanks(record.substr(at, end - at)));
    at = end + 1;
  }
}

/// The quoted cell that begins at `at`, which moves behind the separator after it.
std::string_view TableText::quoted(std::string_view record, std::size_t& at) {
  const std::size_t first = ++at;
  bool escaped = false;
  for (; (at = record.find('"', at)) != record.npos && record.substr(at, 2) == "\"\""; at += 2) escaped = true;
  if (at == record.npos) throw InputError(where() + "a quotation mark is not closed in its line");
  std::string_view cell = record.substr(first, at - first);
  if (escaped) {
    std::string& text = unescaped_.emplace_back(cell);
    for (std::size_t i = 0; (i = text.find("\"\"", i)) != std::string::npos; ++i) text.erase(i, 1);
    cell = text;
  }
  ++at;
  if (!runs_) at = std::min(record.find_first_not_of(' ', at), record.size());
  if (at < record.size() && separators_.find(record[at]) == separators_.npos)
    throw InputError(where() + "text after a closing quotation mark; allowed: a separator");
  ++at;
  return cell;
}

std::string TableText::where() const { return fmt::format("{}:{}: ", path_, line_); }

std::string TableText::form() const {
  if (!decimal_comma_) return "";
  const char* separator = separators_ == ";"    ? "semicolons"
                          : separators_ == "\t" ? "tabs"
                          : separators_ == ","  ? "commas"
                                                : "blanks";
  return fmt::format("columns separated by {}, decimal commas", separator);
}

std::string thousands_hint(std::string_view word) {
  const bool only = word.find_first_not_of("+-0123456789., '") == word.npos && is_digit(word, word.size() - 1);
  const auto signs =
      std::count_if(word.begin(), word.end(), [](char c) { return c == '.' || c == ',' || c == ' ' || c == '\''; });
  return only && signs > 0 ? "; separators of thousands are not read" : "";
}

}  // namespace traverse::options
