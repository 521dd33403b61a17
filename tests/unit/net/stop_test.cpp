// Stopping a server with every kind of client still connected.
#include <future>

#include <gtest/gtest.h>

#include "test_application.h"

namespace spindrift::net {
namespace {

using test::bytes;
using test::eventually;
using test::RawTcp;
using test::TestServer;
using test::text;
using test::WsClient;
using Clock = std::chrono::steady_clock;

/// A stop that takes longer waits for a client. Generous, so that a loaded machine does not count.
constexpr std::chrono::seconds kHang{60};

TEST(Stop, SaysGoingAwayToClientsThatListen) {
  TestServer served({.close_timeout = 2 * kHang});
  std::vector<std::future<std::uint16_t>> codes;
  for (int k = 0; k < 4; ++k) {
    codes.push_back(std::async(std::launch::async, [client = served.client()]() mutable {
      client.waitClosed();
      return client.closeCode();
    }));
  }
  const auto begin = Clock::now();
  served.server->stop();
  EXPECT_LT(Clock::now() - begin, kHang) << "the stop waited for a client";
  for (auto& code : codes) EXPECT_EQ(code.get(), 1001);
  ASSERT_EQ(served.application.closed().size(), 4U);
  for (const auto& closed : served.application.closed()) {
    EXPECT_EQ(closed.end.code, 1001);
    EXPECT_EQ(closed.end.reason, "server is shutting down");
  }
}

TEST(Stop, WhileDrainingNewSessionsAreRefusedAndOldOnesGoOn) {
  TestServer served;
  WsClient old = served.client();
  RawTcp keep_alive;
  ASSERT_TRUE(keep_alive.connect("127.0.0.1", served.server->port()));
  served.server->drain(std::chrono::seconds(7));
  WsClient late;
  EXPECT_FALSE(late.connect("127.0.0.1", served.server->port()));
  EXPECT_EQ(late.handshakeStatus(), 503u);
  EXPECT_EQ(late.handshakeHeader("Retry-After"), "7");
  EXPECT_TRUE(old.sendBinary(bytes("echo still here")));
  EXPECT_EQ(text(old.receive()), "echo still here");
  ASSERT_TRUE(keep_alive.send("GET /healthz HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_TRUE(keep_alive.receiveAll().starts_with("HTTP/1.1 200")) << "the reply comes, and is the last";
  EXPECT_TRUE(keep_alive.closed());
  EXPECT_EQ(served.server->stats().refused_count[static_cast<std::size_t>(Refused::kDraining)], 1u);
}

TEST(Stop, DoesNotWaitForUnresponsiveClients) {
  constexpr std::chrono::milliseconds kCloseTimeout{300};
  TestServer served({.close_timeout = kCloseTimeout});
  WsClient idle = served.client();  // never receives, so it does not answer the close frame either
  const WsClient stuck = served.watcher(1, 1e6, 4096);
  served.server->hub().publish("pool", 1, {core::share(core::Bytes(16U << 20U)), {}});
  RawTcp keep_alive;
  ASSERT_TRUE(keep_alive.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(keep_alive.send("GET /healthz HTTP/1.1\r\nHost: a\r\n\r\n"));
  ASSERT_FALSE(keep_alive.receive(1).empty());
  RawTcp half_handshake;
  ASSERT_TRUE(half_handshake.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(half_handshake.send("GET /ws HTTP/1.1\r\nHost: a\r\nUpgr"));
  RawTcp silent;
  ASSERT_TRUE(silent.connect("127.0.0.1", served.server->port()));

  const auto begin = Clock::now();
  served.server->stop();
  EXPECT_LT(Clock::now() - begin, kHang) << "the stop waited for a client";
  EXPECT_EQ(served.application.closed().size(), 2U);
  EXPECT_TRUE(idle.waitClosed());
  EXPECT_EQ(idle.closeCode(), 1001);
  (void)silent.receiveAll();
  EXPECT_TRUE(silent.closed());
  RawTcp late;
  EXPECT_FALSE(late.connect("127.0.0.1", served.server->port())) << "the port is closed";
}

TEST(Stop, AnswersRequestsThatWaitForTheApplication) {
  TestServer served({.close_timeout = 2 * kHang});
  auto waiting = std::async(std::launch::async, [port = served.server->port()] {
    return test::httpRequest(port, "POST", "/api/keep", "Content-Type: application/json\r\n", "{}");
  });
  ASSERT_TRUE(eventually([&] { return served.application.keptCount() == 1; }));
  const auto begin = Clock::now();
  served.server->stop();
  EXPECT_LT(Clock::now() - begin, kHang) << "the stop waited for the application";
  const test::HttpAnswer answer = waiting.get();
  EXPECT_EQ(answer.status, 503U) << answer.body;
  served.application.kept.front()(HttpReply{200, "text/plain", "too late"});
}

TEST(Stop, WorksUnderLoad) {
  TestServer served({.thread_count = 2, .close_timeout = std::chrono::milliseconds(500)});
  std::atomic<bool> done{false};
  std::vector<std::thread> crowd;
  for (int k = 0; k < 3; ++k) {
    crowd.emplace_back([&served, &done] {
      while (!done) {
        WsClient client;
        if (!client.connect("127.0.0.1", served.server->port(), "/ws/pool")) continue;
        (void)client.sendBinary(bytes("watch 1 1000000"));
        for (int message = 0; message < 50 && client.receive(); ++message) (void)client.sendBinary(bytes("echo x"));
      }
    });
  }
  crowd.emplace_back([&served, &done] {
    while (!done) {
      served.server->hub().publish("pool", 1, {core::share(core::Bytes(100'000)), {}});
      std::this_thread::yield();
    }
  });
  EXPECT_TRUE(eventually([&] { return served.server->stats().sent_frame_count > 100; }));
  served.server->stop();
  const std::size_t opened_count = served.application.opened().size();
  EXPECT_EQ(served.application.closed().size(), opened_count) << "every session has ended when stop() returns";
  done = true;
  for (std::thread& one : crowd) one.join();
  EXPECT_EQ(served.application.opened().size(), opened_count) << "no session was opened afterwards";
  EXPECT_EQ(served.application.overlap_count, 0);
  EXPECT_EQ(served.application.after_closed_count, 0);
}

TEST(Stop, MayBeAskedTwiceAndFromSeveralThreads) {
  TestServer served;
  const WsClient client = served.client();
  std::thread other([&] { served.server->stop(); });
  served.server->stop();
  other.join();
  served.server->stop();
  EXPECT_EQ(served.application.closed().size(), 1U);
}

}  // namespace
}  // namespace spindrift::net
