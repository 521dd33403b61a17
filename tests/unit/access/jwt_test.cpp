#include <gmock/gmock.h>

#include <spindrift/access/access.h>

#include "jwt_maker.h"

namespace spindrift::access {
namespace {

using core::Role;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::int64_t kNow_s = 1'800'000'000;
const std::chrono::system_clock::time_point kIssuedNow{std::chrono::seconds(kNow_s)};

std::string claims(const std::string& more = "", std::int64_t expires_s = kNow_s + 3600) {
  return R"({"role":"player","exp":)" + std::to_string(expires_s) + more + "}";
}

JwtKey secretKey(const std::string& id = "", const std::string& secret = test::kJwtSecret) {
  return {.algorithm = JwtAlgorithm::kHs256, .id = id, .secret = secret};
}

core::Result<Grant> verified(const std::string& token, const JwtRules& rules = {}) {
  return verifyJwt(token, {secretKey()}, rules, kIssuedNow);
}

std::string refusalOf(const core::Result<Grant>& grant) {
  return grant ? "(accepted)" : grant.error().message;
}

struct Pair {
  test::KeyPair own;
  JwtKey server;
};

Pair pairOf(test::KeyPair key) {
  auto parsed = parsePublicKey(test::pemOf(key), "key");
  EXPECT_TRUE(parsed) << parsed.error().message;
  return {std::move(key), *std::move(parsed)};
}

// Signatures

TEST(Jwt, TokensOfAllThreeAlgorithmsAreAccepted) {
  const Pair rsa = pairOf(test::makeRsaKey());
  const Pair ed = pairOf(test::makeEd25519Key());
  const std::vector<JwtKey> keys{secretKey(), rsa.server, ed.server};
  for (const std::string& token : {test::hs256(claims()), test::signedToken(R"({"alg":"RS256"})", claims(), rsa.own),
                                   test::signedToken(R"({"alg":"EdDSA"})", claims(), ed.own)}) {
    const auto grant = verifyJwt(token, keys, {}, kIssuedNow);
    ASSERT_TRUE(grant) << grant.error().message;
    EXPECT_EQ(grant->role, Role::kPlayer);
  }
}

TEST(Jwt, SignaturesOfTheStandardsExamplesFit) {
  // RFC 7515 appendix A.1; its claims lack a role.
  const auto secret =
      fromBase64Url("AyM1SysPpbyDfgZld3umj1qzKObwVMkoqQ-EstJQLr_T-1qS0gZH75aKtMN3Yj0iPS4hcgUuTwjAzZr1Z9CAow");
  ASSERT_TRUE(secret);
  const std::string joe =
      "eyJ0eXAiOiJKV1QiLA0KICJhbGciOiJIUzI1NiJ9.eyJpc3MiOiJqb2UiLA0KICJleHAiOjEzMDA4MTkzODAsDQogImh0dHA6Ly9leGFtcGxlLmN"
      "vbS9pc19yb290Ijp0cnVlfQ.dBjftJeZ4CVP-mB92K27uhbUJU1p1r_wW1gFWFOEjXk";
  const std::chrono::system_clock::time_point then{std::chrono::seconds(1'300'819'000)};
  EXPECT_THAT(refusalOf(verifyJwt(joe, {secretKey("", *secret)}, {.issuer = "joe"}, then)), HasSubstr("role"));
  // RFC 8037 appendix A.4; its text is not JSON.
  auto key = parseKeySet(
      R"({"keys":[{"kty":"OKP","crv":"Ed25519","x":"11qYAYKxCrfVS_7TyWQHOg7hcvPapiMlrwIaaPcHURo"}]})", "keys");
  ASSERT_TRUE(key);
  const std::string example =
      "eyJhbGciOiJFZERTQSJ9.RXhhbXBsZSBvZiBFZDI1NTE5IHNpZ25pbmc.hgyY0il_MGCjP0JzlnLWG1PPOt7-"
      "09PGcvMg3AIbQR6dWbhijcNR4ki4i"
      "ylGjg5BhVsPt9g7sVvpAr_MuM0KAg";
  EXPECT_THAT(refusalOf(verifyJwt(example, *key, {}, kIssuedNow)), HasSubstr("claims"));
}

TEST(Jwt, TokensOfAnotherKeyAreRefused) {
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(), std::string(32, 'x')))), HasSubstr("signature does not fit"));
  const Pair ed = pairOf(test::makeEd25519Key());
  EXPECT_THAT(refusalOf(verifyJwt(test::signedToken(R"({"alg":"EdDSA"})", claims(), test::makeEd25519Key()),
                                  {ed.server}, {}, kIssuedNow)),
              HasSubstr("signature does not fit"));
}

