// Which frames an outbox sends, replaces and drops, by stream, level and rate: one rule per test.
#include "outbox_fixture.h"

namespace spindrift::net {
namespace {

using test::shared;

/// Returns whether the session can take a frame of stream 1 at this time as a keyframe only.
bool wantsKeyframe(const Outbox& outbox, Clock::time_point now) {
  const auto need = outbox.need(1);
  return need && need->keyframe_from && *need->keyframe_from <= now;
}

FrameBytes levelFrame(core::Level level, std::uint32_t reduced_count, bool is_whole = true) {
  return {.keyframe = is_whole ? shared("whole") : nullptr,
          .delta = shared("continuing"),
          .levels = {.level = level, .reduced_count = reduced_count}};
}

TEST_F(OutboxTest, DropsTheOlderFrameOfALayer) {
  watch(1);
  const auto newest = shared("new");
  EXPECT_FALSE(outbox.offerFrame(1, {shared("old"), {}}, later()).dropped);
  EXPECT_TRUE(outbox.offerFrame(1, {newest, {}}, later()).dropped);
  EXPECT_EQ(outbox.next().message, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, HoldsOneFramePerLayer) {
  std::vector<std::weak_ptr<const core::Bytes>> frames;
  watch(1);
  watch(2);
  for (int k = 0; k < 1000; ++k) {
    const auto frame = shared("frame");
    frames.push_back(frame);
    outbox.offerFrame(1 + k % 2, {frame, {}}, later());
  }
  EXPECT_EQ(std::ranges::count_if(frames, [](const auto& frame) { return !frame.expired(); }), 2);
}

TEST_F(OutboxTest, SendsADeltaIfTheClientHasTheFrameBefore) {
  watch(1);
  EXPECT_TRUE(wantsKeyframe(outbox, later())) << "it has nothing yet";
  outbox.offerFrame(1, {{}, shared("2 on 1")}, later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "nothing that it could not read";
  const auto whole = shared("3");
  outbox.offerFrame(1, {whole, shared("3 on 2")}, later());
  EXPECT_FALSE(wantsKeyframe(outbox, later()));
  EXPECT_EQ(outbox.next().message, whole);
  const auto continuing = shared("4 on 3");
  outbox.offerFrame(1, {shared("4"), continuing}, later());
  EXPECT_EQ(outbox.next().message, continuing);
  EXPECT_FALSE(wantsKeyframe(outbox, later()));
}

TEST_F(OutboxTest, ContinuesWithAKeyframeAfterALoss) {
  watch(1);
  outbox.offerFrame(1, {shared("1"), {}}, later());
  EXPECT_TRUE(outbox.offerFrame(1, {{}, shared("2 on 1")}, later()).dropped) << "1 was not sent: 2 has no ground";
  EXPECT_FALSE(wantsKeyframe(outbox, later())) << "the client does not read";
  outbox.offerFrame(1, {{}, shared("3 on 2")}, later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  EXPECT_TRUE(wantsKeyframe(outbox, later())) << "the writer is free again";
  const auto whole = shared("4");
  outbox.offerFrame(1, {whole, shared("4 on 3")}, later());
  EXPECT_EQ(outbox.next().message, whole);
}

TEST_F(OutboxTest, ReplacesAnUnsentFrameByAKeyframeNeverByADelta) {
  watch(1);
  outbox.offerFrame(1, {shared("1"), {}}, later());
  const auto whole = shared("2");
  EXPECT_TRUE(outbox.offerFrame(1, {whole, shared("2 on 1")}, later()).dropped);
  EXPECT_EQ(outbox.next().message, whole);
}

TEST_F(OutboxTest, ASlowerWatchTakesKeyframesOnly) {
  outbox.setWatch(1, Watch{.max_rate_hz = 10.0});
  Clock::time_point now = later();
  std::vector<std::string> taken;
  int asked_count = 0;
  for (int k = 0; k < 30; ++k) {  // 30 frames per second, every third is taken
    now += std::chrono::microseconds(33'333);
    const bool wants_keyframe = wantsKeyframe(outbox, now);
    asked_count += wants_keyframe ? 1 : 0;
    outbox.offerFrame(1, {wants_keyframe ? shared("w") : core::SharedBytes(), shared("c")}, now);
    if (const auto sent = outbox.next().message) taken.emplace_back(sent->begin(), sent->end());
  }
  EXPECT_GE(taken.size(), 9u);
  EXPECT_LE(taken.size(), 12u);
  EXPECT_EQ(static_cast<std::size_t>(asked_count), taken.size());
  for (const std::string& frame : taken) EXPECT_EQ(frame, "w");
}

TEST_F(OutboxTest, TakesFramesOfItsOwnLevelOnly) {
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kMedium});
  outbox.offerFrame(1, levelFrame(core::Level::kFull, 3), later());
  outbox.offerFrame(1, levelFrame(core::Level::kCoarse, 3), later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  outbox.offerFrame(1, levelFrame(core::Level::kMedium, 3), later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kFrame);
  // In a scene that is smaller than the level, the level equals full.
  outbox.offerFrame(1, levelFrame(core::Level::kFull, 1), later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kFrame);
}

TEST_F(OutboxTest, NeverSendsADeltaAcrossLevels) {
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kMedium});
  outbox.offerFrame(1, levelFrame(core::Level::kMedium, 3), later());
  EXPECT_EQ(sentText(outbox), "whole");
  outbox.offerFrame(1, levelFrame(core::Level::kMedium, 3), later());
  EXPECT_EQ(sentText(outbox), "continuing");
  // In another scene the level equals full.
  outbox.offerFrame(1, levelFrame(core::Level::kFull, 1, false), later());
  EXPECT_EQ(sentText(outbox), "nothing");
  EXPECT_TRUE(wantsKeyframe(outbox, later()));
  outbox.offerFrame(1, levelFrame(core::Level::kFull, 1), later());
  EXPECT_EQ(sentText(outbox), "whole");
  outbox.offerFrame(1, levelFrame(core::Level::kFull, 1), later());
  EXPECT_EQ(sentText(outbox), "continuing");
}

TEST_F(OutboxTest, AReducedLevelThatEqualsFullTakesTheFramesThatAreDueForIt) {
  Outbox coarse(8), full(8);
  coarse.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kCoarse});
  full.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz});
  std::string taken;
  for (int k = 0; k < 9; ++k) {
    FrameBytes frame = levelFrame(core::Level::kFull, 0);
    if (k % 3 != 0) frame.levels.due.erase(core::Level::kCoarse);
    EXPECT_FALSE(coarse.offerFrame(1, frame, later()).dropped);
    full.offerFrame(1, frame, later());
    if (const auto message = coarse.next().message) taken.append(std::to_string(k)).append(textOf(message)).append(" ");
    EXPECT_EQ(textOf(full.next().message), k == 0 ? "whole" : "continuing");
  }
  EXPECT_EQ(taken, "0whole 3whole 6whole ") << "a delta needs the frame before";
}

