// Lengths of UTF-8 characters.
#pragma once

#include <cstddef>
#include <string_view>

namespace traverse::base {

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
