#include "constrictor/text.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

TEST(Text, PrintableKeepsTextOfEveryLanguage) {
  for (const char* text : {"", "plain ASCII ~", "M\xc3\xbcnchen", "\xe8\x9b\x87", "\xf0\x9f\x90\x8d", "\xc2\xa0"})
    EXPECT_EQ(printable(text), text);
}

// Sources: ECMA-48 (C0, C1: CSI is U+009B), RFC 3629 (UTF-8).
TEST(Text, PrintableReplacesWhatCouldControlATerminal) {
  EXPECT_EQ(printable("\x1b[2J"), "?[2J");
  EXPECT_EQ(printable("a\rb\nc\td\x7f"), "a?b?c?d?");
  EXPECT_EQ(printable("a\rb\nc\td", "\n\t"), "a?b\nc\td");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "??31m")
      << "CSI as one character";
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "?31m")
      << "CSI of an 8-bit terminal";
  EXPECT_EQ(printable("\xff\xfe"), "??");
  EXPECT_EQ(printable("\xc3"), "?") << "cut in the middle of a character";
  EXPECT_EQ(printable("\xe0\x82\x9b"), "???") << "an overlong form of CSI";
  EXPECT_EQ(printable("\xed\xa0\x80"), "???") << "a surrogate";
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
}

}  // namespace
}  // namespace constrictor
