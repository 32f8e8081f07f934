// Texts that are concatenated at compile time, from the rows of a table, words without blanks around them, and lengths
// of UTF-8 characters.
#pragma once

#include <array>
#include <cstddef>
#include <string>
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

/// The text without blanks, tabs and ends of lines around it.
inline std::string trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? "" : std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

/// The number of bytes of the UTF-8 character that starts at `at`; 0 if no valid character starts there.
inline std::size_t length_of_character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = at + 1; i < at + length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  if (length < 2) return length;
  const unsigned char second = byte(at + 1);  // rejects overlong forms, surrogates and values above U+10FFFF
  const bool invalid = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                       (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  return invalid ? 0 : length;
}

}  // namespace traverse::base
