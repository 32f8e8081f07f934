// A 64-bit hash (FNV-1a) that distinguishes texts or rows of numbers. It detects accidental damage, not deliberate
// changes.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace traverse::base {

class Digest {
 public:
  Digest() = default;
  /// Continues from the value of another digest.
  explicit Digest(std::uint64_t value) : value_(value) {}
  void add(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  /// Adds whole numbers instead of single bytes. The digest differs from the digest of the bytes and needs an eighth of
  /// the time. A product changes higher bits only: without the shift, two changed signs would cancel.
  void add(std::span<const double> numbers) {
    for (const double number : numbers) {
      value_ = (value_ ^ std::bit_cast<std::uint64_t>(number)) * 1099511628211U;
      value_ ^= value_ >> 29;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

}  // namespace traverse::base
