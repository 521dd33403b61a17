#include <gmock/gmock.h>

#include <spindrift/access/jwt.h>

#include "jwt_maker.h"

namespace spindrift::access {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string refusalOf(const core::Result<JwtKey>& key) {
  return key ? "(accepted)" : key.error().message;
}

TEST(JwtKeys, TheKindOfAPublicKeyFixesItsAlgorithm) {
  EXPECT_EQ(parsePublicKey(test::pemOf(test::makeRsaKey()), "key")->algorithm, JwtAlgorithm::kRs256);
  EXPECT_EQ(parsePublicKey(test::pemOf(test::makeEd25519Key()), "key")->algorithm, JwtAlgorithm::kEdDsa);
}

TEST(JwtKeys, UnsupportedKeysAreRefusedWithTheReason) {
  EXPECT_THAT(refusalOf(parsePublicKey(test::pemOf(test::makeEd25519Key(), true), "key.pem")),
              HasSubstr("key.pem: this is a private key"));
  EXPECT_THAT(refusalOf(parsePublicKey(test::pemOf(test::makeEcKey()), "key")), HasSubstr("not supported"));
  EXPECT_THAT(refusalOf(parsePublicKey(test::pemOf(test::makeRsaKey(1024)), "key")), HasSubstr("1024 bits"));
  EXPECT_THAT(refusalOf(parsePublicKey("hello", "key")), HasSubstr("no public key"));
  EXPECT_THAT(refusalOf(parsePublicKey("", "key")), HasSubstr("no public key"));
}

TEST(JwtKeys, AnEd25519PointOfSmallOrderIsRefused) {
  const std::string identity = "MCowBQYDK2VwAyEAAQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=";  // y = 1
  EXPECT_THAT(
      refusalOf(parsePublicKey("-----BEGIN PUBLIC KEY-----\n" + identity + "\n-----END PUBLIC KEY-----\n", "key.pem")),
      HasSubstr("key.pem: the Ed25519 key is a point of small order"));
}

TEST(JwtKeys, LineBreakAfterASecretIsIgnored) {
  const std::string secret(32, 's');
  for (const char* end : {"", "\n", "\r\n"}) EXPECT_EQ(parseSecret(secret + end, "key")->secret, secret);
}

TEST(JwtKeys, ShortSecretsAreRefusedAndNotRepeated) {
  const std::string short_one(31, 's');
  EXPECT_THAT(refusalOf(parseSecret(short_one + "\n", "key")), HasSubstr("31 bytes"));
  EXPECT_THAT(refusalOf(parseSecret(short_one, "key")), Not(HasSubstr("sss")));
}

TEST(JwtKeys, APublicKeyIsNotTakenAsASecret) {
  EXPECT_THAT(refusalOf(parseSecret(test::pemOf(test::makeRsaKey()), "key")), HasSubstr("PEM"));
}

}  // namespace
}  // namespace spindrift::access