TEST(Jwt, AChangeOfAnyCharacterIsRefused) {
  const std::string token = test::hs256(claims(R"(,"sub":"ada")"));
  ASSERT_TRUE(verified(token));
  for (std::size_t k = 0; k < token.size(); ++k) {
    for (const char c : {'A', 'z', '.', '='}) {
      if (token[k] == c) continue;
      std::string changed = token;
      changed[k] = c;
      EXPECT_FALSE(verified(changed)) << k;
    }
  }
  for (std::size_t k = 0; k < token.size(); ++k) EXPECT_FALSE(verified(token.substr(0, k))) << k;
}

TEST(Jwt, TheTokenCannotChooseNoSignature) {
  for (const char* header : {R"({"alg":"none"})", R"({"alg":"None"})", R"({"alg":""})", R"({"alg":null})", "{}"}) {
    EXPECT_FALSE(verified(test::unsignedToken(header, claims()) + ".")) << header;
    EXPECT_FALSE(verified(test::hmacToken(header, claims(), ""))) << header;
    EXPECT_FALSE(verified(test::hmacToken(header, claims(), test::kJwtSecret))) << header;
  }
}

TEST(Jwt, APublicKeyIsNeverUsedAsASecret) {
  for (const Pair& pair : {pairOf(test::makeRsaKey()), pairOf(test::makeEd25519Key())}) {
    const std::string token = test::hs256(claims(), test::pemOf(pair.own));
    EXPECT_THAT(refusalOf(verifyJwt(token, {pair.server}, {}, kIssuedNow)),
                HasSubstr("no key of this server is for the alg"));
  }
}

TEST(Jwt, KidChoosesAmongKeys) {
  const auto with = [](const std::string& id) {
    return test::hmacToken(R"({"alg":"HS256","kid":")" + id + "\"}", claims(), test::kJwtSecret);
  };
  EXPECT_TRUE(verifyJwt(with("b"), {secretKey("a", std::string(32, 'x')), secretKey("b")}, {}, kIssuedNow));
  EXPECT_THAT(refusalOf(verifyJwt(with("c"), {secretKey("b")}, {}, kIssuedNow)), HasSubstr("kid"));
  EXPECT_TRUE(verifyJwt(with("c"), {secretKey()}, {}, kIssuedNow));
  EXPECT_TRUE(verifyJwt(test::hs256(claims()), {secretKey("a", std::string(32, 'x')), secretKey("b")}, {}, kIssuedNow));
}

TEST(Jwt, ExtensionsThatHaveToBeUnderstoodAreRefused) {
  EXPECT_THAT(
      refusalOf(verified(test::hmacToken(R"({"alg":"HS256","crit":["b64"],"b64":false})", claims(), test::kJwtSecret))),
      HasSubstr("crit"));
}

// Claims

TEST(Jwt, GivesRoleRoomsPersonNameAndEnd) {
  const auto grant = verified(test::hs256(claims(R"(,"sub":"ada@example.org","name":"Ada","room":["main","lab"])")));
  ASSERT_TRUE(grant) << grant.error().message;
  EXPECT_EQ(grant->role, Role::kPlayer);
  EXPECT_EQ(grant->subject, "ada@example.org");
  EXPECT_TRUE(grant->is_person);
  EXPECT_EQ(grant->name, "Ada");
  EXPECT_THAT(*grant->rooms, ElementsAre("main", "lab"));
  EXPECT_TRUE(grant->allows("lab"));
  EXPECT_FALSE(grant->allows("other"));
  EXPECT_EQ(grant->expires, kIssuedNow + std::chrono::hours(1) + kJwtLeeway);
}

