// WebSocket sessions over loopback: handshakes, messages, misuse, the order of the application's callbacks.
#include <random>

#include <gtest/gtest.h>

#include <spindrift/core/text.h>

#include "test_application.h"

namespace spindrift::net {
namespace {

using test::bytes;
using test::eventually;
using test::RawTcp;
using test::TestServer;
using test::text;
using test::WsClient;

const std::string kUpgrade =
    "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n\r\n";

/// A raw connection after the upgrade and the greeting.
RawTcp upgraded(const TestServer& served) {
  RawTcp raw;
  EXPECT_TRUE(raw.connect("127.0.0.1", served.server->port()));
  EXPECT_TRUE(raw.send(kUpgrade));
  EXPECT_TRUE(raw.receiveUntil("hello ").starts_with("HTTP/1.1 101 "));
  return raw;
}

TEST(Session, GreetsAndEchoes) {
  const TestServer served;
  WsClient client;
  ASSERT_TRUE(client.connect("127.0.0.1", served.server->port(), "/ws/pool"));
  EXPECT_EQ(client.handshakeHeader("Sec-WebSocket-Protocol"), "spindrift.v1");
  EXPECT_EQ(client.handshakeHeader("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(text(client.receive()), "hello pool");
  ASSERT_TRUE(client.sendBinary(bytes("echo water")));
  EXPECT_EQ(text(client.receive()), "echo water");
  EXPECT_TRUE(served.application.peers().at(0).starts_with("127.0.0.1:"));
}

TEST(Session, AcceptsAClientThatOffersNoSubprotocol) {
  const TestServer served;
  WsClient client;
  ASSERT_TRUE(client.connect("127.0.0.1", served.server->port(), "/ws", ""));
  EXPECT_EQ(client.handshakeHeader("Sec-WebSocket-Protocol"), "");
  EXPECT_EQ(text(client.receive()), "hello ");
}

TEST(Session, PicksItsSubprotocolFromSeveral) {
  const TestServer served;
  WsClient client;
  ASSERT_TRUE(client.connect("127.0.0.1", served.server->port(), "/ws", "chat, spindrift.v1"));
  EXPECT_EQ(client.handshakeHeader("Sec-WebSocket-Protocol"), "spindrift.v1");
}

TEST(Session, RefusesAClientThatOffersOnlyOtherSubprotocols) {
  const TestServer served;
  WsClient client;
  EXPECT_FALSE(client.connect("127.0.0.1", served.server->port(), "/ws", "spindrift.v2, chat"));
  EXPECT_EQ(client.handshakeStatus(), 400U);
  EXPECT_EQ(client.handshakeBody(), "No offered subprotocol is known here: offer spindrift.v1.\n");
  EXPECT_TRUE(served.application.opened().empty());
}

TEST(Session, RefusesAnUnknownRoomWithTheApplicationsLine) {
  const TestServer served;
  WsClient client;
  EXPECT_FALSE(client.connect("127.0.0.1", served.server->port(), "/ws/desert"));
  EXPECT_EQ(client.handshakeStatus(), 404U);
  EXPECT_EQ(client.handshakeBody(), "there is no room \"desert\"\n");
  WsClient lost;
  EXPECT_FALSE(lost.connect("127.0.0.1", served.server->port(), "/socket"));
  EXPECT_EQ(lost.handshakeStatus(), 404U);
  WsClient unlucky;
  EXPECT_FALSE(unlucky.connect("127.0.0.1", served.server->port(), "/ws/throws"));
  EXPECT_EQ(unlucky.handshakeStatus(), 500U);
}

TEST(Session, RefusesARoomThatCannotBeReachedNowWith503AndRetryAfter) {
  const TestServer served;
  WsClient client;
  EXPECT_FALSE(client.connect("127.0.0.1", served.server->port(), "/ws/later"));
  EXPECT_EQ(client.handshakeStatus(), 503U);
  EXPECT_EQ(client.handshakeHeader("Retry-After"), "1");
  EXPECT_EQ(client.handshakeBody(), "the room cannot be reached now\n");
}

TEST(Session, RefusesMoreSessionsThanTheBoundAndTakesThemAgainLater) {
  const TestServer served({.max_session_count = 2, .address_session_share = 1.0});
  WsClient first = served.client();
  WsClient second = served.client();
  WsClient third;
  EXPECT_FALSE(third.connect("127.0.0.1", served.server->port()));
  EXPECT_EQ(third.handshakeStatus(), 503U);
  EXPECT_EQ(third.handshakeBody(), "The server is full: 2 sessions are open; try again later.\n");
  EXPECT_TRUE(first.close());
  EXPECT_TRUE(eventually([&] {
    WsClient again;
    return again.connect("127.0.0.1", served.server->port());
  }));
}

TEST(Session, KeepsTheOrderOfControlMessages) {
  const TestServer served;
  WsClient client = served.client();
  ASSERT_TRUE(client.sendBinary(bytes("flood 200 0")));
  for (int k = 0; k < 200; ++k) ASSERT_EQ(text(client.receive()), std::to_string(k) + " ");
}

TEST(Session, ClosesWithTryAgainLaterWhenTooManyAnswersWait) {
  TestServer served({.answer_max_count = 8});
  WsClient client = served.client();
  // The flood is queued inside one callback, so the writer can take none of it before the ninth message.
  ASSERT_TRUE(client.sendBinary(bytes("flood 20 0")));
  for (int k = 0; k < 8; ++k) ASSERT_EQ(text(client.receive()), std::to_string(k) + " ");
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1013);
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1013);
  EXPECT_EQ(served.server->stats().evicted_session_count, 1U);
}

TEST(Session, IsNotReadFromWhileItsAnswersWait) {
  TestServer served({.answer_pause_count = 4, .messages_per_s = 1e6, .message_burst_count = 1e6});
  WsClient client = served.client();
  // The answers exceed the kernel's buffers; the requests for them fit.
  constexpr int kCount = 600;
  constexpr std::size_t kAnswerBytes = 65'536;
  for (int k = 0; k < kCount; ++k) ASSERT_TRUE(client.sendBinary(bytes("flood 1 65536")));
  ASSERT_TRUE(eventually([&] { return served.server->stats().waiting_control_count >= 4U; }));
  EXPECT_LT(served.application.message_count.load(), kCount) << "TCP holds back what follows";
  EXPECT_LE(served.server->stats().waiting_control_count, 5U);
  for (int k = 0; k < kCount; ++k) ASSERT_EQ(client.receive().value_or(core::Bytes{}).size(), kAnswerBytes) << k;
  EXPECT_FALSE(client.closed()) << "no message is lost and the session stays open";
}

TEST(Session, SendsQueuedControlMessagesBeforeTheClose) {
  TestServer served;
  WsClient client = served.client();
  ASSERT_TRUE(client.sendBinary(bytes("bye")));
  EXPECT_EQ(text(client.receive()), "last words");
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1000);
  EXPECT_EQ(client.closeReason(), "as you wish");
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1000);
  EXPECT_EQ(served.application.closed()[0].end.reason, "as you wish");
}