TEST_F(OutboxTest, FramesThatAreNotDueDoNotLowerTheLevel) {
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kMedium, .adapts = true});
  Clock::time_point now = later();
  for (int k = 0; k < 600; ++k) {
    now += std::chrono::microseconds(16'667);
    FrameBytes frame = levelFrame(core::Level::kFull, 1);
    if (k % 2 != 0) frame.levels.due.erase(core::Level::kMedium);
    outbox.offerFrame(1, frame, now);
    if (k % 2 != 0) outbox.next();  // the writer is free again before the next frame that is due
    EXPECT_EQ(outbox.reviewLevel(now), std::nullopt) << k;
  }
}

/// Offers 30 frames per second of the outbox's present level; the writer takes one of `taken_of`.
class LinkOf30Hz {
 public:
  LinkOf30Hz(Outbox& outbox, std::uint32_t reduced_count) : outbox_(outbox), reduced_count_(reduced_count) {}

  std::vector<core::Level> run(int duration_s, int taken_of) {
    std::vector<core::Level> changes;
    for (int k = 0; k < 30 * duration_s; ++k) {
      now_ += std::chrono::microseconds(33'333);
      const core::Level asked = outbox_.need(1)->level;
      outbox_.offerFrame(1, levelFrame(core::effectiveLevel(asked, reduced_count_), reduced_count_), now_);
      if (k % taken_of != 0) continue;
      outbox_.next();
      if (const auto level = outbox_.reviewLevel(now_)) changes.push_back(*level);
    }
    return changes;
  }

 private:
  Outbox& outbox_;
  const std::uint32_t reduced_count_;
  Clock::time_point now_ = later();
};

TEST_F(OutboxTest, LowersAnAdaptingSessionWhoseFramesWaitAndRaisesItAgain) {
  using core::Level;
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .adapts = true});
  LinkOf30Hz link(outbox, 2);
  EXPECT_EQ(link.run(3, 1), std::vector<Level>{}) << "nothing waits";
  EXPECT_EQ(link.run(4, 2), (std::vector{Level::kMedium, Level::kCoarse})) << "every other frame is lost";
  EXPECT_EQ(link.run(4, 1), std::vector<Level>{}) << "patience";
  EXPECT_EQ(link.run(10, 1), (std::vector{Level::kMedium, Level::kFull}));
}

