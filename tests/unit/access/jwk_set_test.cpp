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
  EXPECT_THAT(refusalOf(set("3")), HasSubstr("key 1: it is not an object"));
}

TEST(JwkSet, RefusesEd25519PointsOfSmallOrder) {
  const auto refusalOfPoint = [](const std::string& bytes) {
    return refusalOf(set(R"({"kty":"OKP","crv":"Ed25519","x":")" + toBase64Url(bytes) + "\"}"));
  };
  const auto little = [](int first, int middle, int last) {
    std::string bytes(32, static_cast<char>(middle));
    bytes.front() = static_cast<char>(first);
    bytes.back() = static_cast<char>(last);
    return bytes;
  };
  // y of the points of order 8: the roots of d y^4 + 2 y^2 - 1.
  const std::string eighth =
      "\x26\xe8\x95\x8f\xc2\xb2\x27\xb0\x45\xc3\xf4\x89\xf2\xef\x98\xf0\xd5\xdf\xac\x05\xd3\xc6\x33\x39\xb1\x38\x02\x88"
      "\x6d\x53\xfc\x05";
  const std::string other_eighth =
      "\xc7\x17\x6a\x70\x3d\x4d\xd8\x4f\xba\x3c\x0b\x76\x0d\x10\x67\x0f\x2a\x20\x53\xfa\x2c\x39\xcc\xc6\x4e\xc7\xfd\x77"
      "\x92\xac\x03\x7a";
  const std::vector<std::string> points{
      little(1, 0, 0),           // y = 1, order 1
      little(0xEC, 0xFF, 0x7F),  // y = p - 1, order 2
      little(0, 0, 0),           // y = 0, order 4
      eighth,
      other_eighth,
      little(0xED, 0xFF, 0x7F),  // y = p, which is 0
      little(0xEE, 0xFF, 0x7F),  // y = p + 1, which is 1
  };
  for (std::string point : points) {
    EXPECT_THAT(refusalOfPoint(point), HasSubstr("key 1: the Ed25519 key is a point of small order"));
    point.back() = static_cast<char>(static_cast<unsigned char>(point.back()) | 0x80U);  // the other x
    EXPECT_THAT(refusalOfPoint(point), HasSubstr("small order"));
  }
  for (int k = 0; k < 20; ++k) EXPECT_EQ(refusalOf(set(edKey(test::makeEd25519Key()))), "(accepted)");
}

TEST(JwkSet, RefusesRsaKeysWithAWeakExponent) {
  const test::KeyPair key = test::makeRsaKey();
  const auto withExponent = [&](const std::string& exponent) {
    const std::string whole = rsaKey(key);
    return refusalOf(set(whole.substr(0, whole.find(R"("e":)")) + R"("e":")" + exponent + "\"}"));
  };
  EXPECT_THAT(withExponent("AQ"), HasSubstr("an exponent that is 1 or even")) << 1;
  EXPECT_THAT(withExponent("AQAA"), HasSubstr("an exponent that is 1 or even")) << 65536;
  EXPECT_EQ(withExponent("AQAB"), "(accepted)");
}

TEST(JwkSet, RefusesWhatIsNone) {
  EXPECT_THAT(refusalOf(R"({"keys":[],"keys":[]})"), HasSubstr("the same name twice"));
  EXPECT_THAT(refusalOf("{"), HasSubstr("not JSON"));
  EXPECT_THAT(refusalOf("[]"), HasSubstr("not a JWK set"));
  EXPECT_THAT(refusalOf("{\"keys\":3}"), HasSubstr("not a JWK set"));
  EXPECT_THAT(refusalOf(set("")), HasSubstr("it has no key"));
  std::string many;
  for (std::size_t k = 0; k <= kJwtKeyMaxCount; ++k) many += (k == 0 ? "" : ",") + octKey();
  EXPECT_THAT(refusalOf(set(many)), HasSubstr("at most 32"));
  EXPECT_THAT(refusalOf(set(std::string(100, '[') + std::string(100, ']'))), HasSubstr("not JSON"));
}

}  // namespace
}  // namespace spindrift::access
