// Lists of ranges: structure/ranges.hpp.
#include "structure/ranges.hpp"

#include <gtest/gtest.h>

namespace traverse::structure {
namespace {

using Ranges = std::vector<Range>;

Ranges merged(Ranges ranges) {
  merge(ranges);
  return ranges;
}
Ranges without(const Ranges& all, const Ranges& some) {
  Ranges rest;
  subtract(all, some, rest);
  return rest;
}

TEST(Ranges, ThatOverlapOrTouchBecomeOne) {
  EXPECT_EQ(merged({{5, 8}, {0, 2}, {2, 3}, {7, 9}, {4, 4}}), (Ranges{{0, 3}, {5, 9}}));
  EXPECT_EQ(merged({}), Ranges{});
}

TEST(Ranges, WithoutOthers) {
  EXPECT_EQ(without({{0, 10}, {20, 30}}, {{2, 4}, {8, 22}}), (Ranges{{0, 2}, {4, 8}, {22, 30}}));
  EXPECT_EQ(without({{0, 10}}, {{0, 10}}), Ranges{});
  EXPECT_EQ(without({{0, 10}}, {}), (Ranges{{0, 10}}));
  EXPECT_EQ(without({{3, 5}}, {{0, 10}}), Ranges{});
}

}  // namespace
}  // namespace traverse::structure