TEST(Session, CutsALongCloseReasonBetweenTwoCharacters) {
  TestServer served;
  // The limit of 123 bytes falls on each byte of a character of four, and one byte is not UTF-8 at all.
  for (const char* begin : {"", "x", "xx", "xxx", "\xff"}) {
    SCOPED_TRACE(begin);
    WsClient client = served.client();
    std::string reason = begin;
    for (int k = 0; k < 50; ++k) reason += "\U0001F30A";
    served.application.hub->close(served.application.opened().back(), CloseCode::kPolicy, reason);
    EXPECT_TRUE(client.waitClosed());
    EXPECT_EQ(client.closeCode(), 1008) << "a client closes with 1002 or without a code if the reason is not UTF-8";
    const std::string sent = client.closeReason();
    EXPECT_GE(sent.size(), 120U);
    EXPECT_LE(sent.size(), 123U);
    for (std::size_t at = 0; at < sent.size();) {
      const std::size_t length = core::utf8SequenceLength(sent, at);
      ASSERT_NE(length, 0U) << "at byte " << at;
      at += length;
    }
  }
}

TEST(Session, RefusesTextMessages) {
  const TestServer served;
  WsClient client = served.client();
  ASSERT_TRUE(client.sendText("{}"));
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1003);
}

TEST(Session, RefusesOversizeMessages) {
  TestServer served({.read_message_max_bytes = 1000});
  WsClient client = served.client();
  ASSERT_TRUE(client.sendBinary(core::Bytes(1000, 'x')));
  ASSERT_TRUE(client.sendBinary(bytes("echo still here")));
  EXPECT_EQ(text(client.receive()), "echo still here");
  ASSERT_TRUE(client.sendBinary(core::Bytes(1001, 'x')));
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1009);
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1009);
  EXPECT_EQ(served.application.message_count, 2);
}

