#include <gtest/gtest.h>

#include <spindrift/water/tick_cost.h>

#include "temporary_folder.h"

namespace spindrift::water {
namespace {

constexpr const char* kPond = "wave { resolution_count: 96 side_m: 14 depth_m: 2 fixed_substeps_count: 4 }";
constexpr const char* kErrors = R"(
  measured_on: "2026-11-25" commit: "51d53aa1"
  scenes { name: "lake" error_ratios: [1, 1, 1, 1] }
  scenes { name: "pond" error_ratios: [0.25, 0.125, 0.0625, 0] })";

class LevelCostsOfAFolder : public testing::Test {
 protected:
  LevelCostsOfAFolder() {
    folder_.write("pond.textproto", kPond);
    folder_.write("fidelity_errors.txtpb", kErrors);
  }
  [[nodiscard]] SceneCatalog catalog() const { return SceneCatalog(folder_.path()); }
  static v1::FidelityLevels levelsOf(const SceneCatalog& scenes, v1::Fidelity present, double tick_ms) {
    const auto now = scenes.load("pond", present);
    EXPECT_TRUE(now) << now.error().message;
    const auto work = workAt(scenes, *now, present);
    EXPECT_TRUE(work) << work.error().message;
    TickCost cost;
    cost.restart(tick_ms, *work);
    return LevelCosts(scenes, *now).predict(cost);
  }

  test::TemporaryFolder folder_;
};

TEST_F(LevelCostsOfAFolder, GrowWithTheWorkFromTheMeasuredTick) {
  const v1::FidelityLevels levels = levelsOf(catalog(), v1::FIDELITY_BALANCED, 2.0);
  ASSERT_EQ(levels.levels_size(), 4);
  const double tick_s = workAt(catalog(), *catalog().load("pond"), v1::FIDELITY_BALANCED)->tick_s;
  EXPECT_EQ(levels.levels(1).fidelity(), v1::FIDELITY_BALANCED);
  EXPECT_DOUBLE_EQ(levels.levels(1).cost_ms_per_s(), 2.0 / tick_s);
  // Cells per side: half, one and a half, two and a half times as many; at REFERENCE ticks are half as long.
  EXPECT_NEAR(levels.levels(0).cost_ms_per_s(), 0.25 * 2.0 / tick_s, 1e-6);
  EXPECT_NEAR(levels.levels(2).cost_ms_per_s(), 2.25 * 2.0 / tick_s, 1e-6);
  EXPECT_NEAR(levels.levels(3).cost_ms_per_s(), 2 * 6.25 * 2.0 / tick_s, 1e-6);
}

TEST_F(LevelCostsOfAFolder, HaveTheMeasuredErrorsWithTheirDay) {
  const v1::FidelityLevels levels = levelsOf(catalog(), v1::FIDELITY_DRAFT, 1.0);
  EXPECT_EQ(levels.errors_measured_on(), "2026-11-25");
  ASSERT_EQ(levels.levels_size(), 4);
  EXPECT_EQ(levels.levels(0).error_ratio(), 0.25);
  EXPECT_TRUE(levels.levels(3).has_error_ratio());
  EXPECT_EQ(levels.levels(3).error_ratio(), 0.0);
}

TEST_F(LevelCostsOfAFolder, AnotherFileOfTheNameHasNoErrors) {
  const test::TemporaryFolder elsewhere;
  elsewhere.write("mine.textproto", kPond);
  SceneCatalog scenes = catalog();
  scenes.add("pond", folder_.path() / "." / "pond.textproto");
  EXPECT_NE(scenes.errorsOf("pond"), nullptr) << "the same file by another path";
  scenes.add("pond", elsewhere.path() / "mine.textproto");
  EXPECT_EQ(scenes.errorsOf("pond"), nullptr);
  const v1::FidelityLevels levels = levelsOf(scenes, v1::FIDELITY_BALANCED, 1.0);
  EXPECT_EQ(levels.errors_measured_on(), "");
  ASSERT_EQ(levels.levels_size(), 4);
  EXPECT_FALSE(levels.levels(0).has_error_ratio());
}

TEST_F(LevelCostsOfAFolder, OmitALevelThatTheSceneCannotTake) {
  folder_.write("pond.textproto", "wave { resolution_count: 96 side_m: 14 depth_m: 2 fixed_substeps_count: 1 }");
  const v1::FidelityLevels levels = levelsOf(catalog(), v1::FIDELITY_BALANCED, 1.0);
  ASSERT_EQ(levels.levels_size(), 3) << "FINE has too long a step, REFERENCE halves the tick";
  EXPECT_EQ(levels.levels(1).fidelity(), v1::FIDELITY_BALANCED);
  EXPECT_EQ(levels.levels(2).fidelity(), v1::FIDELITY_REFERENCE);
}

TEST_F(LevelCostsOfAFolder, AreEmptyForASceneThatIsNotListed) {
  v1::Scene scene = *catalog().load("pond");
  scene.set_name("sea");
  EXPECT_EQ(LevelCosts(catalog(), scene).predict(TickCost()).levels_size(), 0);
}

}  // namespace
}  // namespace spindrift::water
