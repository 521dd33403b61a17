// The particle patch follows splashes and boats.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

core::Scene patchScene(core::PatchFollow follow) {
  core::Scene scene = smallScene(600);
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 24.0;
  scene.particles->patch_scale = 0.25;
  scene.coupling->patch_follow = follow;
  return scene;
}

class Patch : public OnDevice {
 protected:
  /// Largest distance of a particle from (x, z) along an axis.
  static double reach(const StateCopy& state, double x_m, double z_m) {
    double reach_m = 0;
    for (std::size_t i = 0; i < state.position.size(); i += 4) {
      reach_m = std::max({reach_m, std::abs(state.position[i] - x_m), std::abs(state.position[i + 2] - z_m)});
    }
    return reach_m;
  }
};

TEST_F(Patch, GoesToTheNewestSplashAndStaysOnTheWater) {
  WaterSim& sim = make(patchScene(core::PatchFollow::kEvent));
  for (int i = 0; i < 5; ++i) sim.step();
  EXPECT_LE(reach(sim.copyState(), 0.0, 0.0), 3.01);
  ASSERT_TRUE(sim.start(core::Splash{5.0, -4.0, 1.0, 0.5, 0.2}));
  for (int i = 0; i < 5; ++i) sim.step();
  EXPECT_LE(reach(sim.copyState(), 5.0, -4.0), 3.01);
  ASSERT_TRUE(sim.start(core::Splash{11.0, 11.5, 1.0, 0.5, 0.2}));
  for (int i = 0; i < 60; ++i) sim.step();
  EXPECT_LE(reach(sim.copyState(), 9.0, 9.0), 3.01) << "as near as the patch fits on the water";
  EXPECT_EQ(sim.escapedCount(), 0u);
  EXPECT_EQ(sim.nonfiniteCount(), 0u);
}

TEST_F(Patch, StaysUnderTheFirstBoat) {
  core::Scene scene = patchScene(core::PatchFollow::kBoat);
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{.x_m = -6.0, .max_speed_mps = 2.0, .throttle_ratio = 1.0}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 240; ++i) {
    sim.step();
    if (i % 40) continue;
    const StateCopy state = sim.copyState();
    ASSERT_LE(reach(state, state.boats[0], state.boats[2]), 3.01) << "tick " << i;
  }
  EXPECT_GT(sim.copyState().boats[0], -3.0f) << "it moved";
  EXPECT_EQ(sim.escapedCount(), 0u);
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(Patch, FramesOfAMovingPatchHaveTheCoordinatesOfTheWater) {
  WaterSim& sim = make(patchScene(core::PatchFollow::kEvent));
  ASSERT_TRUE(sim.start(core::Splash{5.0, -4.0, 1.0, 0.5, 0.2}));
  for (int i = 0; i < 10; ++i) sim.step();
  ASSERT_TRUE(sim.requestFrame(FrameRequest::full({.particles = true})));
  ctx_->finish();
  const auto frames = sim.takeFrames();
  const core::ParticleView& p = *frames.at(0).at(core::Level::kFull).particles;
  const StateCopy state = sim.copyState();
  for (std::size_t i = 0; i < p.count; ++i) {
    const double x = p.min_m[0] + (p.words[3 * i] & 0xffff) / 65535.0 * (p.max_m[0] - p.min_m[0]);
    ASSERT_NEAR(x, state.position[4 * i], 24.0 / 65535);
  }
}

TEST_F(Patch, NeedsPeriodicSidesAndABoatToFollow) {
  core::Scene walls = patchScene(core::PatchFollow::kEvent);
  walls.particles->boundary_x = core::Boundary::kWall;
  EXPECT_THAT(derive(walls).error().message, HasSubstr("periodic"));
  EXPECT_THAT(derive(patchScene(core::PatchFollow::kBoat)).error().message, HasSubstr("boats"));
}

}  // namespace
}  // namespace spindrift::sim
