// Step over a real connection: a paused room advances exactly the requested number of ticks.
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class Step : public WaveServerTest {};

TEST_F(Step, AdvancesAPausedRoomByItsTicks) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  const auto paused = one.apply(setPaused(true));
  ASSERT_TRUE(paused);
  ASSERT_EQ(one.apply(step(7)), paused) << "the tick at which it begins";
  const auto frame = one.waitFor(
      [&](const v1::ServerMessage& message) { return message.has_frame() && message.frame().tick() == *paused + 7; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(one.apply(setSpeed(1.0)), *paused + 7) << "and stops there";
  const auto later = one.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->tick(), *paused + 7);
  EXPECT_NEAR(later->time_s(), static_cast<double>(*paused + 7) / 60.0, 1e-9);
}

TEST_F(Step, StatesOfAPausedRoomHaveDifferentStateIds) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  ASSERT_TRUE(one.apply(setPaused(true)));
  ASSERT_TRUE(one.barrier());
  const auto frameOf = [&](std::uint64_t after) {
    const auto message =
        one.waitFor([&](const v1::ServerMessage& m) { return m.has_frame() && m.frame().state_id() > after; });
    EXPECT_TRUE(message);
    return message ? message->frame() : v1::LayerFrame();
  };
  const v1::LayerFrame before = frameOf(0);
  const auto repeated = one.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->tick(), before.tick()) << "a paused room repeats its frame";
  EXPECT_EQ(repeated->state_id(), before.state_id());
  EXPECT_EQ(repeated->payload(), before.payload());
  const auto diagnostics = one.waitFor(v1::ServerMessage::kDiagnostics);
  ASSERT_TRUE(diagnostics);
  EXPECT_EQ(diagnostics->diagnostics().state_id(), before.state_id());

  ASSERT_TRUE(one.apply(splash()));
  const v1::LayerFrame splashed = frameOf(before.state_id());
  EXPECT_EQ(splashed.tick(), before.tick());
  ASSERT_TRUE(one.apply(step(3)));
  const v1::LayerFrame stepped = frameOf(splashed.state_id() + 2);
  EXPECT_EQ(stepped.tick(), before.tick() + 3);
  EXPECT_EQ(stepped.state_id(), splashed.state_id() + 3) << "each tick is a state";
  ASSERT_TRUE(one.apply(reset()));
  const v1::LayerFrame started = frameOf(stepped.state_id());
  EXPECT_EQ(started.tick(), stepped.tick()) << "the tick alone does not tell";
  EXPECT_EQ(started.time_s(), 0.0);
  EXPECT_NE(started.payload(), stepped.payload());
}

TEST_F(Step, MovesTheWaterAsRunningDoes) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  const auto paused = one.apply(setPaused(true));
  ASSERT_TRUE(paused);
  ASSERT_TRUE(one.apply(splash()));
  ASSERT_TRUE(one.apply(step(30)));
  const auto frame = one.waitFor(
      [&](const v1::ServerMessage& message) { return message.has_frame() && message.frame().tick() == *paused + 30; });
  ASSERT_TRUE(frame);
  EXPECT_GT(maxElevation_m(frame->frame()), 0.01);
}

TEST_F(Step, InARunningRoomIsRejected) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(step(1));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(reject.field(), "step");
  EXPECT_THAT(reject.message(), HasSubstr("pause"));
}

TEST_F(Step, BeyondItsBoundIsRejected) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(setPaused(true)));
  EXPECT_EQ(one.rejected(step(601)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(one.rejected(step(0)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST_F(Step, BeyondTheBoundOfWaitingTicksIsBusy) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(setPaused(true)));
  v1::ClientMessage first;
  *first.mutable_command() = step(600);
  first.mutable_command()->set_command_id(1'000'000);
  one.send(first);
  const v1::Reject reject = one.rejected(step(600));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_BUSY) << reject.message();
  EXPECT_EQ(reject.field(), "step.tick_count");
}

TEST_F(Step, EndsWhenTheRoomRunsAgain) {
  ScriptedClient one = client();
  const auto paused = one.apply(setPaused(true));
  ASSERT_TRUE(paused);
  ASSERT_TRUE(one.apply(step(5)));
  ASSERT_TRUE(one.apply(setPaused(false)));
  EXPECT_TRUE(one.runFor(10));
  const auto again = one.apply(setPaused(true));
  ASSERT_TRUE(again);
  EXPECT_EQ(one.apply(setSpeed(1.0)), again) << "nothing is left to step";
}

}  // namespace
}  // namespace spindrift::test
