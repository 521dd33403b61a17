// Commands over a real connection: applied at a tick, answered once, visible in the water.
#include <map>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class Commands : public ServerTest {};
class WaveCommands : public WaveServerTest {};

/// Returns whether the room's surface rises above `wanted_m` within a few seconds of simulated time.
bool surfaceRises(ScriptedClient& client, double wanted_m) {
  for (int i = 0; i < 300; ++i) {
    const auto frame = client.nextFrame(v1::LAYER_SURFACE);
    if (!frame) return false;
    if (maxElevation_m(*frame) > wanted_m) return true;
  }
  return false;
}

TEST_F(Commands, SplashMovesAStillSurfaceAfterItsTick) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  for (int i = 0; i < 5; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    ASSERT_EQ(maxElevation_m(*frame), 0.0) << "not still at tick " << frame->tick();
  }
  const auto applied = one.apply(splash());
  ASSERT_TRUE(applied);
  EXPECT_TRUE(surfaceRises(one, 0.05));
}

TEST_F(WaveCommands, BreakingWaveMovesTheSurfaceForAllClients) {
  ScriptedClient asks = client();
  ScriptedClient watches = client();
  watches.subscribe(v1::LAYER_SURFACE);
  const auto before = watches.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(before);
  EXPECT_EQ(maxElevation_m(*before), 0.0);
  v1::Command wave;
  wave.mutable_breaking_wave()->set_side(v1::SIDE_PLUS_X);
  wave.mutable_breaking_wave()->set_amplitude_m(0.4);
  ASSERT_TRUE(asks.apply(wave));
  EXPECT_TRUE(surfaceRises(watches, 0.05));
}

TEST_F(WaveCommands, AreAppliedAtTicksThatGrow) {
  ScriptedClient one = client();
  const auto first = one.apply(splash());
  ASSERT_TRUE(first);
  ASSERT_TRUE(one.runFor(1));
  const auto second = one.apply(splash());
  ASSERT_TRUE(second);
  EXPECT_GT(*second, *first);
}

TEST_F(WaveCommands, GetExactlyOneAnswerEachInOrder) {
  ScriptedClient one = client();
  constexpr std::uint64_t kCount = 100;
  for (std::uint64_t id = 1; id <= kCount; ++id) {
    v1::ClientMessage message;
    *message.mutable_command() = id % 2 == 0 ? splash(0.01) : setSpeed(1.0);
    message.mutable_command()->set_command_id(1000 + id);
    one.send(message);
  }
  std::map<std::uint64_t, int> answers;
  std::uint64_t last_id = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const auto answer = one.waitFor([](const v1::ServerMessage& m) { return m.has_ack() || m.has_reject(); });
    ASSERT_TRUE(answer);
    if (answer->has_reject()) {
      EXPECT_EQ(answer->reject().reason(), v1::REJECT_REASON_BUSY) << answer->reject().message();
    }
    const std::uint64_t id = answer->has_ack() ? answer->ack().command_id() : answer->reject().command_id();
    EXPECT_GT(id, last_id);
    last_id = id;
    ++answers[id];
  }
  EXPECT_EQ(answers.size(), kCount);
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kAck)) << "an answer too many";
}

TEST_F(WaveCommands, BeforeHelloAreRejected) {
  ScriptedClient one(server().port());
  const v1::Reject reject = one.rejected(splash());
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_NO_HELLO);
  EXPECT_THAT(reject.message(), HasSubstr("hello"));
  one.hello();
  EXPECT_TRUE(one.apply(splash())) << "the session continues";
}

