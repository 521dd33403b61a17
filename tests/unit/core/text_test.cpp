#include <gtest/gtest.h>

#include <spindrift/core/text.h>

namespace spindrift::core {
namespace {

using namespace std::string_literals;

TEST(QuoteText, ShowsWhatCannotBeSeen) {
  EXPECT_EQ(quoteText("0 0.5", 60), "0 0.5");
  EXPECT_EQ(quoteText("\xEF\xBB\xBF"
                      "0\t0.5\r\n",
                      60),
            "\\u{FEFF}0\\t0.5\\r\\n");
  EXPECT_EQ(quoteText("0\xC2\xA0"
                      "0",
                      60),
            "0\\u{A0}0")
      << "a space of a web page";
  EXPECT_EQ(quoteText("a\0b\x7F"s, 60), "a\\u{00}b\\u{7F}");
  EXPECT_EQ(quoteText("a\xE2\x80\x8B"
                      "b",
                      60),
            "a\\u{200B}b")
      << "zero width space";
  EXPECT_EQ(quoteText("\xFF\xFE"
                      "0",
                      60),
            "\\xFF\\xFE0")
      << "bytes that are not UTF-8";
  EXPECT_EQ(quoteText("Höhe 波", 60), "Höhe 波") << "visible characters stay";
}

TEST(QuoteText, IsCutBeforeACharacterThatDoesNotFit) {
  EXPECT_EQ(quoteText("abc", 2), "ab");
  EXPECT_EQ(quoteText("a\xC2\xA0", 6), "a");
  EXPECT_EQ(quoteText("a\xC2\xA0", 7), "a\\u{A0}");
  EXPECT_EQ(quoteText("波波", 5), "波");
}

}  // namespace
}  // namespace spindrift::core
