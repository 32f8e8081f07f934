// The version, which CMakeLists.txt defines for this file only: a new version compiles nothing else.
#include "traverse/base/version.hpp"

#include <charconv>

namespace traverse {
namespace {

/// The first number of a version; 0 if it does not begin with a number.
int major_of(std::string_view text) noexcept {
  int number = 0;
  (void)std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

const char* version() noexcept { return TRAVERSE_VERSION; }

bool is_newer_major(std::string_view other) noexcept { return major_of(other) > major_of(version()); }

}  // namespace traverse
