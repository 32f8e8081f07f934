// The text of an option's permitted values, and the most similar option name by a weighted edit distance.
#include "traverse/options/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace traverse::options {
namespace {

bool is_list(Kind kind) {
  return kind == Kind::numbers || kind == Kind::integers || kind == Kind::texts || kind == Kind::choice_list;
}

/// Whether a number may be replaced by a word.
bool has_words(const Row& row) {
  return (row.kind == Kind::number || row.kind == Kind::integer) && !row.choices.empty();
}

std::string range_text(const Range& range) {
  const bool low = range.low > any.low, high = range.high < any.high;
  if (low && high && range.above) return fmt::format("above {:g}, at most {:g}", range.low, range.high);
  if (low && high) return fmt::format("from {:g} to {:g}", range.low, range.high);
  if (low) return fmt::format("{} {:g}", range.above ? "above" : "not below", range.low);
  if (high) return fmt::format("not above {:g}", range.high);
  return "";
}

std::string kind_text(const Row& row) {
  switch (row.kind) {
    case Kind::number:
      return "a number";
    case Kind::integer:
      return "a whole number";
    case Kind::flag:
      return "true or false";
    case Kind::text:
      return "text";
    case Kind::file:
    case Kind::table:
      return "a file";
    case Kind::word_or_table:
      return "a word or a file";
    case Kind::choice:
    case Kind::choice_list:
      return "one of";
    case Kind::numbers:
      return row.count > 0 ? fmt::format("{} numbers", row.count) : "numbers";
    case Kind::integers:
      return row.count > 0 ? fmt::format("{} whole numbers", row.count) : "whole numbers";
    case Kind::texts:
      return row.count > 0 ? fmt::format("{} names", row.count) : "names";
    case Kind::number_or_file:
      return "a number or a file of two columns";
  }
  return "";
}

constexpr int edit_cost = 4;      // a letter inserted, deleted or replaced, or two neighbours swapped
constexpr int case_cost = 1;      // a lower-case letter instead of a capital one, or the reverse
constexpr int omission_cost = 2;  // words missing at the beginning or end, plus 1 for each of them

/// The least cost of the edits that change one word into another.
int distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = edit_cost * static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = edit_cost * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = a[i - 1], y = b[j - 1];
      const int change = x == y ? 0 : lower(x) == lower(y) ? case_cost : edit_cost;
      d[i][j] = std::min({d[i - 1][j] + edit_cost, d[i][j - 1] + edit_cost, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && x == b[j - 2] && a[i - 2] == y) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + edit_cost);
    }
  }
  return d[a.size()][b.size()];
}

/// The distance if `name` may have only some words of the candidate: beam_damping of beam_damping_ratios, ei of
/// beam_EI.
int distance_to_words(std::string_view name, std::string_view candidate) {
  std::vector<std::size_t> begins = {0};
  for (std::size_t i = 0; i < candidate.size(); ++i)
    if (candidate[i] == '_') begins.push_back(i + 1);
  int least = distance(name, candidate);
  const std::size_t words = begins.size();
  for (std::size_t first = 0; first < words; ++first)
    for (std::size_t past = first + 1; past <= words; ++past) {
      const std::size_t end = past == words ? candidate.size() : begins[past] - 1;
      const int omitted = static_cast<int>(words - (past - first));
      if (omitted == 0) continue;
      const int edits = distance(name, candidate.substr(begins[first], end - begins[first]));
      least = std::min(least, edits + omission_cost + omitted);
    }
  return least;
}

/// The words with another separator than a blank.
std::string joined(std::string_view words, std::string_view separator) {
  std::string out;
  for (const char c : words) out += c == ' ' ? separator : std::string_view(&c, 1);
  return out;
}

}  // namespace

const Row* find_row(std::span<const Row> rows, std::string_view name) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

bool names_table(const Row& row) {
  return row.kind == Kind::table || row.kind == Kind::number_or_file || row.kind == Kind::word_or_table;
}

std::optional<std::pair<std::string, const Row*>> beside_table(std::string_view name) {
  const std::size_t end = name.rfind('_');
  const Row* row = end == name.npos ? nullptr : find_row(table_rows(), name.substr(end + 1));
  if (row == nullptr) return {};
  return std::pair(std::string(name.substr(0, end)), row);
}

std::string allowed(const Row& row) {
  std::string words = kind_text(row);
  if (row.kind == Kind::choice || row.kind == Kind::choice_list) words += " " + joined(row.choices, ", ");
  const std::string range = range_text(row.range);
  if (!range.empty()) words += (is_list(row.kind) ? ", each " : " ") + range;
  if (!row.unit.empty() && row.unit != "1") words += fmt::format(" ({})", row.unit);
  if (has_words(row)) words += ", or " + joined(row.choices, ", or ");
  return words;
}

std::string allowed_in_short(const Row& row) {
  const bool choice = row.kind == Kind::choice || row.kind == Kind::choice_list;
  std::string words = choice                             ? joined(row.choices, ", ")
                      : row.kind == Kind::number_or_file ? "number or file"
                      : row.kind == Kind::flag           ? "true, false"
                      : row.name == "help"               ? ""
                                                         : kind_text(row);
  if (has_words(row)) words += " or " + joined(row.choices, " or ");
  if (!row.unit.empty() && row.unit != "1") words += fmt::format(" [{}]", row.unit);
  const std::string range = range_text(row.range);
  if (!range.empty()) words += ", " + range;
  if (!row.fallback.empty()) words += fmt::format("; default {}", row.fallback);
  return words;
}

std::string nearest(std::string_view name, const std::vector<std::string>& candidates) {
  std::string best;
  int least = edit_cost * (std::max<int>(2, static_cast<int>(name.size()) / 2) + 1);
  for (const std::string& candidate : candidates) {
    const int d = distance_to_words(name, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace traverse::options
