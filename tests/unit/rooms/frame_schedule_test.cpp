#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/rooms/frame_schedule.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using core::Level;
using TimePoint = FrameSchedule::TimePoint;

const TimePoint kStart{1000s};

TimePoint after(double s) {
  return kStart + std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(s));
}

/// A room whose ticks end `late_s(k)` after they were due.
struct PacedRoom {
  double tick_wall_s = 1.0 / 60;
  double tick_s = 1.0 / 60;
  double speed = 1.0;
  double frame_rate_hz = 30.0;
  double (*late_s)(int tick) = [](int) { return 0.002; };

  /// Returns the levels of each frame in this many wall seconds.
  std::vector<core::LevelSet> frames(double duration_s) const {
    FrameSchedule schedule;
    std::vector<core::LevelSet> out;
    for (int k = 1; k * tick_wall_s <= duration_s; ++k) {
      const auto levels = schedule.afterTick({.time_s = k * tick_s,
                                              .scheduled = after(k * tick_wall_s),
                                              .end = after(k * tick_wall_s + late_s(k)),
                                              .speed = speed,
                                              .frame_rate_hz = frame_rate_hz});
      if (levels) out.push_back(*levels);
    }
    return out;
  }
};

double rateOf(const std::vector<core::LevelSet>& frames, Level level, double duration_s) {
  return static_cast<double>(std::ranges::count_if(frames, [&](const auto& one) { return one.contains(level); })) /
         duration_s;
}

TEST(FrameSchedule, MakesFramesAtTheRateOfTheSceneAtEverySpeed) {
  for (const double speed : {0.25, 1.0, 4.0}) {
    const PacedRoom run{.tick_wall_s = 1.0 / (60 * speed), .speed = speed};
    EXPECT_NEAR(static_cast<double>(run.frames(10).size()) / 10, speed < 0.5 ? 15.0 : 30.0, 0.2) << speed;
  }
}

TEST(FrameSchedule, LevelsTakeFramesAtEqualDistancesWithinTheirRate) {
  struct Case {
    double frame_rate_hz, coarse_hz, fine_hz;
  };
  for (const Case& one : {Case{60, 20, 30}, Case{30, 15, 30}, Case{20, 20, 20}, Case{15, 15, 15}}) {
    const auto frames = PacedRoom{.frame_rate_hz = one.frame_rate_hz}.frames(20);
    EXPECT_NEAR(rateOf(frames, Level::kFull, 20), one.frame_rate_hz, 0.2);
    EXPECT_NEAR(rateOf(frames, Level::kFine, 20), one.fine_hz, 0.2) << one.frame_rate_hz;
    EXPECT_NEAR(rateOf(frames, Level::kCoarse, 20), one.coarse_hz, 0.2) << one.frame_rate_hz;
    const auto every = static_cast<std::size_t>(std::lround(one.frame_rate_hz / one.coarse_hz));
    for (std::size_t k = 0; k < frames.size(); ++k)
      ASSERT_EQ(frames[k].contains(Level::kCoarse), k % every == 0) << "frame " << k << " of " << one.frame_rate_hz;
  }
}

TEST(FrameSchedule, LevelsTakeEveryFrameOfARoomThatMakesFewerThanTheirRate) {
  // A tick takes 0.21 s, and the clock drops its lag.
  const PacedRoom slow{.tick_wall_s = 0.21};
  const auto frames = slow.frames(20);
  EXPECT_NEAR(static_cast<double>(frames.size()) / 20, 1 / 0.21, 0.1);
  for (const core::LevelSet& levels : frames) EXPECT_EQ(levels, core::LevelSet::all());
  // The same room with 18 frames per second, more than half of what the scene says.
  const auto more = PacedRoom{.tick_wall_s = 1.0 / 18, .tick_s = 1.0 / 30}.frames(20);
  for (const core::LevelSet& levels : more) EXPECT_EQ(levels, core::LevelSet::all());
}

TEST(FrameSchedule, TicksThatEndLateDoNotChangeWhichFramesALevelTakes) {
  const PacedRoom run{.late_s = [](int tick) { return tick % 7 == 0 ? 0.04 : 0.001; }};
  const auto frames = run.frames(10);
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(frames[k].contains(Level::kCoarse), k % 2 == 0) << k;
}

TEST(FrameSchedule, FramesFollowTheWallWhereTicksAreVerySlow) {
  // The water advances by a hundredth of real time, so that the next frame in simulated time is seconds away.
  const PacedRoom run{.tick_wall_s = 0.25, .tick_s = 0.0025};
  EXPECT_EQ(run.frames(5).size(), 20u);
}

TEST(FrameSchedule, APausedRoomMakesAFrameEveryQuarterOfASecondForAllLevels) {
  FrameSchedule schedule;
  EXPECT_LE(schedule.idleDue(), kStart) << "at once";
  schedule.idleFrame(kStart);
  EXPECT_EQ(schedule.idleDue(), kStart + 250ms);
  schedule.setIdleDue(kStart + 10ms);
  EXPECT_EQ(schedule.idleDue(), kStart + 10ms);
}

TEST(FrameSchedule, ARestartMakesAFrameAfterTheNextTick) {
  FrameSchedule schedule;
  const auto tick = [](double time_s, double wall_s) {
    return FrameSchedule::Tick{
        .time_s = time_s, .scheduled = after(wall_s), .end = after(wall_s), .speed = 1.0, .frame_rate_hz = 10.0};
  };
  EXPECT_TRUE(schedule.afterTick(tick(0.1, 0.1)));
  EXPECT_FALSE(schedule.afterTick(tick(0.12, 0.12)));
  schedule.restart();
  EXPECT_TRUE(schedule.afterTick(tick(0.01, 0.14)));
}

}  // namespace
}  // namespace spindrift::rooms
