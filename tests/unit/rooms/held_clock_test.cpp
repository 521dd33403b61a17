#include <gtest/gtest.h>

#include <spindrift/rooms/held_clock.h>
#include <spindrift/rooms/step_book.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

const HeldClock::TimePoint kHeldStart = HeldClock::TimePoint{} + 1h;

core::Sender holderNumber(std::uint32_t number) {
  return {.session_id = 100u + number, .person_id = number};
}

TEST(HeldClock, RoomMakesWhatAllHoldersHaveAskedFor) {
  HeldClock clock;
  EXPECT_FALSE(clock.isHeld());
  EXPECT_EQ(clock.ticksToCome(), 0u);
  ASSERT_TRUE(clock.take(holderNumber(2), "b", {}, kHeldStart));
  clock.ask(holderNumber(2), 5);
  EXPECT_EQ(clock.ticksToCome(), 5u);
  clock.ticked(kHeldStart);
  ASSERT_TRUE(clock.take(holderNumber(1), "a", {}, kHeldStart));
  EXPECT_EQ(clock.ticksToCome(), 0u) << "the newcomer has asked for none";
  clock.ask(holderNumber(1), 10);
  EXPECT_EQ(clock.ticksToCome(), 4u);
  EXPECT_EQ(clock.holders().front().who.person_id, 1u) << "by person";
  clock.dropTicks(kHeldStart);
  EXPECT_EQ(clock.ticksToCome(), 0u);
}

TEST(HeldClock, SpeedIsTheLowestThatIsAskedFor) {
  HeldClock clock;
  ASSERT_TRUE(clock.take(holderNumber(1), "", {.speed = 0.0}, kHeldStart));
  EXPECT_EQ(clock.speed(), 0.0);
  ASSERT_TRUE(clock.take(holderNumber(2), "", {.speed = 4.0}, kHeldStart));
  ASSERT_TRUE(clock.take(holderNumber(3), "", {.speed = 2.0}, kHeldStart));
  EXPECT_EQ(clock.speed(), 2.0);
  ASSERT_TRUE(clock.take(holderNumber(3), "", {.speed = 8.0}, kHeldStart)) << "other terms of the same holder";
  EXPECT_EQ(clock.holders().size(), 3u);
  EXPECT_EQ(clock.speed(), 4.0);
}

TEST(HeldClock, SilenceCountsWhileTheRoomWaits) {
  HeldClock clock;
  ASSERT_TRUE(clock.take(holderNumber(1), "", {.timeout_s = 2.0}, kHeldStart));
  EXPECT_EQ(clock.expiry(), kHeldStart + 2s);
  clock.ask(holderNumber(1), 1);
  EXPECT_EQ(clock.expiry(), std::nullopt) << "it has spoken";
  EXPECT_FALSE(HeldClock::isSilent(clock.holders()[0], kHeldStart + 1h));
  clock.ticked(kHeldStart + 10s);
  EXPECT_FALSE(HeldClock::isSilent(clock.holders()[0], kHeldStart + 11s));
  clock.excuse(holderNumber(1), kHeldStart + 11s);
  EXPECT_FALSE(HeldClock::isSilent(clock.holders()[0], kHeldStart + 12s));
  EXPECT_TRUE(HeldClock::isSilent(clock.holders()[0], kHeldStart + 13s));
  const auto removed = clock.removeIf([](const HeldClock::Holder&) { return true; });
  EXPECT_EQ(removed.size(), 1u);
  EXPECT_FALSE(clock.isHeld());
}

TEST(HeldClock, HoldersAreBounded) {
  HeldClock clock;
  for (std::uint32_t k = 1; k <= kClockHolderMaxCount; ++k)
    ASSERT_TRUE(clock.take(holderNumber(k), "", {}, kHeldStart));
  EXPECT_FALSE(clock.take(holderNumber(99), "", {}, kHeldStart));
  EXPECT_TRUE(clock.take(holderNumber(1), "", {}, kHeldStart)) << "one of them";
}

TEST(StepBook, GivesEachStepBackOnceDoneOrEnded) {
  StepBook book;
  const auto stepOf = [](std::uint32_t number, std::uint64_t id) {
    Command out{.sender = holderNumber(number)};
    out.message.set_command_id(id);
    return out;
  };
  book.enter(stepOf(1, 11), 2);
  book.enter(stepOf(1, 12), 3);
  book.enter(stepOf(2, 21), 3);
  book.ticked();
  EXPECT_TRUE(book.takeDone().empty());
  book.ticked();
  const auto done = book.takeDone();
  ASSERT_EQ(done.size(), 1u);
  EXPECT_EQ(done[0].id(), 11u);
  book.endIf("gone", [](const core::Sender& sender) { return sender.person_id == 1; });
  const auto ended = book.takeEnded();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].command.id(), 12u);
  EXPECT_EQ(ended[0].why, "gone");
  EXPECT_TRUE(book.takeEnded().empty());
  book.ticked();
  EXPECT_EQ(book.takeDone().at(0).id(), 21u);
  book.endAll("over");
  EXPECT_TRUE(book.takeEnded().empty());
}

TEST(StepBook, IsFullPerSession) {
  StepBook book;
  for (std::size_t k = 0; k < kWaitingStepMaxCount; ++k) book.enter({.sender = holderNumber(1)}, 1);
  EXPECT_TRUE(book.isFull(holderNumber(1)));
  EXPECT_FALSE(book.isFull(holderNumber(2)));
}

}  // namespace
}  // namespace spindrift::rooms