TEST_F(WaveCommands, EffectOutsideTheSceneIsRejectedWithItsBound) {
  ScriptedClient one = client();
  const v1::Reject deep = one.rejected(splash(0.95));
  EXPECT_EQ(deep.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(deep.field(), "splash.depth_m");
  EXPECT_THAT(deep.message(), HasSubstr("0.95 m"));
  EXPECT_THAT(deep.message(), HasSubstr("at most 0.9 m"));

  v1::Command outside = splash();
  outside.mutable_splash()->set_x_m(4.5);
  const v1::Reject reject = one.rejected(outside);
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(reject.field(), "splash.x_m");
  EXPECT_THAT(reject.message(), HasSubstr("4.5 m"));

  outside.mutable_splash()->set_x_m(std::nan(""));
  EXPECT_EQ(one.rejected(outside).reason(), v1::REJECT_REASON_NOT_FINITE);

  const v1::Reject fast = one.rejected(setSpeed(100));
  EXPECT_EQ(fast.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(fast.field(), "set_speed.speed");
  EXPECT_THAT(fast.message(), HasSubstr("100"));
  EXPECT_THAT(fast.message(), HasSubstr("4"));
}

TEST_F(WaveCommands, CommandWithoutAnActionIsRejected) {
  ScriptedClient one = client();
  EXPECT_EQ(one.rejected(v1::Command{}).reason(), v1::REJECT_REASON_MALFORMED);
  EXPECT_TRUE(one.apply(splash()));
}

TEST_F(WaveCommands, PauseAndResumeAreSentToAllClientsWithThePersonWhoCausedThem) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ASSERT_TRUE(one.apply(setPaused(true)));
  for (ScriptedClient* each : {&one, &two}) {
    const auto state = each->waitFor(v1::ServerMessage::kRoomState);
    ASSERT_TRUE(state);
    EXPECT_TRUE(state->room_state().paused());
    EXPECT_EQ(state->room_state().speed(), 1.0);
    EXPECT_EQ(state->room_state().person_id(), one.welcome().person_id());
  }
  ASSERT_TRUE(two.apply(setPaused(false)));
  for (ScriptedClient* each : {&one, &two}) {
    const auto state = each->waitFor(v1::ServerMessage::kRoomState);
    ASSERT_TRUE(state);
    EXPECT_FALSE(state->room_state().paused());
    EXPECT_EQ(state->room_state().person_id(), two.welcome().person_id());
  }
}

TEST_F(WaveCommands, PauseHoldsTheTickOfItsAck) {
  ScriptedClient one = client();
  const auto paused = one.apply(setPaused(true));
  ASSERT_TRUE(paused);
  one.subscribe(v1::LAYER_SURFACE);
  for (int i = 0; i < 2; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->tick(), *paused);
  }
  EXPECT_EQ(one.apply(splash()), paused) << "commands are still taken";
  EXPECT_EQ(one.apply(setPaused(false)), paused);
  for (int i = 0; i < 100; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    if (frame->tick() > *paused) return;
  }
  FAIL() << "the room does not continue after a pause";
}

TEST_F(WaveCommands, ResumeSendsFramesAtOnce) {
  ScriptedClient one = client();
  constexpr int kTicksPerFrame = 6;
  ASSERT_TRUE(one.apply(setParameter("stream.frame_rate_hz", 60.0 / kTicksPerFrame)));
  one.subscribe(v1::LAYER_SURFACE);
  const auto paused = one.apply(setPaused(true));
  ASSERT_TRUE(paused);
  constexpr int kIdleFrameCount = 5;
  for (int i = 0; i < kIdleFrameCount; ++i) ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  // A room that counted the idle frames would now stay silent for as many frame intervals.
  ASSERT_TRUE(one.apply(setPaused(false)));
  const auto frame = one.waitFor(
      [&](const v1::ServerMessage& message) { return message.has_frame() && message.frame().tick() > *paused; });
  ASSERT_TRUE(frame);
  EXPECT_LT(frame->frame().tick(), *paused + kIdleFrameCount * kTicksPerFrame);
}

TEST_F(WaveCommands, SpeedIsSentToAllClients) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ASSERT_TRUE(one.apply(setSpeed(2.5)));
  for (ScriptedClient* each : {&one, &two}) {
    const auto state = each->waitFor(v1::ServerMessage::kRoomState);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->room_state().speed(), 2.5);
    EXPECT_FALSE(state->room_state().paused());
  }
  EXPECT_EQ(client().greeting().room_state().speed(), 2.5) << "newcomers learn it from the greeting";
}

TEST_F(WaveCommands, ResetKeepsParameters) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  two.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.apply(setParameter("wave.damping_per_s", 0.5)));
  ASSERT_TRUE(one.apply(splash()));
  ASSERT_TRUE(surfaceRises(two, 0.05));
  ASSERT_TRUE(one.runFor(30));

  const auto applied = one.apply(reset());
  ASSERT_TRUE(applied);
  const auto frame = two.waitFor(
      [](const v1::ServerMessage& message) { return message.has_frame() && maxElevation_m(message.frame()) == 0.0; });
  ASSERT_TRUE(frame);
  EXPECT_GT(frame->frame().tick(), *applied) << "ticks continue, time begins again";
  EXPECT_NEAR(frame->frame().time_s(), static_cast<double>(frame->frame().tick() - *applied) / 60.0, 1e-9);
  EXPECT_EQ(client().greeting().scene().wave().damping_per_s(), 0.5);
  EXPECT_TRUE(one.apply(splash()));
  EXPECT_TRUE(surfaceRises(two, 0.05)) << "the room continues after a reset";
}

}  // namespace
}  // namespace spindrift::test
