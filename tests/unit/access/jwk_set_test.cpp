#include <gmock/gmock.h>

#include <spindrift/access/jwt.h>

#include "jwt_maker.h"

namespace spindrift::access {
namespace {

using testing::HasSubstr;

const std::string kSecret = test::kJwtSecret;

std::string octKey(const std::string& more = "", const std::string& secret = kSecret) {
  return R"({"kty":"oct","k":")" + toBase64Url(secret) + "\"" + more + "}";
}

std::string edKey(const test::KeyPair& key, const std::string& more = "") {
  return R"({"kty":"OKP","crv":"Ed25519","x":")" + toBase64Url(test::rawPublicKey(key)) + "\"" + more + "}";
}

std::string rsaKey(const test::KeyPair& key, const std::string& more = "") {
  const auto number = [&](const char* name) {
    BIGNUM* value = nullptr;
    EXPECT_EQ(EVP_PKEY_get_bn_param(key.get(), name, &value), 1);
    std::string bytes(static_cast<std::size_t>(BN_num_bytes(value)), '\0');
    BN_bn2bin(value, reinterpret_cast<unsigned char*>(bytes.data()));
    BN_free(value);
    return toBase64Url(bytes);
  };
  return R"({"kty":"RSA","n":")" + number("n") + R"(","e":")" + number("e") + "\"" + more + "}";
}

std::string set(const std::string& keys) {
  return R"({"keys":[)" + keys + "]}";
}

std::string refusalOf(const std::string& json) {
  const auto keys = parseKeySet(json, "keys.json");
  return keys ? "(accepted)" : keys.error().message;
}

TEST(JwkSet, GivesKeysWithTheirNumbersAndAlgorithms) {
  const auto keys = parseKeySet(set(octKey(R"(,"kid":"a")") + "," + rsaKey(test::makeRsaKey(), R"(,"alg":"RS256")") +
                                    "," + edKey(test::makeEd25519Key(), R"(,"kid":"c","use":"sig")")),
                                "keys");
  ASSERT_TRUE(keys) << keys.error().message;
  ASSERT_EQ(keys->size(), 3U);
  EXPECT_EQ((*keys)[0].id, "a");
  EXPECT_EQ((*keys)[0].secret, kSecret);
  EXPECT_EQ((*keys)[1].algorithm, JwtAlgorithm::kRs256);
  EXPECT_EQ((*keys)[1].id, "");
  EXPECT_EQ((*keys)[2].algorithm, JwtAlgorithm::kEdDsa);
}

TEST(JwkSet, LeavesOutKeysForOtherPurposes) {
  const std::string others = R"({"kty":"EC","crv":"P-256","x":"AA","y":"AA"},{"kty":"OKP","crv":"X25519","x":"AA"},)" +
                             rsaKey(test::makeRsaKey(), R"(,"use":"enc")") + "," +
                             rsaKey(test::makeRsaKey(), R"(,"alg":"PS256")") + ",";
  const auto keys = parseKeySet(set(others + octKey()), "keys");
  ASSERT_TRUE(keys) << keys.error().message;
  EXPECT_EQ(keys->size(), 1U);
}

TEST(JwkSet, SaysWhichKeyIsWrongAndWhy) {
  EXPECT_THAT(refusalOf(set(octKey() + "," + octKey("", "short"))), HasSubstr("keys.json: key 2: the secret has 5"));
  EXPECT_THAT(refusalOf(set(edKey(test::makeEd25519Key(), R"(,"d":"AA")"))), HasSubstr("private key"));
  EXPECT_THAT(refusalOf(set(R"({"kty":"OKP","crv":"Ed25519","x":"AAAA"})")), HasSubstr("32 bytes"));
  EXPECT_THAT(refusalOf(set(R"({"kty":"RSA","n":"!","e":"AQAB"})")), HasSubstr("base64url"));
  EXPECT_THAT(refusalOf(set(rsaKey(test::makeRsaKey(1024)))), HasSubstr("1024 bits"));
  EXPECT_THAT(refusalOf(set("3")), HasSubstr("key 1: it is no object"));
}

TEST(JwkSet, RefusesWhatIsNone) {
  EXPECT_THAT(refusalOf("{"), HasSubstr("no JSON"));
  EXPECT_THAT(refusalOf("[]"), HasSubstr("no JWK set"));
  EXPECT_THAT(refusalOf("{\"keys\":3}"), HasSubstr("no JWK set"));
  EXPECT_THAT(refusalOf(set("")), HasSubstr("it has no key"));
  std::string many;
  for (std::size_t k = 0; k <= kJwtKeyMaxCount; ++k) many += (k == 0 ? "" : ",") + octKey();
  EXPECT_THAT(refusalOf(set(many)), HasSubstr("at most 32"));
  EXPECT_THAT(refusalOf(set(std::string(100, '[') + std::string(100, ']'))), HasSubstr("no JSON"));
}

}  // namespace
}  // namespace spindrift::access
