// Random numbers of a named stream: number i of a stream is independent of all other draws.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace traverse::base {

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name) : key_(mixed(seed)) {
    for (const char c : name) key_ = mixed(key_ ^ static_cast<unsigned char>(c));
  }

  /// Number i, uniform between 0 and 1, both excluded.
  double uniform(std::uint64_t i) const { return (static_cast<double>(word(i) >> 12) + 0.5) * 0x1.0p-52; }
  /// Number i, normal with mean 0 and standard deviation 1, by the method of Box and Muller.
  double normal(std::uint64_t i) const {
    return std::sqrt(-2.0 * std::log(uniform(2 * i))) * std::cos(2.0 * std::numbers::pi * uniform(2 * i + 1));
  }

 private:
  /// SplitMix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators (2014).
  static std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::uint64_t word(std::uint64_t i) const { return mixed(key_ + i * 0x9e3779b97f4a7c15U); }

  std::uint64_t key_;
};

}  // namespace traverse::base
