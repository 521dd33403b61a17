// What an outbox sends of answers and states, and when it wakes and closes: one rule per test. Frames:
// outbox_frames_test.cpp.
#include "outbox_fixture.h"

namespace spindrift::net {
namespace {

using test::shared;

TEST_F(OutboxTest, SendsAnswersInOrder) {
  const auto first = shared("1");
  const auto second = shared("2");
  outbox.pushAnswer(first);
  outbox.pushAnswer(second);
  EXPECT_EQ(outbox.next().message, first);
  EXPECT_EQ(outbox.next().message, second);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, SendsControlBeforeData) {
  watch(1);
  outbox.offerFrame(1, {shared("frame"), {}}, later());
  outbox.pushAnswer(shared("control"));
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kFrame);
}

TEST_F(OutboxTest, TheNewestStateReplacesTheOlderOne) {
  outbox.pushState({.name = "people"}, shared("people 1"));
  outbox.pushAnswer(shared("answer"));
  outbox.pushState({.name = "boats"}, shared("boats"));
  outbox.pushState({.name = "people"}, shared("people 2"));
  EXPECT_EQ(sentText(outbox), "people 2") << "the client has read a state at least as new as the answer";
  EXPECT_EQ(sentText(outbox), "answer");
  EXPECT_EQ(sentText(outbox), "boats");
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, HoldsOneMessagePerTopicAndNeverCloses) {
  for (int k = 0; k < 10'000; ++k) {
    EXPECT_FALSE(outbox.pushState({.name = "topic " + std::to_string(k % 3)}, shared("state")).overflow);
  }
  EXPECT_EQ(outbox.waiting().state_count, 3U);
  EXPECT_FALSE(outbox.closing());
}

TEST_F(OutboxTest, AWholeStateReplacesItsPartsAndIsNotReplacedByThem) {
  using Scope = StateTopic::Scope;
  const StateTopic part{.name = "speed", .scope = Scope::kPart};
  const StateTopic whole{.name = "greeting", .scope = Scope::kWhole};
  outbox.pushState(part, shared("speed 1"));
  outbox.pushState({.name = "people"}, shared("people"));
  outbox.pushState({.name = "boats", .scope = Scope::kPart}, shared("boats"));
  outbox.pushState(whole, shared("greeting 1"));
  outbox.pushState(part, shared("speed 2"));
  EXPECT_EQ(outbox.waiting().state_count, 3U);
  outbox.pushState(whole, shared("greeting 2"));
  outbox.pushState(part, shared("speed 3"));
  EXPECT_EQ(sentText(outbox), "greeting 2");
  EXPECT_EQ(sentText(outbox), "people");
  EXPECT_EQ(sentText(outbox), "speed 3") << "newer than the greeting, so after it";
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
}

TEST_F(OutboxTest, AFrameWaitsForABoundedNumberOfControlMessages) {
  Outbox wide(1000);
  wide.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz});
  for (int k = 0; k < 100; ++k) wide.pushAnswer(shared("answer"));
  wide.offerFrame(1, {shared("frame"), {}}, later());
  std::size_t control_count = 0;
  while (kind(wide) == Outbox::Kind::kControl) ++control_count;
  EXPECT_EQ(control_count, Outbox::kControlRunMaxCount);
}

TEST_F(OutboxTest, AFrameNeverOvertakesAWholeState) {
  Outbox wide(1000);
  wide.setWatch(1, Watch{.max_rate_hz = kAnyRate_hz});
  for (int k = 0; k < 100; ++k) wide.pushAnswer(shared("answer"));
  wide.pushState({.name = "greeting", .scope = StateTopic::Scope::kWhole}, shared("greeting"));
  wide.offerFrame(1, {shared("frame of the new scene"), {}}, later());
  for (int k = 0; k < 100; ++k) ASSERT_EQ(sentText(wide), "answer");
  EXPECT_EQ(sentText(wide), "greeting");
  EXPECT_EQ(kind(wide), Outbox::Kind::kFrame);
}

TEST_F(OutboxTest, TakesAlongWhatWouldBeNext) {
  watch(1);
  watch(2);
  outbox.pushAnswer(shared("answer 1"));
  outbox.pushAnswer(shared("answer 2"));
  outbox.offerFrame(1, {shared("frame 1"), {}}, later());
  outbox.offerFrame(2, {shared("frame 2"), {}}, later());
  EXPECT_EQ(sentText(outbox), "answer 1");
  std::string sent;
  while (const auto next = outbox.nextAlong(100)) {
    sent.append(next->message->begin(), next->message->end()).append(", ");
  }
  EXPECT_EQ(sent, "answer 2, frame 1, frame 2, ");
  EXPECT_FALSE(outbox.pushAnswer(shared("later")).wake) << "the writer is busy, it does not sleep";
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
}

