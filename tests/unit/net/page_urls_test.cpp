// Addresses that other devices are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/net/page_urls.h>

namespace spindrift::net {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST(PageUrls, AreThoseOfThePadsWithoutTheirPath) {
  EXPECT_THAT(pageUrls({.address = "192.0.2.7", .port = 9000}), ElementsAre("http://192.0.2.7:9000/"));
  EXPECT_THAT(pageUrls({.address = "127.0.0.1", .port = 1, .public_url = "https://water.example/sea"}),
              ElementsAre("https://water.example/sea/"));
  EXPECT_THAT(pageUrls({.address = "::1", .port = 8080}), IsEmpty());
}

TEST(PadUrls, AreEmptyOnTheLoopback) {
  EXPECT_THAT(padUrls({.address = "127.0.0.1", .port = 8080}), IsEmpty());
  EXPECT_THAT(padUrls({.address = "::1", .port = 8080}), IsEmpty());
}

TEST(PadUrls, HaveTheAddressPortAndSchemeOfTheServer) {
  EXPECT_THAT(padUrls({.address = "192.0.2.7", .port = 9000}), ElementsAre("http://192.0.2.7:9000/pad"));
  EXPECT_THAT(padUrls({.address = "2001:db8::7", .port = 443, .is_tls = true}),
              ElementsAre("https://[2001:db8::7]:443/pad"));
}

TEST(PadUrls, ThePublicAddressReplacesThem) {
  EXPECT_THAT(padUrls({.address = "127.0.0.1", .port = 1, .public_url = "https://water.example/sea//"}),
              ElementsAre("https://water.example/sea/pad"));
}

TEST(PadUrls, OfAllAddressesAreThoseThatOthersReach) {
  for (const char* any : {"0.0.0.0", "::"}) {
    const auto urls = padUrls({.address = any, .port = 8080});
    EXPECT_THAT(urls, Each(StartsWith("http://")));
    EXPECT_THAT(urls, Each(EndsWith(":8080/pad")));
    EXPECT_THAT(urls, Each(Not(testing::AnyOf(HasSubstr("//127."), HasSubstr("[::1]"), HasSubstr("//169.254."),
                                              HasSubstr("[fe80"), HasSubstr("0.0.0.0")))));
  }
  EXPECT_THAT(padUrls({.address = "0.0.0.0", .port = 8080}), Each(Not(HasSubstr("["))));
}

}  // namespace
}  // namespace spindrift::net
