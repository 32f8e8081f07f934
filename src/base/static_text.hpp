// Texts that are concatenated at compile time, from the rows of a table.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace traverse::base {

struct StaticText {
  std::array<char, 400> letters{};
  std::size_t size = 0;

  constexpr void add(std::string_view more) {
    for (const char letter : more) letters[size++] = letter;
  }
  constexpr operator std::string_view() const { return {letters.data(), size}; }  // NOLINT: it is text
};

/// Adds the text of each row by add(text, row), with the separator between two of them.
template <class Rows, class Add>
constexpr void add_joined(StaticText& text, const Rows& rows, std::string_view separator, Add add) {
  bool first = true;
  for (const auto& row : rows) {
    if (!first) text.add(separator);
    first = false;
    add(text, row);
  }
}

/// The names of the rows that have one.
template <class Rows>
constexpr StaticText joined_names(const Rows& rows, std::string_view separator) {
  StaticText text;
  for (const auto& row : rows) {
    if (row.name.empty()) continue;
    if (text.size > 0) text.add(separator);
    text.add(row.name);
  }
  return text;
}

}  // namespace traverse::base
