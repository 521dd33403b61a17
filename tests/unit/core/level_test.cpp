// Sets of levels, and what the demand by levels means for the data of a frame.
#include <gtest/gtest.h>

#include <spindrift/core/demand_table.h>
#include <spindrift/core/level.h>

namespace spindrift::core {
namespace {

TEST(LevelSet, HoldsWhatWasInserted) {
  LevelSet set;
  for (const Level level : kLevels) EXPECT_FALSE(set.contains(level));
  set.insert(Level::kMedium);
  set.insert(Level::kFull);
  set.insert(Level::kFull);
  EXPECT_TRUE(set.contains(Level::kMedium) && set.contains(Level::kFull));
  EXPECT_FALSE(set.contains(Level::kCoarse) || set.contains(Level::kFine));
  set.erase(Level::kFull);
  set.erase(Level::kFine);
  EXPECT_EQ(set, LevelSet::fromBits(0b0010));
  EXPECT_EQ(LevelSet::all(), LevelSet::fromBits(0b1111));
}

TEST(LevelSet, IgnoresBitsOfUnknownLevels) {
  for (std::uint32_t bits = 0; bits < 16; ++bits) EXPECT_EQ(LevelSet::fromBits(bits).bits(), bits);
  EXPECT_EQ(LevelSet::fromBits(0xFFFFFFFF), LevelSet::all());
}

TEST(Levels, TakeFramesWithinTheirRate) {
  EXPECT_FALSE(takesFrameAfter(Level::kCoarse, 1.0 / 30)) << "20 per second";
  EXPECT_TRUE(takesFrameAfter(Level::kCoarse, 1.0 / 20 - 1e-9));
  EXPECT_TRUE(takesFrameAfter(Level::kCoarse, 1.0 / 5));
  EXPECT_FALSE(takesFrameAfter(Level::kMedium, 1.0 / 60)) << "30 per second";
  EXPECT_TRUE(takesFrameAfter(Level::kMedium, 2.0 / 60));
  EXPECT_TRUE(takesFrameAfter(Level::kFull, 1.0 / 240)) << "no limit";
}

TEST(DemandOfFrame, CountsLevelsThatLeaveNothingOutAsFull) {
  StreamDemand asked{};
  asked[indexOf(Level::kCoarse)] = {.watcher_count = 1};
  asked[indexOf(Level::kMedium)] = {.watcher_count = 2, .wants_keyframe = true};
  asked[indexOf(Level::kFull)] = {.watcher_count = 4, .has_newcomer = true};
  const StreamDemand all_reduced = demandOfFrame(asked, 3);
  for (const Level level : kLevels)
    EXPECT_EQ(all_reduced[indexOf(level)].watcher_count, asked[indexOf(level)].watcher_count);
  const StreamDemand one_reduced = demandOfFrame(asked, 1);
  EXPECT_EQ(one_reduced[indexOf(Level::kCoarse)].watcher_count, 1U);
  EXPECT_EQ(one_reduced[indexOf(Level::kMedium)].watcher_count, 0U);
  const LevelDemand& full = one_reduced[indexOf(Level::kFull)];
  EXPECT_EQ(full.watcher_count, 6U);
  EXPECT_TRUE(full.wants_keyframe && full.has_newcomer);
}

TEST(DemandOfFrame, LeavesOutLevelsThatDoNotTakeTheFrame) {
  StreamDemand asked{};
  asked[indexOf(Level::kCoarse)] = {.watcher_count = 1, .wants_keyframe = true};
  asked[indexOf(Level::kMedium)] = {.watcher_count = 2};
  LevelSet due = LevelSet::all();
  due.erase(Level::kCoarse);
  const LevelDemand full = demandOfFrame(asked, 0, due)[indexOf(Level::kFull)];
  EXPECT_EQ(full.watcher_count, 2U);
  EXPECT_FALSE(full.wants_keyframe);
  due.erase(Level::kMedium);
  for (const LevelDemand& level : demandOfFrame(asked, 0, due)) EXPECT_EQ(level.watcher_count, 0U);
}

}  // namespace
}  // namespace spindrift::core
