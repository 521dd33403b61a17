#include <gmock/gmock.h>

#include <spindrift/access/room_token.h>

namespace spindrift::access {
namespace {

TEST(RoomTokens, AreFoundByTheirDigestsOnly) {
  const NewRoomToken player = makeRoomToken(core::Role::kPlayer);
  const NewRoomToken chief = makeRoomToken(core::Role::kOperator);
  const std::vector<RoomToken> kept{player.kept, chief.kept};
  EXPECT_EQ(findRoomToken(player.token, kept), 0U);
  EXPECT_EQ(findRoomToken(chief.token, kept), 1U);
  EXPECT_EQ(findRoomToken("", kept), std::nullopt);
  EXPECT_EQ(findRoomToken(player.token + "x", kept), std::nullopt);
  EXPECT_EQ(findRoomToken(player.token, {}), std::nullopt);
}

TEST(RoomTokens, AreLongAndNeverTheSame) {
  const NewRoomToken one = makeRoomToken(core::Role::kViewer);
  const NewRoomToken other = makeRoomToken(core::Role::kViewer);
  EXPECT_EQ(one.token.size(), 43U);
  EXPECT_NE(one.token, other.token);
  EXPECT_NE(one.kept.salt, other.kept.salt);
}

TEST(Digests, AreThoseOfTheStandards) {
  const auto hex = [](const Digest& digest) {
    std::string out;
    for (const unsigned byte : digest) {
      out += "0123456789abcdef"[byte >> 4];
      out += "0123456789abcdef"[byte & 15];
    }
    return out;
  };
  EXPECT_EQ(hex(digestOf("a", "bc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-2
  EXPECT_EQ(hex(hmacOf("Jefe", "what do ya want for nothing?")),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");  // RFC 4231
  EXPECT_TRUE(isEqual(digestOf("a"), digestOf("", "a")));
  EXPECT_FALSE(isEqual(digestOf("a"), digestOf("b")));
}

}  // namespace
}  // namespace spindrift::access
