#include "traverse/options/table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace traverse::options {
namespace {

bool is_list(Kind kind) {
  return kind == Kind::numbers || kind == Kind::integers || kind == Kind::texts || kind == Kind::choice_list;
}

std::string range_words(const Range& range) {
  const bool low = range.low > any.low, high = range.high < any.high;
  if (low && high && range.above) return fmt::format("above {:g}, at most {:g}", range.low, range.high);
  if (low && high) return fmt::format("from {:g} to {:g}", range.low, range.high);
  if (low) return fmt::format("{} {:g}", range.above ? "above" : "not below", range.low);
  if (high) return fmt::format("not above {:g}", range.high);
  return "";
}

std::string kind_words(const Row& row) {
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
      return "a file";
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

/// Fewest edits between two words; swapped neighbours count as one.
int distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

std::string replace_blanks(std::string_view words) {
  std::string out;
  for (const char c : words) out += c == ' ' ? std::string(", ") : std::string(1, c);
  return out;
}

}  // namespace

const Row* find_row(std::span<const Row> rows, std::string_view name) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

std::string allowed(const Row& row) {
  std::string words = kind_words(row);
  if (row.kind == Kind::choice || row.kind == Kind::choice_list) words += " " + replace_blanks(row.choices);
  const std::string range = range_words(row.range);
  if (!range.empty()) words += (is_list(row.kind) ? ", each " : " ") + range;
  if (!row.unit.empty() && row.unit != "1") words += fmt::format(" ({})", row.unit);
  return words;
}

std::string allowed_in_short(const Row& row) {
  const bool choice = row.kind == Kind::choice || row.kind == Kind::choice_list;
  std::string words = choice                             ? replace_blanks(row.choices)
                      : row.kind == Kind::number_or_file ? "number or file"
                      : row.kind == Kind::flag           ? "true, false"
                      : row.name == "help"               ? ""
                                                         : kind_words(row);
  if (!row.unit.empty() && row.unit != "1") words += fmt::format(" [{}]", row.unit);
  const std::string range = range_words(row.range);
  if (!range.empty()) words += ", " + range;
  if (!row.fallback.empty()) words += fmt::format("; default {}", row.fallback);
  return words;
}

std::string nearest(std::string_view name, const std::vector<std::string>& candidates) {
  std::string best;
  int least = std::max<int>(2, static_cast<int>(name.size()) / 2) + 1;
  for (const std::string& candidate : candidates) {
    const int d = distance(name, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace traverse::options
