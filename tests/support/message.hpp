// Messages of refused input.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "traverse/base/error.hpp"

namespace traverse::test {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
inline bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, part); });
}

/// The message of the InputError that `action` must throw: one line, exit status 2.
inline std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(error.status(), 2);
    EXPECT_FALSE(contains(error.what(), "\n")) << "a message is one line: " << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

}  // namespace traverse::test
