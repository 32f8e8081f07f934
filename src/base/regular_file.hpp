// Reads a regular file; pipes (which wait), devices (which have no end) and folders are rejected.
#pragma once

#include <cstddef>
#include <string>

namespace traverse::base {

/// Fills `bytes` and returns an empty text; on failure returns the reason in words: "is a folder, not a file", "the
/// file cannot be read: Input/output error", or `too_long` for a file of more than `most` bytes.
std::string read_regular_file(const std::string& path, std::size_t most, std::string& bytes);
inline constexpr const char* too_long = "too long";

}  // namespace traverse::base
