// The address and the port of a server.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "test_application.h"

namespace spindrift::net {
namespace {

using test::TestServer;
using test::WsClient;

TEST(Listener, SaysWhatToDoWhenThePortIsInUse) {
  const TestServer first;
  test::TestApplication application;
  const auto second = Server::start({.port = first.server->port()}, application);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, core::ErrorCode::kUnavailable);
  EXPECT_EQ(second.error().message,
            "port " + std::to_string(first.server->port()) +
                " on 127.0.0.1 is in use: stop the other program or choose another with --port");
}

TEST(Listener, NamesABadAddress) {
  test::TestApplication application;
  for (const char* address : {"localhost", "", "300.1.1.1"}) {
    const auto started = Server::start({.address = address, .port = 0}, application);
    ASSERT_FALSE(started) << address;
    EXPECT_NE(started.error().message.find("\"" + std::string(address) + "\""), std::string::npos)
        << started.error().message;
  }
  const auto foreign = Server::start({.address = "192.0.2.1", .port = 0}, application);
  ASSERT_FALSE(foreign);
  EXPECT_NE(foreign.error().message.find("192.0.2.1"), std::string::npos);
}

TEST(Listener, TakesAPortAgainRightAfterStop) {
  auto first = std::make_unique<TestServer>();
  const auto port = first->server->port();
  const WsClient client = first->client();
  first.reset();
  test::TestApplication application;
  EXPECT_TRUE(Server::start({.port = port}, application));
}

}  // namespace
}  // namespace spindrift::net