TEST(Jwt, MissingRoomMeansAllRooms) {
  const auto grant = verified(test::hs256(claims()));
  ASSERT_TRUE(grant);
  EXPECT_TRUE(grant->allows("anything"));
  EXPECT_FALSE(grant->is_person);
  EXPECT_THAT(*verified(test::hs256(claims(R"(,"room":"main")")))->rooms, ElementsAre("main"));
}

TEST(Jwt, ExpiresWithALeeway) {
  EXPECT_TRUE(verified(test::hs256(claims("", kNow_s - 29))));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims("", kNow_s - 30)))), HasSubstr("expired"));
  EXPECT_THAT(refusalOf(verified(test::hs256(R"({"role":"player"})"))), HasSubstr("exp is missing"));
}

TEST(Jwt, FutureTimesAreRefusedBeyondTheLeeway) {
  for (const char* claim : {"nbf", "iat"}) {
    const auto at = [&](std::int64_t time_s) {
      return verified(test::hs256(claims(",\"" + std::string(claim) + "\":" + std::to_string(time_s))));
    };
    EXPECT_TRUE(at(kNow_s + 30));
    EXPECT_THAT(refusalOf(at(kNow_s + 31)), HasSubstr(claim));
  }
}

TEST(Jwt, TimesAreNumbersInRange) {
  EXPECT_TRUE(verified(test::hs256(R"({"role":"viewer","exp":1.8000000005e9})")));
  for (const char* time :
       {"\"1800003600\"", "-1", "7258118401", "1e300", "18446744073709551615", "true", "null", "[]"}) {
    EXPECT_FALSE(verified(test::hs256(R"({"role":"viewer","exp":)" + std::string(time) + "}"))) << time;
  }
}

TEST(Jwt, IssuerAndAudienceAreCheckedIfConfigured) {
  const JwtRules rules{.issuer = "https://id.example.org", .audience = "spindrift"};
  const std::string right = R"(,"iss":"https://id.example.org","aud":["other","spindrift"])";
  EXPECT_TRUE(verified(test::hs256(claims(right)), rules));
  EXPECT_TRUE(verified(test::hs256(claims(R"(,"iss":"https://id.example.org","aud":"spindrift")")), rules));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"aud":"spindrift")")), rules)), HasSubstr("iss"));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"iss":"https://id.example.org","aud":"other")")), rules)),
              HasSubstr("aud"));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"iss":"https://id.example.org")")), rules)), HasSubstr("aud"));
}

TEST(Jwt, ClaimsOfAnotherFormAreRefusedByName) {
  const auto refusal = [](const std::string& more) { return refusalOf(verified(test::hs256(claims(more)))); };
  EXPECT_THAT(refusal(R"(,"sub":5)"), HasSubstr("sub is not text"));
  EXPECT_THAT(refusal(R"(,"name":[])"), HasSubstr("name is not text"));
  EXPECT_THAT(refusal(R"(,"sub":")" + std::string(129, 'a') + "\""), HasSubstr("at most 128"));
  EXPECT_THAT(refusal(R"(,"room":[])"), HasSubstr("room is an empty list"));
  EXPECT_THAT(refusal(R"(,"room":["main","a room"])"), HasSubstr("room has an entry that is not a name of a room"));
  EXPECT_THAT(refusal(R"(,"room":[5])"), HasSubstr("room"));
  EXPECT_THAT(refusal(R"(,"room":"")"), HasSubstr("room"));
  EXPECT_THAT(refusal(R"(,"room":")" + std::string(33, 'a') + "\""), HasSubstr("room"));
  std::string rooms;
  for (int k = 0; k < 65; ++k) rooms += (k == 0 ? "\"a\"" : ",\"a\"");
  EXPECT_THAT(refusal(R"(,"room":[)" + rooms + "]"), HasSubstr("65 entries; at most 64"));
  EXPECT_THAT(refusalOf(verified(test::hs256(R"({"role":"king","exp":1800003600})"))), HasSubstr("role"));
  EXPECT_THAT(refusalOf(verified(test::hs256(R"({"role":2,"exp":1800003600})"))), HasSubstr("role"));
}

