// Admission of clients: pages by their origin, addresses by their rate, tokens only where they are allowed; and
// requests that the application answers late, never, or after the server has ended.
#include <gtest/gtest.h>

#include <spindrift/http/network_text.h>

#include "address_limits.h"
#include "test_application.h"

namespace spindrift::net {
namespace {

using namespace std::chrono_literals;
using test::eventually;
using test::httpExchange;
using test::httpRequest;
using test::RawTcp;
using test::TestServer;

std::string upgradeFrom(const std::string& origin, const std::string& host = "localhost") {
  return "GET /ws HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + origin +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n\r\n";
}

std::uint64_t refusedCount(const TestServer& served, Refused why) {
  return served.server->stats().refused_count[static_cast<std::size_t>(why)];
}

TEST(Origin, RequestsWithoutOriginAreAccepted) {
  EXPECT_TRUE(isOriginAllowed("", "water.example", true, {}));
}

TEST(Origin, TheServersOwnPageIsAccepted) {
  EXPECT_TRUE(isOriginAllowed("http://localhost:8080", "localhost:8080", true, {}));
  EXPECT_TRUE(isOriginAllowed("http://127.0.0.1:8080", "127.0.0.1:8080", true, {}));
  EXPECT_TRUE(isOriginAllowed("http://[::1]:8080", "[::1]:8080", true, {}));
  EXPECT_TRUE(isOriginAllowed("https://Water.example", "water.EXAMPLE", false, {}));
}

TEST(Origin, ForeignPagesAreRefused) {
  EXPECT_FALSE(isOriginAllowed("http://evil.example", "localhost:8080", true, {}));
  EXPECT_FALSE(isOriginAllowed("http://localhost:3000", "localhost:8080", true, {}));
  EXPECT_FALSE(isOriginAllowed("null", "localhost:8080", false, {}));
  EXPECT_FALSE(isOriginAllowed("file://", "", false, {}));
}

TEST(Origin, AForeignNameForTheLoopbackOpensNothing) {
  EXPECT_FALSE(isOriginAllowed("http://evil.example:8080", "evil.example:8080", true, {}));
  EXPECT_FALSE(isOriginAllowed("http://127.0.0.1.evil.example", "127.0.0.1.evil.example", true, {}));
  EXPECT_FALSE(isOriginAllowed("http://localhost.evil.example", "localhost.evil.example", true, {}));
}

TEST(Origin, ListedOriginsAreAccepted) {
  const std::vector<std::string> allowed{"https://water.example"};
  EXPECT_TRUE(isOriginAllowed("https://water.example", "localhost:8080", true, allowed));
  EXPECT_FALSE(isOriginAllowed("https://water.example.evil", "localhost:8080", true, allowed));
  EXPECT_TRUE(isOriginAllowed("https://anything.example", "localhost:8080", true, std::vector<std::string>{"*"}));
}

TEST(AddressLimits, EachAddressHasItsOwnLimit) {
  AddressLimits limits({.address_requests_per_s = 1.0, .address_request_burst_count = 2.0});
  const Clock::time_point now{};
  EXPECT_TRUE(limits.takeRequest("192.0.2.1", now));
  EXPECT_TRUE(limits.takeRequest("192.0.2.1", now));
  EXPECT_FALSE(limits.takeRequest("192.0.2.1", now));
  EXPECT_TRUE(limits.takeRequest("192.0.2.2", now));
  EXPECT_TRUE(limits.takeRequest("192.0.2.1", now + 1s));
}

TEST(AddressLimits, DelaysMessagesBeyondTheBurst) {
  AddressLimits limits({.address_messages_per_s = 10.0, .address_message_burst_count = 2.0});
  const Clock::time_point now{};
  EXPECT_EQ(limits.reserveMessage("192.0.2.1", now), 0s);
  EXPECT_EQ(limits.reserveMessage("192.0.2.1", now), 0s);
  EXPECT_EQ(limits.reserveMessage("192.0.2.1", now), 100ms);
  EXPECT_EQ(limits.reserveMessage("192.0.2.1", now), 200ms);
  EXPECT_EQ(limits.reserveMessage("192.0.2.1", now + 10s), 0s);
}

TEST(AddressLimits, RemembersABoundedNumberOfAddresses) {
  AddressLimits limits({.address_requests_per_s = 1.0, .address_request_burst_count = 1.0});
  Clock::time_point now{};
  for (std::size_t k = 0; k < AddressLimits::kMaxAddressCount + 10; ++k) {
    EXPECT_TRUE(limits.takeRequest("address " + std::to_string(k), now += 1us));
  }
  EXPECT_EQ(limits.addressCount(), AddressLimits::kMaxAddressCount);
  EXPECT_FALSE(limits.takeRequest("address " + std::to_string(AddressLimits::kMaxAddressCount), now)) << "kept";
}

TEST(Admission, RefusesTheUpgradeOfAForeignPageAndCountsIt) {
  const TestServer served;
  const auto answer = httpExchange(served.server->port(), upgradeFrom("http://evil.example"));
  EXPECT_EQ(answer.status, 403U);
  EXPECT_NE(answer.body.find("--origin"), std::string::npos);
  EXPECT_EQ(refusedCount(served, Refused::kOrigin), 1U);
  EXPECT_TRUE(served.application.opened().empty());
  RawTcp own;
  ASSERT_TRUE(own.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(own.send(upgradeFrom("http://localhost")));
  EXPECT_TRUE(own.receiveUntil("hello ").starts_with("HTTP/1.1 101 "));
}

TEST(Admission, RefusesChangesByAForeignPageButAllowsReads) {
  const TestServer served;
  const std::string foreign = "Origin: http://evil.example\r\n";
  EXPECT_EQ(httpRequest(served.server->port(), "POST", "/api/echo", foreign, "x").status, 403U);
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/echo", foreign).status, 200U);
}

TEST(Admission, AFloodOfRequestsFromOneAddressGets429) {
  const TestServer served({.address_requests_per_s = 0.01, .address_request_burst_count = 3.0});
  for (int k = 0; k < 3; ++k) EXPECT_EQ(httpRequest(served.server->port(), "GET", "/healthz").status, 200U);
  const auto refused = httpRequest(served.server->port(), "GET", "/healthz");
  EXPECT_EQ(refused.status, 429U);
  EXPECT_EQ(refused.headers.at("retry-after"), "1");
  EXPECT_EQ(refusedCount(served, Refused::kRate), 1U);
}

TEST(Admission, MessagesOfOneAddressShareItsRate) {
  TestServer served({.address_messages_per_s = 50.0, .address_message_burst_count = 4.0});
  auto ada = served.client();
  auto bob = served.client();
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(ada.sendBinary(test::bytes("echo a")));
    ASSERT_TRUE(bob.sendBinary(test::bytes("echo b")));
  }
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(test::text(ada.receive()), "echo a") << "held back, not lost";
    EXPECT_EQ(test::text(bob.receive()), "echo b");
  }
  EXPECT_GE(served.server->stats().delayed_message_count, 1U);
}

TEST(Admission, RefusesATokenInTheAddress) {
  const TestServer served;
  std::string request = upgradeFrom("http://localhost");
  request.replace(request.find("/ws"), 3, "/ws?token=secret");
  const auto answer = httpExchange(served.server->port(), request);
  EXPECT_EQ(answer.status, 400U);
  EXPECT_EQ(answer.body.find("secret"), std::string::npos);
}

TEST(Admission, ClosesASessionAtItsTime) {
  TestServer served;
  auto client = served.client();
  served.application.hub->closeAt(served.application.opened().at(0), Clock::now() + 1h, CloseCode::kNormal, "later");
  served.application.hub->closeAt(served.application.opened().at(0), Clock::now() + 1ms, CloseCode::kUnauthorized,
                                  "the token has expired");
  ASSERT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 4401);
  EXPECT_EQ(client.closeReason(), "the token has expired");
  EXPECT_TRUE(eventually([&] { return served.server->stats().closed_by_code.contains(4401); }));
}

