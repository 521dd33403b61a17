// How often a room makes frames.
#include <spindrift/sim_setup/frame_layout.h>

#include "room_fixture.h"

namespace spindrift::test {
namespace {

using RoomFrames = RoomTest;

TEST_F(RoomFrames, FollowWallTimeWhenTicksAreSlow) {
  // On a machine that is far too slow, a round takes as long as a tick: the clock drops its lag and ticks once per
  // round, so that the simulated time between two frames is two rounds or more.
  constexpr int kRoundCount = 10;
  ASSERT_TRUE(runUntil([&] { return outlets_.frame_count > 0; }));
  const std::uint64_t first_tick = room_->tick();
  outlets_.frame_count = 0;
  for (int round = 0; round < kRoundCount; ++round) {
    std::this_thread::sleep_for(220ms);
    room_->run(Clock::now());
  }
  ASSERT_LE(room_->tick(), first_tick + kRoundCount);
  EXPECT_GE(outlets_.frame_count, kRoundCount - 2);
}

TEST_F(RoomFrames, AreDroppedAndNotWaitedForWhileNoneIsEncoded) {
  constexpr std::uint64_t kTickCount = 60;
  outlets_.keeps_frames = true;
  ASSERT_TRUE(runUntil([&] { return outlets_.kept_frames.size() == sim::kFrameSlotCount; }));
  const std::uint64_t tick = room_->tick();
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= tick + kTickCount; })) << "the room continues";
  EXPECT_EQ(outlets_.kept_frames.size(), sim::kFrameSlotCount) << "no more memory is taken";
  EXPECT_TRUE(runUntil([&] { return room_->vitals()->dropped_frame_count > 0; }));
  outlets_.keeps_frames = false;
  outlets_.kept_frames.clear();
  outlets_.frame_count = 0;
  EXPECT_TRUE(runUntil([&] { return outlets_.frame_count > 2; })) << "frames come again";
}

TEST_F(RoomFrames, SayWhichLevelsTakeThem) {
  constexpr std::size_t kFrameCount = 12;
  ASSERT_TRUE(runUntil([&] { return outlets_.ready_levels.size() >= kFrameCount; }));
  const std::vector<core::LevelSet> taken = outlets_.ready_levels;
  core::LevelSet all_but_coarse = core::LevelSet::all();
  all_but_coarse.erase(core::Level::kCoarse);
  // 30 frames per second: 15 of them for the level coarse, which has at most 20. It takes more of them only where the
  // room stood still for a while, as on a busy machine.
  std::size_t coarse_count = 0;
  for (std::size_t k = 0; k < taken.size(); ++k) {
    EXPECT_TRUE(taken[k] == core::LevelSet::all() || taken[k] == all_but_coarse) << k;
    coarse_count += taken[k].contains(core::Level::kCoarse) ? 1 : 0;
    EXPECT_TRUE(taken[k].contains(core::Level::kCoarse) || (k > 0 && taken[k - 1].contains(core::Level::kCoarse))) << k;
  }
  EXPECT_LT(coarse_count, taken.size());

  v1::Command pause;
  pause.mutable_set_paused()->set_paused(true);
  send(1, pause);
  ASSERT_TRUE(runUntil([&] { return !outlets_.applied.empty() && room_->water().framesInFlight() == 0; }));
  outlets_.ready_levels.clear();
  ASSERT_TRUE(runUntil([&] { return outlets_.ready_levels.size() >= 3; }));
  for (const core::LevelSet& levels : outlets_.ready_levels) EXPECT_EQ(levels, core::LevelSet::all());
}

}  // namespace
}  // namespace spindrift::test