TEST_F(OutboxTest, ASessionThatDoesNotAdaptKeepsItsLevel) {
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kFine});
  LinkOf30Hz link(outbox, 3);
  EXPECT_TRUE(link.run(10, 3).empty());
  EXPECT_EQ(outbox.need(1)->level, core::Level::kFine);
}

TEST_F(OutboxTest, ANewSubscriptionStartsWithAKeyframe) {
  watch(1);
  outbox.offerFrame(1, {shared("1"), {}}, later());
  outbox.next();
  watch(1);
  EXPECT_TRUE(wantsKeyframe(outbox, later()));
}

TEST_F(OutboxTest, TakesLayersInTurn) {
  std::vector<core::SharedBytes> last(4);
  for (StreamIndex stream = 0; stream < 4; ++stream) watch(stream);
  std::vector<std::size_t> order;
  // Every stream is refilled after every send: without taking turns, only the first stream would be sent.
  for (int k = 0; k < 8; ++k) {
    for (StreamIndex stream = 0; stream < 4; ++stream)
      outbox.offerFrame(stream, {last[stream] = shared("f"), {}}, later());
    const auto sent = outbox.next().message;
    order.push_back(static_cast<std::size_t>(std::ranges::find(last, sent) - last.begin()));
  }
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 0, 1, 2, 3}));
}

