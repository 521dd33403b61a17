#include <gtest/gtest.h>

#include <spindrift/rooms/room_time.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
const RealTimeClock::TimePoint kClockStart{1000s};

TEST(RealTimeClock, IsDueOncePerTickAndMeasuresFullSpeedAsOne) {
  RealTimeClock clock(0.01);
  clock.restart(kClockStart);
  EXPECT_EQ(clock.due(), kClockStart);
  for (int i = 0; i < 200; ++i) clock.ticked(clock.due());
  EXPECT_EQ(clock.due(), kClockStart + 2s);
  EXPECT_NEAR(clock.realTimeFactor(), 1.0, 1e-9);
}

TEST(RealTimeClock, SlowsDownAndSaysSoWhenTicksTakeTooLong) {
  RealTimeClock clock(0.01);
  clock.restart(kClockStart);
  auto now = kClockStart;
  for (int i = 0; i < 300; ++i) {
    now += 20ms;
    clock.ticked(now);
    EXPECT_GE(clock.due(), now - 100ms) << "debt is dropped, so that the water never rushes to catch up";
  }
  EXPECT_NEAR(clock.realTimeFactor(), 0.5, 1e-6);
}

TEST(RealTimeClock, CatchesUpAShortHiccup) {
  RealTimeClock clock(0.01);
  clock.restart(kClockStart);
  clock.ticked(kClockStart + 50ms);
  EXPECT_EQ(clock.due(), kClockStart + 10ms);
}

TEST(RealTimeClock, FollowsTheWantedSpeed) {
  RealTimeClock clock(0.01);
  clock.restart(kClockStart);
  clock.setSpeed(2.0);
  for (int i = 0; i < 400; ++i) clock.ticked(clock.due());
  EXPECT_NEAR(clock.realTimeFactor(), 2.0, 1e-6);
}

}  // namespace
}  // namespace spindrift::rooms
