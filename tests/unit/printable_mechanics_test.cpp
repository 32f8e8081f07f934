// What the user wrote, on one line of valid UTF-8.
#include <gtest/gtest.h>

#include "traverse/base/error.hpp"

namespace traverse {
namespace {

TEST(Printable, PlainTextStays) {
  for (const char* text : {"", "beam_EI = 1e9", "Brücke 橋 \xf0\x9f\x9a\x86", "\"quoted\" \\n"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersAreSpelt) {
  EXPECT_EQ(printable("a\nb\tc\r"), "a\\nb\\tc\\x0d");
  EXPECT_EQ(printable(std::string_view("\x1b[31m\0\x7f", 7)), "\\x1b[31m\\x00\\x7f");
}

TEST(Printable, BytesThatAreNoUtf8AreSpelt) {
  EXPECT_EQ(printable("f\xfcr"), "f\\xfcr");                         // Latin-1
  EXPECT_EQ(printable("\xc3"), "\\xc3");                             // cut short
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // longer than needed
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");           // the same
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
}

TEST(Printable, MessagesAreOneLine) {
  EXPECT_STREQ(InputError("beam_EI = 1\n2: no number").what(), "beam_EI = 1\\n2: no number");
}

}  // namespace
}  // namespace traverse
