// Records numbers of a test in its report and prints them.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>

#include "support/curve.hpp"

namespace traverse::test {

inline void record(const char* what, double value) {
  testing::Test::RecordProperty(what, text(value));
  std::printf("  %s %.3g\n", what, value);
}

}  // namespace traverse::test