TEST(Session, ClosesOnAFloodOfMessages) {
  TestServer served({.messages_per_s = 0.001, .message_burst_count = 5});
  WsClient client = served.client();
  for (int k = 0; k < 6; ++k) ASSERT_TRUE(client.sendBinary(bytes("noise")));
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1008);
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1008);
  EXPECT_EQ(served.application.message_count, 5);
}

TEST(Session, ClosesOnAFloodOfPings) {
  TestServer served({.messages_per_s = 0.001, .message_burst_count = 5});
  WsClient client = served.client();
  for (int k = 0; k < 6; ++k) ASSERT_TRUE(client.sendPing());
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1008);
}

TEST(Session, AnExceptionOfTheApplicationEndsOnlyItsSession) {
  TestServer served;
  WsClient client = served.client();
  WsClient other = served.client();
  ASSERT_TRUE(client.sendBinary(bytes("throw")));
  EXPECT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1011);
  ASSERT_TRUE(other.sendBinary(bytes("echo unharmed")));
  EXPECT_EQ(text(other.receive()), "echo unharmed");
}

TEST(Session, ReportsToTheApplicationHowThePeerLeft) {
  TestServer served;
  WsClient polite = served.client();
  EXPECT_TRUE(polite.close(1000));
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1000);
  WsClient gone = served.client();
  gone.vanish();
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 2; }));
  EXPECT_EQ(served.application.closed()[1].end.code, 0);
  EXPECT_FALSE(served.application.closed()[1].end.reason.empty());
}

TEST(Session, ClosesWhenThePeerStaysSilent) {
  TestServer served({.idle_timeout = std::chrono::milliseconds(300)});
  const WsClient client = served.client();  // runs only inside its calls, so it answers no ping
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
}

TEST(Session, ClosesAPeerThatSendsACloseFrameButStaysConnected) {
  TestServer served({.close_timeout = std::chrono::milliseconds(200)});
  RawTcp raw = upgraded(served);
  ASSERT_TRUE(raw.send(std::string("\x88\x82\0\0\0\0\x03\xe8", 8)));  // masked close frame, code 1000
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
}

TEST(Session, EndsOnBrokenFrames) {
  // The peer keeps its side open, so that the server has to stop waiting for it as well.
  TestServer served({.idle_timeout = std::chrono::milliseconds(2000)});
  const std::string protocol_error("\x88\x02\x03\xea", 4);  // a close frame with code 1002
  const std::vector<std::string> broken = {
      std::string("\x82\x01x", 3),         // not masked
      std::string("\x83\x80\0\0\0\0", 6),  // reserved opcode
      std::string("\xf2\x80\0\0\0\0", 6),  // reserved bits
      std::string("\x80\x80\0\0\0\0", 6),  // a continuation without a start
  };
  std::vector<RawTcp> peers;
  for (const std::string& frame : broken) {
    peers.push_back(upgraded(served));
    ASSERT_TRUE(peers.back().send(frame));
  }
  for (std::size_t k = 0; k < broken.size(); ++k) {
    EXPECT_EQ(peers[k].receiveAll(), protocol_error) << "case " << k;
    EXPECT_TRUE(peers[k].closed()) << "case " << k;
  }
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == broken.size(); }));
  EXPECT_TRUE(served.serves());
}

TEST(Session, RefusesAFrameThatClaimsToBeImmense) {
  TestServer served;
  RawTcp raw = upgraded(served);
  ASSERT_TRUE(raw.send(std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14)));  // 2^63 - 1 bytes
  EXPECT_EQ(raw.receive(4), std::string("\x88\x02\x03\xf1", 4)) << "a close frame with code 1009";
  raw.close();
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1009);
}

