// What all targets share: bytes as text, and that an Error, which is one clear line, is a good end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "traverse/base/error.hpp"

namespace traverse::test {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Whether `read` has ended without an Error. Whatever else it throws ends the target.
template <class Read>
bool reads(Read&& read) {
  try {
    read();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace traverse::test