TEST_F(OutboxTest, IgnoresFramesOfUnwatchedLayers) {
  outbox.offerFrame(3, {shared("frame"), {}}, later());
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, KeepsToTheRateOfEachWatch) {
  outbox.setWatch(1, Watch{.max_rate_hz = 30.0});
  outbox.setWatch(2, Watch{.max_rate_hz = 60.0});
  const Clock::time_point start = later();
  int sent[3] = {};
  for (int k = 0; k < 60; ++k) {
    const auto now = start + std::chrono::microseconds(k * 16'667);
    for (StreamIndex stream = 1; stream <= 2; ++stream) {
      outbox.offerFrame(stream, {shared("f"), {}}, now);
      if (outbox.next().kind == Outbox::Kind::kFrame) ++sent[stream];
    }
  }
  EXPECT_EQ(sent[1], 30);
  EXPECT_EQ(sent[2], 60);
}

TEST_F(OutboxTest, ForgetsTheFrameOfALayerThatStops) {
  watch(1);
  outbox.offerFrame(1, {shared("frame"), {}}, later());
  outbox.setWatch(1, std::nullopt);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, ANewcomerGetsTheNewestFrameOnceAndGoesOnWithTheNextDelta) {
  const FrameBytes newest{.keyframe = shared("newest"), .delta = nullptr};
  const FrameBytes next{.keyframe = nullptr, .delta = shared("delta")};
  const auto now = later();
  outbox.offerNewest(1, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "it does not watch the stream";
  outbox.setWatch(1, Watch{.max_rate_hz = 10.0, .is_first = true});
  EXPECT_TRUE(outbox.need(1)->is_newcomer);
  EXPECT_TRUE(wantsKeyframe(outbox, now));
  EXPECT_TRUE(outbox.offerNewest(1, newest).wake);
  EXPECT_FALSE(outbox.need(1)->is_newcomer);
  EXPECT_FALSE(wantsKeyframe(outbox, now));
  outbox.offerNewest(1, {.keyframe = shared("again"), .delta = nullptr});
  EXPECT_EQ(sentText(outbox), "newest");
  outbox.offerFrame(1, next, now);
  EXPECT_EQ(sentText(outbox), "delta") << "whatever the rate: the frame before did not count";
  outbox.offerFrame(1, next, now);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "from here on the rate holds";
  outbox.offerNewest(1, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "it has had newer frames";
}

TEST_F(OutboxTest, OnlyTheFirstWatchOfALayerMakesANewcomer) {
  const FrameBytes newest{.keyframe = shared("newest"), .delta = nullptr};
  watch(1);
  EXPECT_FALSE(outbox.need(1)->is_newcomer);
  outbox.offerNewest(1, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .level = core::Level::kCoarse, .is_first = true});
  outbox.offerNewest(1, {.keyframe = shared("full"), .delta = nullptr, .levels = {.reduced_count = 1}});
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "a frame of another level";
  outbox.offerNewest(
      1,
      {.keyframe = shared("coarse"), .delta = nullptr, .levels = {.level = core::Level::kCoarse, .reduced_count = 1}});
  EXPECT_EQ(sentText(outbox), "coarse");
  outbox.enterRoom(std::make_shared<core::DemandTable>());
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .is_first = true});
  outbox.enterRoom(nullptr);
  outbox.offerNewest(1, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle) << "it is in another room now";
  outbox.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz, .is_first = true});
  outbox.requestClose(CloseCode::kNormal, "end");
  outbox.offerNewest(1, newest);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kClose);
}

TEST_F(OutboxTest, TheDemandOfItsRoomHasWhatItNeeds) {
  const auto room = std::make_shared<core::DemandTable>(), other = std::make_shared<core::DemandTable>();
  const auto full = core::indexOf(core::Level::kFull);
  const auto in = [&](const std::shared_ptr<core::DemandTable>& table) { return table->of(1, later())[full]; };
  watch(1);
  outbox.enterRoom(room);
  EXPECT_EQ(room->sessionCount(), 1U);
  EXPECT_EQ(in(room).watcher_count, 1U);
  EXPECT_TRUE(in(room).wants_keyframe);
  outbox.offerFrame(1, {shared("1"), {}}, later());
  EXPECT_FALSE(in(room).wants_keyframe);
  outbox.offerFrame(1, {{}, shared("2 on 1")}, later());
  EXPECT_FALSE(in(room).wants_keyframe) << "1 was lost, and the client does not read";
  outbox.next();
  EXPECT_TRUE(in(room).wants_keyframe) << "the writer is free again";
  outbox.enterRoom(nullptr);
  outbox.enterRoom(other);
  EXPECT_EQ(in(room).watcher_count + room->sessionCount(), 0U);
  EXPECT_TRUE(in(other).wants_keyframe);
  outbox.requestClose(CloseCode::kNormal, "");
  EXPECT_FALSE(in(other).wants_keyframe);
  outbox.shut();
  EXPECT_EQ(in(other).watcher_count, 0U);
}

}  // namespace
}  // namespace spindrift::net
