// Texts that users name: their encodings, and names that the system would cut.
#include <gmock/gmock.h>

#include <spindrift/core/files.h>

#include "temporary_folder.h"

namespace spindrift::core {
namespace {

using namespace std::string_literals;
using testing::AllOf;
using testing::HasSubstr;

class Texts : public testing::Test {
 protected:
  Result<std::string> read(const std::string& bytes) const {
    folder_.write("file.txt", bytes);
    return readText(folder_.path() / "file.txt", 100, "a text", "shorten it");
  }
  std::string refusalOf(const std::string& bytes) const {
    const auto text = read(bytes);
    return text ? "(read)" : text.error().message;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Texts, ByteOrderMarkIsRemovedAtTheStartOnly) {
  EXPECT_EQ(*read("\xEF\xBB\xBFplayer"), "player");
  EXPECT_EQ(*read("\xEF\xBB\xBF"), "");
  EXPECT_EQ(*read("a\xEF\xBB\xBF"), "a\xEF\xBB\xBF");
  EXPECT_EQ(*read("\xEF\xBB"), "\xEF\xBB");
  EXPECT_EQ(*read("a"), "a");
  EXPECT_EQ(*read(""), "");
}

TEST_F(Texts, Utf16AndUtf32AreRefusedWithARemedy) {
  EXPECT_THAT(refusalOf("\xFF\xFE"s + "a\0"s),
              AllOf(HasSubstr("is UTF-16 text; save it as UTF-8"), HasSubstr("iconv -f UTF-16 -t UTF-8")));
  EXPECT_THAT(refusalOf("\xFE\xFF"s + "\0a"s), HasSubstr("is UTF-16 text"));
  EXPECT_THAT(refusalOf("a\0b\0"s), HasSubstr("is UTF-16 text")) << "without a mark";
  EXPECT_THAT(refusalOf("\0a\0b"s), HasSubstr("is UTF-16 text"));
  EXPECT_THAT(refusalOf("\xFF\xFE\0\0a\0\0\0"s), HasSubstr("is UTF-32 text"));
  EXPECT_THAT(refusalOf("\0\0\xFE\xFF\0\0\0a"s), HasSubstr("is UTF-32 text"));
  EXPECT_EQ(*read("a\0bc"s), "a\0bc"s) << "its reader names the place of a zero byte";
}

TEST_F(Texts, NameWithAZeroByteIsRefused) {
  folder_.write("file.txt", "text");
  const auto text = readText((folder_.path() / "file.txt").string() + "\0.png"s, 100, "a text", "shorten it");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(text.error().message, HasSubstr("has a zero byte in its name"));
}

}  // namespace
}  // namespace spindrift::core
