#include <gmock/gmock.h>

#include <spindrift/access/digest.h>

namespace spindrift::access {
namespace {

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
