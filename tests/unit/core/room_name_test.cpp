#include <string>

#include <gtest/gtest.h>

#include <spindrift/core/room_name.h>

namespace spindrift::core {
namespace {

TEST(RoomName, LettersDigitsUnderscoresAndHyphensAreTaken) {
  for (const char* name : {"main", "Quay_2", "a-b", "0", "-"}) EXPECT_TRUE(isRoomName(name)) << name;
  EXPECT_TRUE(isRoomName(std::string(32, 'x')));
}

TEST(RoomName, EverythingElseIsRefused) {
  for (const std::string& name :
       {std::string(), std::string(33, 'x'), std::string("quay (copy)"), std::string("q\"} 1"), std::string("a\nb"),
        std::string("a/b"), std::string(".."), std::string("a\0b", 3), std::string("é"), std::string("a.b")})
    EXPECT_FALSE(isRoomName(name)) << name;
}

}  // namespace
}  // namespace spindrift::core
