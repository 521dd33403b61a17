// What a session receives and may do before Hello, and its rate limits afterwards.
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class HelloDeadline : public WaveServerTest {
 protected:
  void adjust(service::WaterServerOptions& options) const override { options.hello_patience = std::chrono::seconds(1); }
};

TEST_F(HelloDeadline, SessionWithoutHelloIsClosedDespitePings) {
  ScriptedClient silent(server().port());
  ScriptedClient pinging(server().port());
  ASSERT_TRUE(silent.isOpen());
  EXPECT_EQ(silent.greeting().limits().hello_within_s(), 1.0);
  const auto begin = std::chrono::steady_clock::now();
  while (pinging.barrier()) {
    ASSERT_LT(std::chrono::steady_clock::now() - begin, kPatience);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // far below the message rate
  }
  EXPECT_EQ(pinging.ws().closeCode(), 1008);
  EXPECT_THAT(pinging.ws().closeReason(), HasSubstr("Hello did not arrive"));
  EXPECT_TRUE(silent.ws().waitClosed());
  EXPECT_EQ(silent.ws().closeCode(), 1008);
}

TEST_F(HelloDeadline, ASessionThatSaidHelloStays) {
  ScriptedClient one = client();
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_TRUE(one.apply(splash(0.01)));
}

class BeforeHello : public WaveServerTest {
 protected:
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse("operator token-of-some-operator\n", "tokens", std::nullopt);
    ASSERT_TRUE(access);
    options.access.access = *access;
  }
};

TEST_F(BeforeHello, NamesAndStateMessagesAreNotSent) {
  ScriptedClient known = person({.name = "Ada", .token = "token-of-some-operator"});
  ASSERT_NE(known.welcome().person_id(), 0u);
  ScriptedClient stranger(server().port());
  ASSERT_TRUE(stranger.isOpen());
  ASSERT_TRUE(known.apply(setSpeed(0.5)));
  ASSERT_TRUE(known.apply(setParameter("wave.damping_per_s", 0.3)));
  ScriptedClient other = person({.name = "Bob", .token = "token-of-some-operator"});
  ASSERT_NE(other.welcome().person_id(), 0u);
  ASSERT_TRUE(
      known.waitFor([](const v1::ServerMessage& m) { return m.has_people() && m.people().people_size() == 2; }));
  EXPECT_FALSE(stranger.hasReceived(v1::ServerMessage::kPeople));
  EXPECT_FALSE(stranger.hasReceived(v1::ServerMessage::kRoomState));
  EXPECT_FALSE(stranger.hasReceived(v1::ServerMessage::kParameterChanged));
}

TEST_F(BeforeHello, ChangesSinceTheGreetingAreSentAfterHello) {
  ScriptedClient known = person({.token = "token-of-some-operator"});
  ScriptedClient late(server().port());
  ASSERT_TRUE(late.isOpen());
  ASSERT_TRUE(known.apply(setSpeed(0.5)));
  late.hello({.token = "token-of-some-operator"});
  const auto again = late.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->greeting().room_state().speed(), 0.5);
}

class CommandRate : public WaveServerTest {};

TEST_F(CommandRate, ABurstWithinTheLimitsIsAppliedCompletely) {
  ScriptedClient one = client();
  const auto count = static_cast<std::uint64_t>(one.greeting().limits().command_burst_count());
  ASSERT_EQ(count, 400u);
  for (std::uint64_t k = 1; k <= count; ++k) {
    v1::ClientMessage message;
    *message.mutable_command() = setSpeed(1.0);
    message.mutable_command()->set_command_id(k);
    one.send(message);
  }
  std::set<std::uint64_t> acked;
  while (acked.size() < count) {
    const auto answer = one.waitFor([](const v1::ServerMessage& m) { return m.has_ack() || m.has_reject(); });
    ASSERT_TRUE(answer) << one.ws().closeCode() << " " << one.ws().closeReason();
    ASSERT_TRUE(answer->has_ack()) << answer->reject().message();
    acked.insert(answer->ack().command_id());
  }
  EXPECT_FALSE(one.ws().closed());
}

TEST_F(CommandRate, CommandsBeyondTheRateAreBusy) {
  ScriptedClient one = client();
  const v1::Limits& limits = one.greeting().limits();
  const auto sent_count = static_cast<std::uint64_t>(limits.command_burst_count()) + 200;
  ASSERT_LT(sent_count, limits.message_burst_count());
  for (std::uint64_t k = 1; k <= sent_count; ++k) {
    v1::ClientMessage message;
    message.mutable_command()->mutable_change_scene()->set_name("nowhere");  // rejected either way
    message.mutable_command()->set_command_id(k);
    one.send(message);
  }
  std::uint64_t busy_count = 0;
  for (std::uint64_t k = 1; k <= sent_count; ++k) {
    const auto reject = one.waitFor(v1::ServerMessage::kReject);
    ASSERT_TRUE(reject) << one.ws().closeCode() << " " << one.ws().closeReason();
    if (reject->reject().message().find("commands per second") != std::string::npos) ++busy_count;
  }
  EXPECT_GT(busy_count, 0u);
  EXPECT_TRUE(one.barrier()) << "the session is not closed for that";
  // Twice the burst of messages at once exceeds what the rate adds while they are read.
  v1::ClientMessage ping;
  ping.mutable_ping()->set_client_time_s(1);
  for (int k = 0; k < 100'000 && !one.ws().closed(); ++k) one.send(ping);
  EXPECT_TRUE(one.ws().waitClosed());
}

}  // namespace
}  // namespace spindrift::test