TEST(LateAnswer, ArrivesFromAnotherThread) {
  TestServer served;
  std::thread answerer([&] {
    ASSERT_TRUE(eventually([&] { return served.application.keptCount() == 1; }));
    served.application.kept.front()(HttpReply{200, "text/plain", "at last\n"});
  });
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/keep").body, "at last\n");
  answerer.join();
}

TEST(LateAnswer, ForgottenRequestsGet500) {
  const TestServer served;
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/forget").status, 500U);
}

TEST(LateAnswer, RequestsThatWaitTooLongGet504) {
  TestServer served({.answer_timeout = 20ms});
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/keep").status, 504U);
  served.application.kept.front()(HttpReply{});  // the request has already ended
}

TEST(LateAnswer, ServerStopsWhileARequestWaits) {
  test::TestApplication application;
  ServerOptions options;
  options.port = 0;
  auto server = Server::start(options, application);
  ASSERT_TRUE(server);
  RawTcp client;
  ASSERT_TRUE(client.connect("127.0.0.1", (*server)->port()));
  ASSERT_TRUE(client.send("GET /api/keep HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  ASSERT_TRUE(eventually([&] { return application.keptCount() == 1; }));
  const auto begin = Clock::now();
  (*server)->stop();
  EXPECT_LT(Clock::now() - begin, options.answer_timeout);
  *server = nullptr;
  application.kept.front()(HttpReply{});  // neither the connection nor the server exists any more
}

}  // namespace
}  // namespace spindrift::net