TEST_F(OutboxTest, TakesNothingAlongThatIsTooLarge) {
  watch(1);
  outbox.pushAnswer(shared("12345"));
  outbox.offerFrame(1, {shared("1234567"), {}}, later());
  EXPECT_FALSE(outbox.nextAlong(4));
  EXPECT_TRUE(outbox.nextAlong(5));
  EXPECT_FALSE(outbox.nextAlong(6));
  EXPECT_EQ(outbox.waiting().frame_count, 1U);
  EXPECT_TRUE(outbox.nextAlong(7));
  EXPECT_FALSE(outbox.nextAlong(7));
}

TEST_F(OutboxTest, ClosesAfterWhatItTookAlong) {
  outbox.pushAnswer(shared("1"));
  outbox.pushAnswer(shared("2"));
  EXPECT_TRUE(outbox.requestClose(CloseCode::kNormal, "enough"));
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
  EXPECT_TRUE(outbox.nextAlong(100));
  EXPECT_FALSE(outbox.nextAlong(100)) << "a close is not a message";
  EXPECT_EQ(kind(outbox), Outbox::Kind::kClose);
  outbox.shut();
  EXPECT_FALSE(outbox.nextAlong(100));
}

TEST_F(OutboxTest, WakesASleepingWriterOnce) {
  EXPECT_FALSE(outbox.pushAnswer(shared("before the writer slept")).wake);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  EXPECT_TRUE(outbox.pushAnswer(shared("1")).wake);
  EXPECT_FALSE(outbox.pushAnswer(shared("2")).wake);
}

TEST_F(OutboxTest, FramesWakeTheWriterWhenTheirMomentIsComplete) {
  watch(1);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  EXPECT_FALSE(outbox.wakeForFrames()) << "none waits";
  EXPECT_FALSE(outbox.offerFrame(1, {shared("frame"), {}}, later()).wake);
  EXPECT_TRUE(outbox.wakeForFrames());
  EXPECT_FALSE(outbox.wakeForFrames()) << "it is awake";
  EXPECT_EQ(kind(outbox), Outbox::Kind::kFrame);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kIdle);
  outbox.offerFrame(1, {shared("frame"), {}}, later());
  EXPECT_TRUE(outbox.pushAnswer(shared("answer")).wake) << "an answer does not wait for the frames";
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
}

TEST_F(OutboxTest, ClosesWhenTooManyAnswersWait) {
  Outbox narrow(2);
  EXPECT_FALSE(narrow.pushAnswer(shared("1")).overflow);
  EXPECT_FALSE(narrow.pushAnswer(shared("2")).overflow);
  EXPECT_TRUE(narrow.pushAnswer(shared("3")).overflow);
  EXPECT_FALSE(narrow.pushAnswer(shared("4")).overflow) << "the overflow is reported once";
  ASSERT_TRUE(narrow.closeRequest());
  EXPECT_EQ(narrow.closeRequest()->code, 1013);
  EXPECT_EQ(kind(narrow), Outbox::Kind::kControl);
  EXPECT_EQ(kind(narrow), Outbox::Kind::kControl);
  EXPECT_EQ(kind(narrow), Outbox::Kind::kClose);
}

TEST_F(OutboxTest, SendsControlButNoFramesBeforeClosing) {
  watch(1);
  outbox.offerFrame(1, {shared("frame"), {}}, later());
  outbox.pushAnswer(shared("last words"));
  EXPECT_TRUE(outbox.requestClose(CloseCode::kNormal, "first"));
  EXPECT_FALSE(outbox.requestClose(CloseCode::kPolicy, "second"));
  outbox.offerFrame(1, {shared("frame"), {}}, later());
  outbox.pushAnswer(shared("too late"));
  EXPECT_EQ(kind(outbox), Outbox::Kind::kControl);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kClose);
  EXPECT_EQ(outbox.closeRequest()->reason, "first");
}

TEST_F(OutboxTest, KeepsNothingOnceClosed) {
  const auto message = shared("message");
  watch(1);
  outbox.pushAnswer(message);
  outbox.offerFrame(1, {message, {}}, later());
  outbox.shut();
  outbox.pushAnswer(message);
  EXPECT_EQ(message.use_count(), 1);
  EXPECT_EQ(kind(outbox), Outbox::Kind::kShut);
}

}  // namespace
}  // namespace spindrift::net
