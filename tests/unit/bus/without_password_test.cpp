// What logs and errors show of a NATS URL.
#include <gtest/gtest.h>

#include <spindrift/bus/bus.h>

namespace spindrift::bus {
namespace {

TEST(WithoutPassword, LeavesSchemeHostAndPort) {
  EXPECT_EQ(withoutPassword("nats://ada:secret@host:4222"), "nats://host:4222");
  EXPECT_EQ(withoutPassword("tls://token@host"), "tls://host");
  EXPECT_EQ(withoutPassword("ada:secret@host"), "host");
  EXPECT_EQ(withoutPassword("nats://host"), "nats://host");
  EXPECT_EQ(withoutPassword(""), "");
}

TEST(WithoutPassword, HidesThePasswordsOfSeveralServers) {
  EXPECT_EQ(withoutPassword("nats://a:secret@one:4222,nats://two,tls://b:secret@three"),
            "nats://one:4222,nats://two,tls://three");
}

TEST(WithoutPassword, RemovesAPasswordWithAnAtSign) {
  EXPECT_EQ(withoutPassword("nats://ada:se@cret@host"), "nats://host");
}

TEST(WithoutPassword, AnErrorOfTheConnectionNamesTheHostOnly) {
  const auto bus = Bus::connect({.url = "nats://ada:secret@127.0.0.1:1", .name = "test", .ca_file = {}});
  ASSERT_FALSE(bus);
  EXPECT_EQ(bus.error().code, core::ErrorCode::kUnavailable);
  EXPECT_NE(bus.error().message.find("nats://127.0.0.1:1"), std::string::npos) << bus.error().message;
  EXPECT_EQ(bus.error().message.find("secret"), std::string::npos) << bus.error().message;
}

}  // namespace
}  // namespace spindrift::bus
