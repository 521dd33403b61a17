#include <gmock/gmock.h>

#include <spindrift/access/access.h>

namespace spindrift::access {
namespace {

using core::Role;
using testing::HasSubstr;
using testing::Not;

const std::chrono::system_clock::time_point kNow = std::chrono::sys_days(std::chrono::year(2026) / 11 / 21);

Access parsed(const std::string& text, std::optional<Role> guest = Role::kViewer) {
  auto access = Access::parse(text, "tokens", guest);
  EXPECT_TRUE(access) << access.error().message;
  return access ? *std::move(access) : Access();
}

std::string refusal(const std::string& text) {
  const auto access = Access::parse(text, "tokens", std::nullopt);
  return access ? "(accepted)" : access.error().message;
}

TEST(Access, EmptyAccessMakesEveryClientAnOperator) {
  const auto grant = Access().resolve("", kNow);
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->role, Role::kOperator);
}

TEST(Access, TokensGiveTheirRoles) {
  const Access access =
      parsed("# people\noperator aaaaaaaaaaaaaaaa\n\n  player bbbbbbbbbbbbbbbb # the class\nviewer cccccccccccccccc");
  EXPECT_EQ(access.tokenCount(), 3U);
  EXPECT_EQ(access.resolve("aaaaaaaaaaaaaaaa", kNow)->role, Role::kOperator);
  EXPECT_EQ(access.resolve("bbbbbbbbbbbbbbbb", kNow)->role, Role::kPlayer);
  EXPECT_EQ(access.resolve("cccccccccccccccc", kNow)->role, Role::kViewer);
  EXPECT_EQ(access.resolve("", kNow)->role, Role::kViewer);
}

TEST(Access, UnknownTokensGiveNothingAndAreNotRepeated) {
  const Access access = parsed("operator aaaaaaaaaaaaaaaa", Role::kOperator);
  for (const char* wrong : {"aaaaaaaaaaaaaaab", "aaaaaaaaaaaaaaa", "aaaaaaaaaaaaaaaaa", "x"}) {
    const auto grant = access.resolve(wrong, kNow);
    ASSERT_FALSE(grant) << wrong;
    EXPECT_THAT(grant.error().message, Not(HasSubstr("aaa")));
  }
}

TEST(Access, RefusesGuestsWhereConfigured) {
  const auto grant = parsed("operator aaaaaaaaaaaaaaaa", std::nullopt).resolve("", kNow);
  ASSERT_FALSE(grant);
  EXPECT_THAT(grant.error().message, HasSubstr("send a token"));
}

TEST(Access, TokensExpire) {
  const Access access = parsed("player aaaaaaaaaaaaaaaa until=2026-11-21T00:00:10Z");
  const auto grant = access.resolve("aaaaaaaaaaaaaaaa", kNow);
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->expires, kNow + std::chrono::seconds(10));
  const auto late = access.resolve("aaaaaaaaaaaaaaaa", kNow + std::chrono::seconds(10));
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, HasSubstr("expired"));
}

TEST(Access, BadLinesAreReportedWithoutTheirToken) {
  EXPECT_THAT(refusal("king aaaaaaaaaaaaaaaa"), HasSubstr("tokens:1:"));
  EXPECT_THAT(refusal("\noperator"), HasSubstr("tokens:2:"));
  EXPECT_THAT(refusal("operator short"), HasSubstr("at least 16"));
  EXPECT_THAT(refusal("operator secretsecretsecret for=ever"), HasSubstr("until="));
  EXPECT_THAT(refusal("operator secretsecretsecret until=2026-02-30T00:00:00Z"), HasSubstr("until="));
  EXPECT_THAT(refusal("operator secretsecretsecret until=9999-02-03T00:00:00Z"), HasSubstr("until="));
  EXPECT_THAT(refusal("operator secretsecretsecret until=1015-02-03T00:00:00Z"), HasSubstr("until="));
  EXPECT_THAT(refusal("operator secretsecretsecret until=2026-02-03T00:00:00Z more"), Not(HasSubstr("secretsecret")));
  EXPECT_THAT(refusal("operator secretsecretsecret\nviewer secretsecretsecret"), HasSubstr("earlier line"));
}

TEST(Access, ALineCanNameRoomsAPersonAndAnEnd) {
  const Access access = parsed(
      "operator aaaaaaaaaaaaaaaa room=lab,tank until=2026-11-22T00:00:00Z sub=ada\nplayer bbbbbbbbbbbbbbbb # the "
      "class");
  const auto grant = access.resolve("aaaaaaaaaaaaaaaa", kNow);
  ASSERT_TRUE(grant) << grant.error().message;
  EXPECT_EQ(grant->subject, "ada");
  EXPECT_TRUE(grant->is_person);
  EXPECT_TRUE(grant->expires);
  EXPECT_TRUE(grant->allows("tank"));
  EXPECT_FALSE(grant->allows("main"));
  EXPECT_THAT(otherRoom("main"), HasSubstr("not for room 'main'"));
  const auto shared = access.resolve("bbbbbbbbbbbbbbbb", kNow);
  ASSERT_TRUE(shared);
  EXPECT_TRUE(shared->allows("main"));
  EXPECT_EQ(shared->subject, "tokens:2") << "the audit log can name the line";
  EXPECT_FALSE(shared->is_person) << "several people may use it";
}

TEST(Access, InvalidOptionsAreReportedWithoutTheirText) {
  const auto with = [](const std::string& options) { return refusal("operator aaaaaaaaaaaaaaaa " + options); };
  for (const char* options : {"room=", "room=a,,b", "room=a,", "room=a room=b", "sub=", "sub=a sub=b",
                              "until=2026-11-22T00:00:00Z until=2026-11-22T00:00:00Z"}) {
    EXPECT_THAT(with(options), HasSubstr("tokens:1:")) << options;
  }
  EXPECT_THAT(with("room=" + std::string(33, 'a')), HasSubstr("1 to 32"));
  EXPECT_THAT(with("room=main,q\"}"), HasSubstr("1 to 32 letters, digits, '_' or '-'"))
      << "a name that no room can have";
  EXPECT_THAT(with("secret"), Not(HasSubstr("secret")));
}

TEST(Access, TokensOverTheLimitAreRefused) {
  const Access access = parsed("player aaaaaaaaaaaaaaaa");
  const auto grant = access.resolve(std::string(kTokenMaxBytes + 1, 'a'), kNow);
  ASSERT_FALSE(grant);
  EXPECT_THAT(grant.error().message, HasSubstr("8192"));
  EXPECT_THAT(refusal("player " + std::string(kTokenMaxBytes + 1, 'a')), HasSubstr("at most 8192"));
}

TEST(Access, ReadsABearerHeader) {
  EXPECT_EQ(*Access::bearerToken(""), "");
  EXPECT_EQ(*Access::bearerToken("Bearer abc"), "abc");
  EXPECT_FALSE(Access::bearerToken("Basic abc"));
  EXPECT_FALSE(Access::bearerToken("Bearer "));
}

}  // namespace
}  // namespace spindrift::access
