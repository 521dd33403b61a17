#include <gtest/gtest.h>

#include <spindrift/core/demand_table.h>

namespace spindrift::core {
namespace {

using namespace std::chrono_literals;

constexpr DemandTable::TimePoint kNow{10s};

TEST(DemandTable, CountsTheReadersOfEachStreamAndLevel) {
  DemandTable table;
  const int ada = 0, bob = 0, node = 0;
  table.set(3, &ada, DemandTable::Need{.level = Level::kFull});
  table.set(3, &bob, DemandTable::Need{.level = Level::kMedium, .is_newcomer = true});
  table.set(3, &node, DemandTable::Need{.level = Level::kMedium, .watcher_count = 5});
  EXPECT_EQ(table.of(3, kNow)[indexOf(Level::kFull)].watcher_count, 1U);
  EXPECT_EQ(table.of(3, kNow)[indexOf(Level::kMedium)].watcher_count, 6U);
  EXPECT_TRUE(table.of(3, kNow)[indexOf(Level::kMedium)].has_newcomer);
  EXPECT_FALSE(table.of(3, kNow)[indexOf(Level::kFull)].has_newcomer);
  EXPECT_EQ(table.of(4, kNow)[indexOf(Level::kFull)].watcher_count, 0U);
  table.set(3, &bob, DemandTable::Need{.level = Level::kFull});
  table.set(3, &node, std::nullopt);
  EXPECT_EQ(table.of(3, kNow)[indexOf(Level::kFull)].watcher_count, 2U);
  EXPECT_EQ(table.of(3, kNow)[indexOf(Level::kMedium)].watcher_count, 0U);
  EXPECT_FALSE(table.of(3, kNow)[indexOf(Level::kMedium)].has_newcomer);
}

TEST(DemandTable, WantsAKeyframeFromTheTimeOnThatAReaderGives) {
  DemandTable table;
  const int ada = 0, bob = 0;
  const auto wants = [&](DemandTable::TimePoint when) {
    return table.of(3, when)[indexOf(Level::kFull)].wants_keyframe;
  };
  table.set(3, &ada, DemandTable::Need{.keyframe_from = kNow});
  table.set(3, &bob, DemandTable::Need{.keyframe_from = kNow + 1s});
  EXPECT_FALSE(wants(kNow - 1ms));
  EXPECT_TRUE(wants(kNow));
  table.set(3, &ada, DemandTable::Need{});
  EXPECT_FALSE(wants(kNow));
  EXPECT_TRUE(wants(kNow + 1s));
  table.set(3, &bob, std::nullopt);
  EXPECT_FALSE(wants(kNow + 1s));
}

}  // namespace
}  // namespace spindrift::core
