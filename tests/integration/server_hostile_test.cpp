// Broken and hostile clients: they get the reason of the refusal, and other clients are not affected.
#include <random>

#include <spindrift/wire/client_message.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Hostile : public WaveServerTest {
 protected:
  void SetUp() override {
    WaveServerTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    bystander_ = client();
    bystander_->subscribe(v1::LAYER_SURFACE);
  }

  /// Checks that the server still takes commands and sends frames to a well-behaved client.
  bool isFineForOthers() {
    return bystander_->apply(splash(0.01)).has_value() && bystander_->nextFrame(v1::LAYER_SURFACE).has_value();
  }

  /// Sends the bytes after a hello and expects a line of text and a close with 1008.
  void expectRefusal(const std::string& bytes, const std::string& words) {
    ScriptedClient one = client();
    one.ws().sendBinary({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    expectRefusal(one, words);
  }
  void expectRefusal(ScriptedClient& one, const std::string& words) {
    const auto refusal = one.waitFor(v1::ServerMessage::kRefusal);
    ASSERT_TRUE(refusal);
    EXPECT_THAT(refusal->refusal().message(), HasSubstr(words));
    EXPECT_THAT(refusal->refusal().message(), Not(HasSubstr("\n")));
    EXPECT_TRUE(one.ws().waitClosed());
    EXPECT_EQ(one.ws().closeCode(), 1008);
    EXPECT_THAT(one.ws().closeReason(), HasSubstr(words.substr(0, 20)));
    EXPECT_TRUE(isFineForOthers());
  }

  /// A valid client message of some length.
  static std::string validMessage() {
    v1::ClientMessage message;
    *message.mutable_command() = setParameter("wave.damping_per_s", 0.2);
    message.mutable_command()->set_command_id(7);
    return message.SerializeAsString();
  }

  std::optional<ScriptedClient> bystander_;
};

TEST_F(Hostile, WrongMajorVersionIsRefusedWithBothVersions) {
  ScriptedClient one(server().port());
  one.hello({.major = 2});
  expectRefusal(one, "client speaks wire version 2.1, this server 1." + std::to_string(wire::kWireMinor));
}

TEST_F(Hostile, SubscribeBeforeHelloIsRefused) {
  ScriptedClient one(server().port());
  one.subscribe(v1::LAYER_SURFACE);
  expectRefusal(one, "subscribe before hello");
}

TEST_F(Hostile, BytesThatAreNoMessageAreRefused) {
  expectRefusal(std::string(50, '\xff'), "not a spindrift.v1.ClientMessage");
}

TEST_F(Hostile, TruncatedMessageIsRefused) {
  const std::string whole = validMessage();
  expectRefusal(whole.substr(0, whole.size() - 3), "not a spindrift.v1.ClientMessage");
}

TEST_F(Hostile, EmptyMessageIsRefused) {
  expectRefusal("", "message of a kind that this server does not know");
}

TEST_F(Hostile, MessageOfAnUnknownKindIsRefused) {
  // Field 99, length-delimited, empty.
  expectRefusal("\x9a\x06" + std::string(1, '\0'), "message of a kind that this server does not know");
}

TEST_F(Hostile, UndeclaredLayerIsRefused) {
  ScriptedClient one = client();
  one.subscribe(static_cast<v1::Layer>(77));
  expectRefusal(one, "subscribe.layer: 77");
}

TEST_F(Hostile, ANanRateIsRefused) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE, std::nan(""));
  expectRefusal(one, "subscribe.max_rate_hz");
}

TEST_F(Hostile, CommandOfAnUnknownKindIsRejectedOnly) {
  ScriptedClient one = client();
  // ClientMessage.command (3) with command_id (1) = 5 and a field 99.
  const std::string bytes = std::string("\x1a\x05\x08\x05\x9a\x06", 6) + std::string(1, '\0');
  one.ws().sendBinary({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  const auto reject = one.waitFor(v1::ServerMessage::kReject);
  ASSERT_TRUE(reject);
  EXPECT_EQ(reject->reject().reason(), v1::REJECT_REASON_MALFORMED);
  EXPECT_EQ(reject->reject().command_id(), 5u);
  EXPECT_TRUE(one.apply(splash(0.01)));
}

TEST_F(Hostile, TextIsClosedAsUnsupported) {
  ScriptedClient one = client();
  one.ws().sendText("hello");
  EXPECT_TRUE(one.ws().waitClosed());
  EXPECT_EQ(one.ws().closeCode(), 1003);
  EXPECT_TRUE(isFineForOthers());
}

TEST_F(Hostile, MessageOverTheLimitIsClosedAsTooBig) {
  ScriptedClient one = client();
  const core::Bytes bytes(one.greeting().limits().message_max_bytes() + 1, 0);
  one.ws().sendBinary(bytes);
  EXPECT_TRUE(one.ws().waitClosed());
  EXPECT_EQ(one.ws().closeCode(), 1009);
  EXPECT_TRUE(isFineForOthers());
}

TEST_F(Hostile, RandomBytesNeverDisturbAnotherClient) {
  std::mt19937 random(42);
  for (int round = 0; round < 50; ++round) {
    SCOPED_TRACE(round);
    core::Bytes bytes(random() % 300);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    ScriptedClient one = client();
    one.ws().sendBinary(bytes);
    // Either the message is valid and answered, or the session ends with 1008.
    if (!one.barrier()) {
      EXPECT_TRUE(one.ws().closed());
      EXPECT_EQ(one.ws().closeCode(), 1008);
    }
  }
  EXPECT_TRUE(isFineForOthers());
}

TEST_F(Hostile, DamagedCommandIsAnsweredOrRefused) {
  const std::string whole = validMessage();
  std::vector<std::string> messages;
  for (std::size_t length = 0; length < whole.size(); length += 3) messages.push_back(whole.substr(0, length));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    messages.push_back(whole);
    messages.back()[at] = static_cast<char>(messages.back()[at] ^ 0x10);
  }
  for (const std::string& bytes : messages) {
    ScriptedClient one = client();
    one.ws().sendBinary({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (!one.barrier()) {
      EXPECT_TRUE(one.ws().closed());
      EXPECT_EQ(one.ws().closeCode(), 1008);
    }
  }
  EXPECT_TRUE(isFineForOthers());
}

TEST_F(Hostile, FloodEndsTheSessionOnly) {
  ScriptedClient one = client();
  v1::ClientMessage ping;
  ping.mutable_ping()->set_client_time_s(1);
  // Far beyond the limiter's burst; it refills by 200 per second.
  for (int i = 0; i < 100'000 && !one.ws().closed(); ++i) one.send(ping);
  EXPECT_TRUE(one.ws().waitClosed());
  EXPECT_TRUE(isFineForOthers());
}

}  // namespace
}  // namespace spindrift::test
