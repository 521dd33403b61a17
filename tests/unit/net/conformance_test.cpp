// RFC 6455 on the server's side, frame by frame. A peer that breaks a rule gets a close code and is disconnected;
// another client is served all the time.
#include <numeric>

#include <gtest/gtest.h>

#include "test_application.h"
#include "ws_frames.h"

namespace spindrift::net {
namespace {

using test::bytes;
using test::bytesOf;
using test::closeFrame;
using test::eventually;
using test::Frame;
using test::FrameClient;
using test::LengthForm;
using test::Opcode;
using test::text;

constexpr std::uint16_t kProtocolError = 1002;
constexpr std::uint16_t kBadPayload = 1007;
constexpr std::uint16_t kTooBig = 1009;

class Conformance : public testing::Test {
 protected:
  Conformance()
      : served_({.read_message_max_bytes = 100'000, .messages_per_s = 1e6, .message_burst_count = 1e6}),
        bystander_(served_.client()) {}

  void TearDown() override {
    ASSERT_TRUE(bystander_.sendBinary(bytes("echo unharmed")));
    EXPECT_EQ(text(bystander_.receive()), "echo unharmed");
  }

  /// A client after the upgrade and the greeting.
  FrameClient peer() {
    FrameClient out;
    EXPECT_TRUE(out.connect(served_.server->port()));
    EXPECT_EQ(payload(out), "hello ");
    return out;
  }
  static std::string payload(FrameClient& client) {
    const auto frame = client.receive();
    return frame ? frame->payload : "(no frame)";
  }
  /// Checks that the session still answers.
  static bool isServed(FrameClient& client) {
    return client.send({.payload = "echo alive"}) && payload(client) == "echo alive";
  }
  /// Checks that a new peer that sends these frames is closed with this code and disconnected.
  void expectClosed(const std::vector<Frame>& frames, std::uint16_t code, const std::string& what) {
    FrameClient client = peer();
    for (const Frame& frame : frames) ASSERT_TRUE(client.send(frame)) << what;
    EXPECT_EQ(client.receiveClose(), code) << what;
    EXPECT_TRUE(client.waitClosed()) << what;
  }
  std::string echoOf(std::size_t size) { return "echo " + std::string(size - 5, 'x'); }

  test::TestServer served_;
  test::WsClient bystander_;
};

TEST_F(Conformance, TakesEveryLengthInItsShortestForm) {
  FrameClient client = peer();
  for (const std::size_t size : {5U, 125U, 126U, 127U, 65'535U, 65'536U, 100'000U}) {
    ASSERT_TRUE(client.send({.payload = echoOf(size)}));
    const auto answer = client.receive();
    ASSERT_TRUE(answer) << size;
    EXPECT_EQ(answer->opcode, Opcode::kBinary);
    EXPECT_EQ(answer->payload, echoOf(size)) << size;
  }
}

TEST_F(Conformance, RefusesLengthsThatAreNotTheShortest) {
  const auto with = [this](std::size_t size, LengthForm form) {
    return std::vector<Frame>{{.payload = echoOf(size), .length_form = form}};
  };
  expectClosed(with(125, LengthForm::kSixteenBits), kProtocolError, "125 in 16 bits");
  expectClosed(with(125, LengthForm::kSixtyFourBits), kProtocolError, "125 in 64 bits");
  expectClosed(with(65'535, LengthForm::kSixtyFourBits), kProtocolError, "65535 in 64 bits");
}

TEST_F(Conformance, RefusesEveryReservedBitAndOpcode) {
  for (const std::uint8_t bit : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{4}}) {
    for (const Opcode opcode : {Opcode::kBinary, Opcode::kPing, Opcode::kClose}) {
      expectClosed({{.opcode = opcode, .reserved_bits = bit}}, kProtocolError, "reserved bit");
    }
    expectClosed({{.fin = false}, {.opcode = Opcode::kContinuation, .reserved_bits = bit}}, kProtocolError,
                 "reserved bit in a continuation");
  }
  for (const unsigned opcode : {3U, 4U, 5U, 6U, 7U, 11U, 12U, 13U, 14U, 15U}) {
    expectClosed({{.opcode = static_cast<Opcode>(opcode)}}, kProtocolError, "opcode " + std::to_string(opcode));
  }
}

TEST_F(Conformance, RefusesEveryFrameWithoutAMask) {
  for (const Opcode opcode : {Opcode::kText, Opcode::kBinary, Opcode::kPing, Opcode::kPong, Opcode::kClose}) {
    expectClosed({{.opcode = opcode, .masked = false}}, kProtocolError, "not masked");
  }
}

TEST_F(Conformance, JoinsManyFragmentsWithPingsBetween) {
  FrameClient client = peer();
  const std::string whole = echoOf(300);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Opcode opcode = i == 0 ? Opcode::kBinary : Opcode::kContinuation;
    ASSERT_TRUE(client.send({.opcode = opcode, .payload = whole.substr(i, 1), .fin = false}));
    if (i % 50 != 0) continue;
    ASSERT_TRUE(client.send({.opcode = Opcode::kPing, .payload = "at " + std::to_string(i)}));
    const auto pong = client.receive();
    ASSERT_TRUE(pong) << i;
    EXPECT_EQ(pong->opcode, Opcode::kPong);
    EXPECT_EQ(pong->payload, "at " + std::to_string(i));
  }
  ASSERT_TRUE(client.send({.opcode = Opcode::kContinuation}));  // the last one may be empty
  EXPECT_EQ(payload(client), whole);
}

TEST_F(Conformance, RefusesMessagesThatOverlap) {
  expectClosed({{.payload = "echo ", .fin = false}, {.payload = "echo x"}}, kProtocolError, "binary in binary");
  expectClosed({{.payload = "echo ", .fin = false}, {.opcode = Opcode::kText}}, kProtocolError, "text in binary");
  expectClosed({{.opcode = Opcode::kContinuation}}, kProtocolError, "the end of nothing");
  expectClosed({{.payload = "echo x"}, {.opcode = Opcode::kContinuation, .fin = false}}, kProtocolError,
               "continues after the end");
}

TEST_F(Conformance, AnswersPingsOfEverySizeWithTheirOwnBytes) {
  FrameClient client = peer();
  std::string all(125, '\0');
  std::iota(all.begin(), all.end(), '\x7f');
  for (const std::string& sent : {std::string(), std::string("water"), all}) {
    ASSERT_TRUE(client.send({.opcode = Opcode::kPing, .payload = sent}));
    const auto pong = client.receive();
    ASSERT_TRUE(pong);
    EXPECT_EQ(pong->opcode, Opcode::kPong);
    EXPECT_EQ(pong->payload, sent);
  }
}

TEST_F(Conformance, IgnoresUnsolicitedPongs) {
  FrameClient client = peer();
  ASSERT_TRUE(client.send({.opcode = Opcode::kPong}));
  ASSERT_TRUE(client.send({.opcode = Opcode::kPong, .payload = std::string(125, 'p')}));
  EXPECT_TRUE(isServed(client));
}

TEST_F(Conformance, RefusesLongAndFragmentedControlFrames) {
  for (const Opcode opcode : {Opcode::kPing, Opcode::kPong, Opcode::kClose}) {
    const std::string what = "opcode " + std::to_string(static_cast<int>(opcode));
    const std::string long_payload = "\x03\xe8" + std::string(124, 'x');
    expectClosed({{.opcode = opcode, .payload = long_payload}}, kProtocolError, what + " of 126 bytes");
    expectClosed({{.opcode = opcode, .fin = false}}, kProtocolError, what + " in pieces");
  }
}

TEST_F(Conformance, EchoesEveryCloseCodeThatAClientMaySend) {
  for (const int sent : {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999}) {
    const auto code = static_cast<std::uint16_t>(sent);
    expectClosed({closeFrame(code, "so long \xC3\xA9")}, code, "code " + std::to_string(code));
  }
  EXPECT_TRUE(eventually([&] { return served_.application.closed().size() == 13; }));
  EXPECT_EQ(served_.application.closed()[0].end.reason, "so long \xC3\xA9");
}

TEST_F(Conformance, AnswersACloseWithoutACode) {
  expectClosed({{.opcode = Opcode::kClose}}, 1000, "no code");
  ASSERT_TRUE(eventually([&] { return served_.application.closed().size() == 1; }));
}

TEST_F(Conformance, RefusesForbiddenCloseCodes) {
  for (const int sent : {0, 999, 1004, 1005, 1006, 1014, 1015, 1016, 1100, 2000, 2999, 5000, 9999, 65535}) {
    expectClosed({closeFrame(static_cast<std::uint16_t>(sent))}, kProtocolError, "code " + std::to_string(sent));
  }
  expectClosed({{.opcode = Opcode::kClose, .payload = "\x03"}}, kProtocolError, "half a code");
  expectClosed({closeFrame(5000, "with a reason")}, kProtocolError, "code 5000 with a reason");
}

TEST_F(Conformance, NotesAForbiddenCloseCodeAsAProtocolError) {
  expectClosed({closeFrame(65535)}, kProtocolError, "code 65535");
  ASSERT_TRUE(eventually([&] { return served_.application.closed().size() == 1; }));
  EXPECT_EQ(served_.application.closed()[0].end.code, kProtocolError);
  EXPECT_EQ(served_.application.closed()[0].end.reason, "close code 65535 is above 4999");
}

TEST_F(Conformance, RefusesACloseReasonThatIsNotUtf8) {
  expectClosed({closeFrame(1000, "\xff")}, kProtocolError, "no UTF-8");
  expectClosed({closeFrame(1000, "cut \xe2\x82")}, kProtocolError, "a character that is cut");
}

TEST_F(Conformance, IgnoresBytesAfterAClose) {
  FrameClient client = peer();
  ASSERT_TRUE(client.tcp().send(bytesOf(closeFrame(1000)) + bytesOf({.payload = "echo late"}) +
                                bytesOf({.opcode = Opcode::kReservedData})));
  EXPECT_EQ(client.receiveClose(), 1000);
  EXPECT_TRUE(client.waitClosed());
  ASSERT_TRUE(eventually([&] { return served_.application.closed().size() == 1; }));
  EXPECT_EQ(served_.application.message_count, 0);
}

TEST_F(Conformance, RefusesTextThatIsNotUtf8) {
  for (const char* wrong : {"\xff", "a\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "cut \xe2\x82"}) {
    expectClosed({{.opcode = Opcode::kText, .payload = wrong}}, kBadPayload, "no UTF-8");
  }
  // A character that is split between two frames is whole again in the message, so the message is refused only for
  // being text.
  expectClosed({{.opcode = Opcode::kText, .payload = "\xe2\x82", .fin = false},
                {.opcode = Opcode::kContinuation, .payload = "\xac"}},
               1003, "a character in two pieces");
}

TEST_F(Conformance, RefusesMessagesOverTheLimitInOneFrameOrInMany) {
  expectClosed({{.payload = std::string(100'001, 'x')}}, kTooBig, "in one");
  std::vector<Frame> pieces{{.payload = std::string(60'000, 'x'), .fin = false}};
  pieces.push_back({.opcode = Opcode::kContinuation, .payload = std::string(40'001, 'x')});
  expectClosed(pieces, kTooBig, "in two");
  EXPECT_EQ(served_.application.message_count, 0);
}

/// With a server's default message rate.
struct Fragments : testing::Test {
  test::TestServer served{{.close_timeout = std::chrono::milliseconds(500)}};
  FrameClient client;

  void SetUp() override {
    ASSERT_TRUE(client.connect(served.server->port()));
    ASSERT_TRUE(client.receive());
  }
};

TEST_F(Fragments, AMessageOfTheGreatestSizeMayComeInSingleBytes) {
  std::string frames;
  const std::string whole = "echo " + std::string(ServerOptions{}.read_message_max_bytes - 5, 'x');
  for (std::size_t i = 0; i < whole.size(); ++i) {
    frames += bytesOf({.opcode = i == 0 ? Opcode::kBinary : Opcode::kContinuation,
                       .payload = whole.substr(i, 1),
                       .fin = i + 1 == whole.size()});
  }
  ASSERT_TRUE(client.tcp().send(frames));
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->payload, whole);
}

TEST_F(Fragments, EmptyOnesAreBoundedByTheRateOfMessages) {
  std::string thousand;
  for (int i = 0; i < 1000; ++i) thousand += bytesOf({.opcode = Opcode::kContinuation, .fin = false});
  ASSERT_TRUE(client.send({.payload = "echo ", .fin = false}));
  // A server that read 100 million of them would need minutes; this one stops reading and disconnects.
  int sent_count = 0;
  while (sent_count < 100'000 && client.tcp().send(thousand)) ++sent_count;
  EXPECT_LT(sent_count, 100'000);
  EXPECT_EQ(client.receiveClose(), 1008);
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.reason,
            "too many fragments: send messages in fewer pieces, or slow down");
  EXPECT_EQ(served.application.message_count, 0);
  EXPECT_TRUE(served.serves());
}

TEST_F(Conformance, EndsWhenThePeerHangsUpInsideAFrame) {
  FrameClient client = peer();
  const std::string whole = bytesOf({.payload = echoOf(1000)});
  ASSERT_TRUE(client.tcp().send(whole.substr(0, whole.size() / 2)));
  client.tcp().close();
  ASSERT_TRUE(eventually([&] { return served_.application.closed().size() == 1; }));
  EXPECT_EQ(served_.application.closed()[0].end.code, 0);
  EXPECT_EQ(served_.application.message_count, 0);
}

}  // namespace
}  // namespace spindrift::net
