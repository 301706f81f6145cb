// SPDX-License-Identifier: BSD-3-Clause
// Texts from files, as terminals may be given them.
#include "core/printable.hpp"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

TEST(Printable, LeavesTextAlone) {
  for (const std::string text : {"", "a line\n\tand another", "µm, Ω, \U0001FAC0, \uFFFD", "C:\\x"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatSteersTerminals) {
  EXPECT_EQ(printable("\x1b[31mred\r\b\x7f"), "\\x1b[31mred\\x0d\\x08\\x7f");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // CSI as one character
}

TEST(Printable, EscapesWhatIsNotUtf8) {
  EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(printable("\xc3"), "\\xc3");           // cut short
  EXPECT_EQ(printable("\xc3("), "\\xc3(");         // no second byte
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");  // longer than need be
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a UTF-16 pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Printable, CutsTheMiddleOfWhatIsLong) {
  const std::string text = printable("begin" + std::string(100000, 'x') + "end", 1000);
  EXPECT_LE(text.size(), 1005U);
  EXPECT_TRUE(text.starts_with("begin") && text.ends_with("end"));
  std::string characters;
  for (int i = 0; i < 100; ++i) characters += "é";
  for (std::size_t longest = 10; longest < 20; ++longest) {
    const std::string cut = printable(characters, longest);
    EXPECT_EQ(printable(cut), cut);  // no half of a character
  }
}

}  // namespace
}  // namespace rhexis
