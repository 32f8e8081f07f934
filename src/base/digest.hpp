// A short number that tells texts, or rows of numbers, apart (FNV-1a of 64 bits). It tells what has been damaged, not
// what somebody has changed on purpose.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace traverse::base {

class Digest {
 public:
  Digest() = default;
  /// To go on from the value of another.
  explicit Digest(std::uint64_t value) : value_(value) {}
  void add(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  /// By whole numbers: another digest than that of their bytes, in an eighth of the time. The product carries nothing
  /// downwards: without the shift, two changed signs would cancel.
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
