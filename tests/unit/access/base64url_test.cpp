#include <gmock/gmock.h>

#include <spindrift/access/base64url.h>

namespace spindrift::access {
namespace {

TEST(Base64Url, ReadsAndWritesTheExamplesOfTheStandard) {  // RFC 4648 section 10, without padding
  const std::pair<const char*, const char*> examples[] = {
      {"", ""},           {"f", "Zg"},          {"fo", "Zm8"},         {"foo", "Zm9v"},
      {"foob", "Zm9vYg"}, {"fooba", "Zm9vYmE"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) {
    EXPECT_EQ(toBase64Url(bytes), text);
    EXPECT_EQ(fromBase64Url(text), bytes);
  }
}

TEST(Base64Url, EveryByteComesBack) {
  std::string bytes;
  for (int k = 0; k < 256; ++k) bytes.push_back(static_cast<char>(k));
  EXPECT_EQ(fromBase64Url(toBase64Url(bytes)), bytes);
  EXPECT_EQ(toBase64Url("\xFB\xFF"), "-_8");
}

TEST(Base64Url, RefusesEverythingElse) {
  for (const char* text : {"A", "Zg==", "Zm9v YmFy", "Zm+v", "Zm/v", "Zm9v\n", "Zm9vA"})
    EXPECT_FALSE(fromBase64Url(text)) << text;
}

TEST(Base64Url, RefusesASecondEncodingOfTheSameBytes) {
  EXPECT_FALSE(fromBase64Url("Zh"));
  EXPECT_FALSE(fromBase64Url("Zm9"));
}

}  // namespace
}  // namespace spindrift::access
