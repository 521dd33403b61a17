#include <gtest/gtest.h>

#include <spindrift/rooms/room_time.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

constexpr double kTick_s = 1.0 / 60.0;
const RoomTime::TimePoint kRoomStart = RoomTime::TimePoint{} + 1h;

RoomTime running() {
  RoomTime time(kTick_s);
  time.start(kRoomStart);
  return time;
}

TEST(RoomTime, IsDueOncePerTickAndMeasuresFullSpeedAsOne) {
  RoomTime time(0.01);
  time.start(kRoomStart);
  EXPECT_EQ(time.due(), kRoomStart);
  for (int i = 0; i < 200; ++i) time.ticked(time.due(), time.due());
  EXPECT_EQ(time.due(), kRoomStart + 2s);
  EXPECT_NEAR(time.realTimeFactor(), 1.0, 1e-9);
}

TEST(RoomTime, SlowsDownAndSaysSoWhenTicksTakeTooLong) {
  RoomTime time(0.01);
  time.start(kRoomStart);
  auto now = kRoomStart;
  for (int i = 0; i < 300; ++i) {
    now += 20ms;
    time.ticked(now, now);
    EXPECT_GE(time.due(), now - 100ms) << "debt is dropped, so that the water never rushes to catch up";
  }
  EXPECT_NEAR(time.realTimeFactor(), 0.5, 1e-6);
}

TEST(RoomTime, CatchesUpAShortHiccup) {
  RoomTime time(0.01);
  time.start(kRoomStart);
  time.ticked(kRoomStart, kRoomStart + 50ms);
  EXPECT_EQ(time.due(), kRoomStart + 10ms);
}

TEST(RoomTime, FollowsTheWantedSpeed) {
  RoomTime time(0.01);
  time.start(kRoomStart);
  time.setSpeed(2.0);
  for (int i = 0; i < 400; ++i) time.ticked(time.due(), time.due());
  EXPECT_NEAR(time.realTimeFactor(), 2.0, 1e-6);
}

TEST(RoomTime, SleepsTwoSecondsAfterTheLastClientLeftAndWakesWithTheNext) {
  RoomTime time = running();
  EXPECT_FALSE(time.watchOver(true, kRoomStart + 1s));
  EXPECT_FALSE(time.watchOver(false, kRoomStart + 2900ms));
  EXPECT_TRUE(time.runs());
  EXPECT_TRUE(time.watchOver(false, kRoomStart + 3s)) << "falls asleep now";
  EXPECT_FALSE(time.watchOver(false, kRoomStart + 4s)) << "told once";
  EXPECT_TRUE(time.isAsleep());
  EXPECT_FALSE(time.watchOver(true, kRoomStart + 60s));
  EXPECT_TRUE(time.runs());
  EXPECT_EQ(time.due(), kRoomStart + 60s) << "without lag";
}

TEST(RoomTime, PausingEndsTheStepsThatWereStillToCome) {
  RoomTime time = running();
  time.setPaused(true, kRoomStart);
  time.setSteps(2);
  EXPECT_FALSE(time.stepped());
  EXPECT_TRUE(time.stepped()) << "the last one";
  time.setSteps(5);
  time.setPaused(true, kRoomStart + 1s);
  EXPECT_EQ(time.stepsToCome(), 0u);
}

TEST(RoomTime, ResumesWithoutLagAfterAPause) {
  RoomTime time = running();
  time.setPaused(true, kRoomStart);
  time.setPaused(false, kRoomStart + 1min);
  EXPECT_EQ(time.due(), kRoomStart + 1min);
}

TEST(RoomTime, MeanFactorLeavesOutTheTimeInWhichTheRoomStoodStill) {
  RoomTime time = running();
  auto now = kRoomStart;
  for (int k = 0; k < 60; ++k) {
    time.beginRound(now);
    time.ticked(now, now + 5ms);
    now += std::chrono::nanoseconds(1s) / 60;
  }
  time.beginRound(now);
  EXPECT_NEAR(time.meanRealTimeFactor(now), 1.0, 0.01);
  time.setPaused(true, now);
  time.beginRound(now + 1h);
  EXPECT_NEAR(time.meanRealTimeFactor(now + 2h), 1.0, 0.01);
  EXPECT_EQ(time.realTimeFactor(), 0.0) << "it stands still";
}

TEST(RoomTime, HeldClockPacesTheTicksThatAreAskedFor) {
  RoomTime time = running();
  time.setHeld(true, kRoomStart);
  EXPECT_FALSE(time.runs());
  time.heldTicked(0.0, kRoomStart + 5ms);
  EXPECT_EQ(time.due(), kRoomStart + 5ms) << "as fast as the machine can: at once";
  time.setHeld(true, kRoomStart);
  for (int k = 0; k < 60; ++k) time.heldTicked(2.0, time.due());
  EXPECT_NEAR(std::chrono::duration<double>(time.due() - kRoomStart).count(), 0.5, 1e-6) << "twice real time";
  time.holdFrom(kRoomStart + 10s);
  EXPECT_EQ(time.due(), kRoomStart + 10s) << "the time in which the room waited is no lag";
  time.beginRound(kRoomStart + 20s);
  EXPECT_EQ(time.realTimeFactor(), 0.0) << "it waits";
  time.setHeld(false, kRoomStart + 20s);
  EXPECT_TRUE(time.runs());
  EXPECT_EQ(time.due(), kRoomStart + 20s) << "its own clock runs again, without lag";
}

TEST(RoomTime, OtherWaterKeepsSpeedAndPauseAndStepsWhereTheyContinue) {
  for (const bool keeps_steps : {false, true}) {
    RoomTime time = running();
    time.setSpeed(2.0);
    time.setPaused(true, kRoomStart);
    time.setSteps(3);
    time.restart(2 * kTick_s, keeps_steps, kRoomStart + 1s);
    EXPECT_EQ(time.speed(), 2.0);
    EXPECT_TRUE(time.isPaused());
    EXPECT_EQ(time.stepsToCome(), keeps_steps ? 3u : 0u);
  }
}

}  // namespace
}  // namespace spindrift::rooms