TEST(Jwt, TextThatIsNotATokenIsRefused) {
  for (const std::string& text : {std::string(), std::string("a"), std::string("a.b"), std::string("a.b.c.d"),
                                  std::string("..."), std::string(".."), std::string("a.b.c"), std::string("a..c")}) {
    EXPECT_FALSE(verified(text)) << text;
  }
  EXPECT_FALSE(verified(test::hs256("[]")));
  EXPECT_FALSE(verified(test::hs256(std::string(100, '[') + std::string(100, ']'))));
  EXPECT_FALSE(verified(test::hs256("{\"role\":\"player\",\"exp\":1800003600,\"name\":\"\xFF\"}")));
}

TEST(Jwt, TheSameNameTwiceIsRefused) {
  const std::string twice = "the same name twice";
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"role":"operator")")))), HasSubstr(twice));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"rol\u0065":"operator")")))), HasSubstr(twice)) << "escaped";
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"more":[{"a":1,"a":1}])")))), HasSubstr(twice)) << "inside";
  EXPECT_THAT(refusalOf(verified(test::hmacToken(R"({"alg":"HS256","alg":"HS256"})", claims(), test::kJwtSecret))),
              HasSubstr("its header cannot be used: it is JSON with the same name twice"));
  EXPECT_TRUE(verified(test::hs256(claims(R"(,"name":"a \" : b","more":{"exp":1,"list":[{"exp":1},{"exp":1}]})"))))
      << "one of each in an object";
}

TEST(Jwt, TokensOverTheLimitAreRefused) {
  EXPECT_TRUE(verified(test::hs256(claims(R"(,"more":")" + std::string(2000, 'a') + "\""))));
  EXPECT_THAT(refusalOf(verified(test::hs256(claims(R"(,"more":")" + std::string(8000, 'a') + "\"")))),
              HasSubstr("8192 bytes"));
}

TEST(Jwt, RefusalsNeverRepeatTheToken) {
  const char* const kMark = "MARKMARKMARK";
  for (const std::string& token :
       {test::hs256(claims(",\"iss\":\"" + std::string(kMark) + "\"")),
        test::hs256(R"({"role":"MARKMARKMARK","exp":1})"),
        test::hmacToken(R"({"alg":"MARKMARKMARK"})", claims(), test::kJwtSecret),
        test::hmacToken(R"({"alg":"HS256","kid":"MARKMARKMARK"})", claims(), std::string(32, 'x'))}) {
    const auto grant = verifyJwt(token, {secretKey("a")}, {.issuer = "x"}, kIssuedNow);
    ASSERT_FALSE(grant);
    EXPECT_THAT(grant.error().message, Not(HasSubstr(kMark)));
  }
}

// Beside the token file

TEST(Jwt, StandBesideTheTokensOfTheFile) {
  auto access = Access::parse("operator aaaaaaaaaaaaaaaa", "tokens", std::nullopt);
  ASSERT_TRUE(access);
  const std::string token = test::hs256(claims(R"(,"room":"lab")"));
  EXPECT_THAT(refusalOf(access->resolve(token, kIssuedNow)), HasSubstr("does not know that token"));
  access->acceptJwts({secretKey()}, {});
  EXPECT_EQ(access->resolve("aaaaaaaaaaaaaaaa", kIssuedNow)->role, Role::kOperator);
  const auto grant = access->resolve(token, kIssuedNow);
  EXPECT_EQ(grant->role, Role::kPlayer);
  EXPECT_TRUE(grant->allows("lab"));
  EXPECT_FALSE(grant->allows("main"));
  EXPECT_THAT(refusalOf(access->resolve("bbbbbbbbbbbbbbbb", kIssuedNow)), HasSubstr("does not know that token"));
}

}  // namespace
}  // namespace spindrift::access
