// Characters of UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace traverse::base {

/// Bytes of the UTF-8 character that starts at `at`; 0 where none does.
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
  const unsigned char second = byte(at + 1);  // none is written longer than needed, none is a surrogate or too high
  const bool strange = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                       (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  return strange ? 0 : length;
}

}  // namespace traverse::base
