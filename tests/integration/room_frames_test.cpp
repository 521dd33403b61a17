// How often a room makes frames.
#include "room_fixture.h"

namespace spindrift::test {
namespace {

using RoomFrames = RoomTest;

TEST_F(RoomFrames, ComeAtLeastEveryFewTenthsOfASecondHoweverSlowTheTicksAre) {
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

}  // namespace
}  // namespace spindrift::test
