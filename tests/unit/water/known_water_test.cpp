// Water of a scene that was built before.
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim_setup/basin_store.h>
#include <spindrift/water/water.h>

#include "harbor_scene.h"

namespace spindrift::water {
namespace {

class KnownWater : public testing::Test {
 protected:
  void SetUp() override {
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    auto scene = scene::parseSceneText(kHarbor, "harbor");
    ASSERT_TRUE(scene) << scene.error().message;
    scene_ = *std::move(scene);
    auto first = build({});
    if (!first && first.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << first.error().message;
    ASSERT_TRUE(first) << first.error().message;
    first_ = *std::move(first);
    first_->release();
  }
  core::Result<std::unique_ptr<Water>> build(const WarmUp& warm_up) {
    return Water::create(device_, scene_, {.basins = &basins_, .warm_up = warm_up});
  }
  static std::uint64_t hashAfter20Ticks(Water& water) {
    water.bind();
    for (int k = 0; k < 20; ++k) water.sim().step();
    const std::uint64_t hash = water.sim().stateHash();
    water.release();
    return hash;
  }

  gpu::DeviceChoice device_;
  v1::Scene scene_;
  sim::BasinStore basins_;
  std::unique_ptr<Water> first_;
};

TEST_F(KnownWater, ComputesNoTablesAndMakesNoTicks) {
  EXPECT_EQ(basins_.madeCount(), 1U);
  const std::uint64_t warm_count = first_->context().ledger().dispatch_count;
  auto second = build({.first_tick_ms = 30, .least_tick_ms = 10});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(basins_.madeCount(), 1U);
  EXPECT_EQ((*second)->sim().time_s(), 0.0);
  EXPECT_LT(5 * (*second)->context().ledger().dispatch_count, warm_count);
  EXPECT_EQ((*second)->warmUp().least_tick_ms, 10.0);
  const std::uint64_t programs = (*second)->context().ledger().programs_made_count;
  EXPECT_EQ(programs, first_->context().ledger().programs_made_count) << "a context has programs of its own";
}

TEST_F(KnownWater, HasTheSameStateAfterTheSameTicks) {
  const std::uint64_t expected = hashAfter20Ticks(*first_);
  auto second = build({.first_tick_ms = 30, .least_tick_ms = 10});
  ASSERT_TRUE(second) << second.error().message;
  (*second)->release();
  EXPECT_EQ(hashAfter20Ticks(**second), expected);
}

TEST_F(KnownWater, MakesTheTicksIfTheDriverDoesNotKeepShaders) {
  const std::uint64_t warm_count = first_->context().ledger().dispatch_count;
  auto second = build({.first_tick_ms = 4000, .least_tick_ms = 10});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ((*second)->context().ledger().dispatch_count, warm_count);
  EXPECT_NE((*second)->warmUp().least_tick_ms, 10.0);
}

}  // namespace
}  // namespace spindrift::water
