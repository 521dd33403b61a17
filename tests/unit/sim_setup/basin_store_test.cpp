#include <gtest/gtest.h>

#include <spindrift/sim_setup/basin_store.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

core::Scene sea(double depth_m = 1.0) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = 32;
  scene.wave->side_m = 8.0;
  scene.wave->depth_m = depth_m;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 3.0, .shore_depth_m = 0.0});
  return scene;
}

std::shared_ptr<const BasinTables> tablesOf(BasinStore& store, const core::Scene& scene, bool with_terrain = true) {
  const auto derived = derive(scene);
  EXPECT_TRUE(derived) << derived.error().message;
  return store.of(scene, *derived->wave, with_terrain);
}

TEST(BasinStore, ComputesTheTablesOfASceneOnce) {
  BasinStore store;
  const auto first = tablesOf(store, sea());
  EXPECT_FALSE(first->dispersion.levels.empty());
  EXPECT_FALSE(first->terrain.landing.empty());
  core::Scene other_room = sea();
  other_room.seed = 7;
  other_room.wave->damping_per_s = 0.5;  // no table contains it
  EXPECT_EQ(tablesOf(store, other_room), first);
  EXPECT_EQ(store.madeCount(), 1U);
}

TEST(BasinStore, ComputesThoseOfAnotherBottomAnew) {
  BasinStore store;
  const auto first = tablesOf(store, sea());
  const auto deeper = tablesOf(store, sea(1.5));
  EXPECT_NE(deeper->basin.depth_m, first->basin.depth_m);
  core::Scene heavier = sea();
  heavier.gravity_mps2 = 20.0;
  (void)tablesOf(store, heavier);
  const auto without_terrain = tablesOf(store, sea(), false);
  EXPECT_TRUE(without_terrain->terrain.landing.empty());
  EXPECT_EQ(store.madeCount(), 4U);
}

TEST(BasinStore, ForgetsWhatWasNotAskedForLongestWhenItIsFull) {
  const std::size_t size_bytes = layOutTables(sea(), *derive(sea())->wave, true).sizeBytes();
  EXPECT_GT(size_bytes, 32U * 32U * 100U);
  BasinStore store(2 * size_bytes);
  (void)tablesOf(store, sea(1.0));
  (void)tablesOf(store, sea(1.1));
  (void)tablesOf(store, sea(1.0));
  (void)tablesOf(store, sea(1.2));
  EXPECT_EQ(store.madeCount(), 3U);
  (void)tablesOf(store, sea(1.0));
  EXPECT_EQ(store.madeCount(), 3U);
  (void)tablesOf(store, sea(1.1));
  EXPECT_EQ(store.madeCount(), 4U) << "forgotten";
}

TEST(BasinStore, DoesNotKeepWhatIsLargerThanItsBound) {
  BasinStore store(1000);
  EXPECT_FALSE(tablesOf(store, sea())->basin.depth_m.empty());
  (void)tablesOf(store, sea());
  EXPECT_EQ(store.madeCount(), 2U);
}

}  // namespace
}  // namespace spindrift::sim
