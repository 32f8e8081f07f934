// The version of Traverse. doc/stability.md describes what its three numbers promise.
#pragma once

#include <string_view>

namespace traverse {

/// The version of this library: "1.0.0".
const char* version() noexcept;

/// Whether a version has a greater first number than this one, so that its files may have another layout.
bool is_newer_major(std::string_view other) noexcept;

}  // namespace traverse
