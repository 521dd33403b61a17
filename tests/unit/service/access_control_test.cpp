#include <gmock/gmock.h>

#include <spindrift/service/access_control.h>

namespace spindrift::service {
namespace {

using core::Role;
using testing::ElementsAre;
using testing::Optional;

const std::chrono::system_clock::time_point kNow = std::chrono::sys_days(std::chrono::year(2026) / 11 / 21);

AccessOptions optionsOf(const std::string& tokens) {
  auto access = access::Access::parse(tokens, "tokens", std::nullopt);
  EXPECT_TRUE(access) << access.error().message;
  return {.access = access ? *std::move(access) : access::Access()};
}

MadeTokens madeFor(std::initializer_list<v1::Role> roles) {
  v1::CreateRoom wanted;
  for (const v1::Role role : roles) wanted.add_tokens(role);
  auto made = makeTokens(wanted);
  EXPECT_TRUE(made) << made.error().message;
  return made ? *std::move(made) : MadeTokens();
}

TEST(AccessControl, FindsTokensOfRoomsByTheirDigestsOnly) {
  const AccessControl control(optionsOf("viewer aaaaaaaaaaaaaaaa"));
  const MadeTokens made = madeFor({v1::ROLE_PLAYER, v1::ROLE_OPERATOR});
  const std::string player = made.shown[0].token();
  const std::string chief = made.shown[1].token();
  const std::vector<RoomTokens> rooms{{"lab", made.kept}};
  EXPECT_EQ(control.resolve(player, rooms, kNow)->role, Role::kPlayer);
  const auto grant = control.resolve(chief, rooms, kNow);
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->role, Role::kOperator);
  EXPECT_EQ(grant->subject, "token 2 of room lab");
  EXPECT_FALSE(grant->is_person);
  EXPECT_THAT(grant->rooms, Optional(ElementsAre("lab")));
  EXPECT_FALSE(control.resolve("", rooms, kNow));
  EXPECT_FALSE(control.resolve(player + "x", rooms, kNow));
  EXPECT_FALSE(control.resolve(player, {}, kNow));
  EXPECT_EQ(control.resolve("aaaaaaaaaaaaaaaa", rooms, kNow)->role, Role::kViewer);
}

TEST(AccessControl, LeavesOutKeptTokensThatNoServerMade) {
  const AccessControl control(optionsOf(""));
  MadeTokens made = madeFor({v1::ROLE_PLAYER, v1::ROLE_PLAYER, v1::ROLE_PLAYER});
  made.kept.mutable_tokens(0)->set_digest("short");
  made.kept.mutable_tokens(1)->set_role(v1::ROLE_UNSPECIFIED);
  const std::vector<RoomTokens> rooms{{"lab", made.kept}};
  EXPECT_FALSE(control.resolve(made.shown[0].token(), rooms, kNow));
  EXPECT_FALSE(control.resolve(made.shown[1].token(), rooms, kNow));
  EXPECT_EQ(control.resolve(made.shown[2].token(), rooms, kNow)->subject, "token 1 of room lab");
}

TEST(AccessControl, MakesTokensThatAreLongAndNeverTheSame) {
  const MadeTokens made = madeFor({v1::ROLE_VIEWER, v1::ROLE_VIEWER});
  EXPECT_EQ(made.shown[0].token().size(), 43U);
  EXPECT_NE(made.shown[0].token(), made.shown[1].token());
  EXPECT_EQ(made.kept.tokens(0).salt().size(), 16U);
  EXPECT_NE(made.kept.tokens(0).salt(), made.kept.tokens(1).salt());
}

TEST(AccessControl, TakesOtherTokensWhileItIsUsed) {
  AccessControl control(optionsOf("player aaaaaaaaaaaaaaaa"));
  control.replace(optionsOf("player bbbbbbbbbbbbbbbb").access);
  EXPECT_FALSE(control.resolve("aaaaaaaaaaaaaaaa", {}, kNow));
  EXPECT_TRUE(control.resolve("bbbbbbbbbbbbbbbb", {}, kNow));
}

}  // namespace
}  // namespace spindrift::service