TEST(Session, ReadsTheRestOfARefusedMessageSoThatThePeerGetsTheCloseFrame) {
  // Bytes that nobody read would reset the connection: a peer that is still sending then loses the close frame.
  TestServer served({.read_message_max_bytes = 1000});
  RawTcp raw = upgraded(served);
  ASSERT_TRUE(raw.send(std::string("\x82\xff\0\0\0\0\0\x10\0\0\0\0\0\0", 14)));  // 1 MiB
  ASSERT_TRUE(raw.send(std::string(64 * 1024, 'x')));
  EXPECT_EQ(raw.receive(4), std::string("\x88\x02\x03\xf1", 4)) << "a close frame with code 1009";
  for (int k = 1; k < 16; ++k) ASSERT_TRUE(raw.send(std::string(64 * 1024, 'x'))) << "after " << k << " of 16 parts";
  raw.close();
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 1009);
}

TEST(Session, RefusesBytesAfterAnUnansweredUpgrade) {
  const TestServer served;
  EXPECT_EQ(test::httpExchange(served.server->port(), kUpgrade + "\x82").status, 400U);
  EXPECT_TRUE(served.application.opened().empty());
}

TEST(Session, SurvivesUpgradesThatBreakOff) {
  TestServer served;
  for (std::size_t length = 1; length < kUpgrade.size(); length += 7) {
    RawTcp raw;
    ASSERT_TRUE(raw.connect("127.0.0.1", served.server->port()));
    ASSERT_TRUE(raw.send(kUpgrade.substr(0, length)));
  }
  RawTcp half_frame = upgraded(served);
  ASSERT_TRUE(half_frame.send(std::string("\x82\x90\0\0", 4)));
  half_frame.close();
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_TRUE(served.serves());
}

TEST(Session, RandomFramesDoNotHarmOtherSessions) {
  TestServer served({.message_burst_count = 1e6});
  WsClient other = served.client();
  std::mt19937 random(7);
  for (int k = 0; k < 50; ++k) {
    RawTcp raw = upgraded(served);
    std::string noise(1 + random() % 300, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    (void)raw.send(noise);
  }
  ASSERT_TRUE(other.sendBinary(bytes("echo unharmed")));
  EXPECT_EQ(text(other.receive()), "echo unharmed");
  EXPECT_TRUE(eventually([&] { return served.server->stats().open_session_count == 1; }));
}

TEST(Session, CallbacksNeverOverlapAndCloseComesLastWhenManyComeAndGo) {
  TestServer served({.thread_count = 3});
  std::atomic<bool> done{false};
  std::thread publisher([&] {
    while (!done) {
      served.server->hub().publish("pool", 1, {core::share(core::Bytes(10'000)), {}});
      std::this_thread::yield();
    }
  });
  std::vector<std::thread> people;
  std::atomic<int> echo_count{0};
  for (int person = 0; person < 6; ++person) {
    people.emplace_back([&served, &echo_count, person] {
      for (int visit = 0; visit < 10; ++visit) {
        WsClient client;
        if (!client.connect("127.0.0.1", served.server->port(), "/ws/pool")) continue;
        (void)client.sendBinary(bytes("watch 1 1000000"));
        (void)client.sendBinary(bytes("echo " + std::to_string(person)));
        for (auto message = client.receive(); message; message = client.receive()) {
          if (text(message) != "echo " + std::to_string(person)) continue;
          ++echo_count;
          break;
        }
        if (visit % 2 == 0) (void)client.close();  // the others disconnect without a close frame
      }
    });
  }
  for (std::thread& one : people) one.join();
  done = true;
  publisher.join();
  EXPECT_EQ(echo_count, 60);
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == 60; }));
  EXPECT_EQ(served.application.opened().size(), 60U);
  EXPECT_EQ(served.application.overlap_count, 0);
  EXPECT_EQ(served.application.after_closed_count, 0);
  EXPECT_EQ(served.server->stats().open_session_count, 0U);
  EXPECT_EQ(served.application.demands.watcherCount("pool", 1), 0U);
}

}  // namespace
}  // namespace spindrift::net
