// The bytes of a file that is one: no pipe, which waits, no device, which has no end, no folder.
#pragma once

#include <cstddef>
#include <string>

namespace traverse::base {

/// Fills in `bytes`. Otherwise why that cannot be, in words: "is a folder, not a file", "the file cannot be read:
/// Input/ output error", or `too_long` where it has more than `most`.
std::string read_regular_file(const std::string& path, std::size_t most, std::string& bytes);
inline constexpr const char* too_long = "too long";

}  // namespace traverse::base
