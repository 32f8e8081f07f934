// A digest of numbers changes with every bit and sign, and continues from an earlier value.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "base/digest.hpp"

namespace traverse::base {
namespace {

std::uint64_t digest_of(const std::vector<double>& numbers) {
  Digest digest;
  digest.add(numbers);
  return digest.value();
}

TEST(Digest, TellsAnyBitOfAnyNumber) {
  const std::vector<double> numbers = {0.0, 1.0, -2.5, 1e300};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (int bit = 0; bit < 64; ++bit) {
      std::vector<double> changed = numbers;
      changed[i] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(changed[i]) ^ (std::uint64_t{1} << bit));
      EXPECT_NE(digest_of(changed), digest_of(numbers)) << i << " " << bit;
    }
  }
}

TEST(Digest, TellsTwoChangedSigns) { EXPECT_NE(digest_of({-1.0, -2.0, 3.0}), digest_of({1.0, 2.0, 3.0})); }

TEST(Digest, GoesOnWhereAnotherEnded) {
  Digest first;
  first.add(std::vector<double>{1.0, 2.0});
  Digest rest(first.value());
  rest.add(std::vector<double>{3.0});
  EXPECT_EQ(rest.value(), digest_of({1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace traverse::base
