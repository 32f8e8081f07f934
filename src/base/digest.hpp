// A short number that tells texts apart (FNV-1a of 64 bits).
#pragma once

#include <cstdint>
#include <string_view>

namespace traverse::base {

class Digest {
 public:
  void add(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

}  // namespace traverse::base
