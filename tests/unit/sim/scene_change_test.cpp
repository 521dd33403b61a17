// Changes of a running room: a reset uploads almost nothing, and another number of particles is prepared without the
// device.
#include <cmath>
#include <future>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/boats.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

class SceneChange : public OnDevice {
 protected:
  struct Uploads {
    std::uint64_t count, bytes;
  };
  Uploads uploadsOf(auto&& change) {
    const gpu::Ledger before = ctx_->ledger();
    change();
    const gpu::Ledger& after = ctx_->ledger();
    return {after.upload_count - before.upload_count, after.uploaded_bytes - before.uploaded_bytes};
  }

  /// A harbor: two-way, with ground of different depth, and boats.
  static core::Scene harbor() {
    core::Scene scene = smallScene(600);
    scene.wave->resolution_count = 96;
    scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
    scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
    scene.wave->sponge_width_m = 1.0;
    scene.obstacles = {core::Rock{1.0, 1.0, 0.7, 0.5}, core::Breakwater{-1.0, -2.0, 3.0, 0.5, 30.0, 0.5}};
    scene.beaches = {core::Beach{core::Side::kPlusX, 2.0, 0.0}};
    scene.coupling->mode = core::CouplingMode::kTwoWay;
    scene.coupling->droplet_spacing_m = 0.15;
    scene.boats.emplace();
    scene.boats->boats = {core::Boat{}, core::Boat{.x_m = 2.0}};
    return scene;
  }
};

constexpr std::uint64_t kBoatBytes = sizeof(shared::BoatControls) + sizeof(float) * 4 * BOAT_TEXELS * MIN_BOAT_SLOTS;

TEST_F(SceneChange, AResetUploadsNoTableThatDidNotChange) {
  WaterSim& sim = make(harbor());
  const auto start = sim.stateHash();
  for (int i = 0; i < 10; ++i) sim.step();
  for (int round = 0; round < 3; ++round) {
    const Uploads uploads = uploadsOf([&] { sim.reset(); });
    EXPECT_LE(uploads.count, 3u) << "uniforms, boats, their controls";
    EXPECT_LE(uploads.bytes, sizeof(shared::SimUniforms) + kBoatBytes);
  }
  EXPECT_EQ(sim.stateHash(), start);
}

TEST_F(SceneChange, AResetUploadsParticlesOnceAndNothingElseOfTheirSize) {
  WaterSim& sim = make(smallScene(3000));
  for (int i = 0; i < 10; ++i) sim.step();
  const std::uint64_t position_bytes = 16u * sim.particleCount();
  EXPECT_LE(uploadsOf([&] { sim.reset(); }).bytes, sizeof(shared::SimUniforms) + position_bytes);
}

TEST_F(SceneChange, AnotherDepthUploadsTheTablesOnceAndAnotherDampingDoesNot) {
  core::Scene scene = harbor();
  WaterSim& sim = make(scene);
  const std::uint64_t cells = 96 * 96;
  scene.wave->damping_per_s = 0.7;
  EXPECT_LT(uploadsOf([&] { ASSERT_TRUE(sim.setScene(scene)); }).bytes, cells);
  scene.wave->depth_m = 1.2 * scene.wave->depth_m;
  EXPECT_GE(uploadsOf([&] { ASSERT_TRUE(sim.setScene(scene)); }).bytes, cells * (16 + 8 + 16 + 4));
  EXPECT_LT(uploadsOf([&] { sim.reset(); }).bytes, cells);
}

TEST_F(SceneChange, ChangesAndAResetGiveTheStateOfAFreshStart) {
  core::Scene scene = harbor();
  WaterSim& sim = make(scene);
  for (int i = 0; i < 5; ++i) sim.step();
  scene.wave->depth_m = 1.3;
  scene.gravity_mps2 = 7.0;
  ASSERT_TRUE(sim.setScene(scene));
  sim.reset();
  for (int i = 0; i < 30; ++i) sim.step();
  const StateCopy changed = sim.copyState();
  WaterSim& fresh = make(scene);
  for (int i = 0; i < 30; ++i) fresh.step();
  // Not the hash: the layout of the particles stays that of the first values (SavedState::particles).
  EXPECT_TRUE(changed == fresh.copyState());
}

TEST_F(SceneChange, PreparationOnAnotherThreadGivesTheSameAsOneCall) {
  core::Scene scene = smallScene(1500);
  const auto run = [&](bool apart) {
    core::Scene changed = scene;
    WaterSim& sim = make(scene);
    EXPECT_TRUE(sim.start(core::Splash{0, 0, 1.2, 0.7, 0.2}));
    for (int i = 0; i < 20; ++i) sim.step();
    changed.particles->count = 2900;
    EXPECT_TRUE(sim.relaysParticles(changed));
    if (apart) {
      auto prepared = std::async(std::launch::async, prepareScene, changed, sim.sceneBasis(changed)).get();
      EXPECT_TRUE(prepared);
      EXPECT_TRUE(sim.adopt(*std::move(prepared)));
    } else {
      EXPECT_TRUE(sim.setScene(changed));
    }
    for (int i = 0; i < 20; ++i) sim.step();
    return sim.stateHash();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST_F(SceneChange, TheRoomRunsOnWhileAChangeIsPrepared) {
  core::Scene scene = smallScene(1500);
  WaterSim& sim = make(scene);
  scene.particles->count = 2900;
  const SceneBasis basis = sim.sceneBasis(scene);
  for (int i = 0; i < 10; ++i) sim.step();
  auto prepared = prepareScene(scene, basis);
  ASSERT_TRUE(prepared);
  for (int i = 0; i < 10; ++i) sim.step();
  ASSERT_TRUE(sim.adopt(*prepared));
  EXPECT_EQ(sim.tick(), 20u);
  EXPECT_NEAR(sim.particleCount(), 2900.0, 500.0);
  for (int i = 0; i < 20; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), 0u);
  EXPECT_EQ(sim.health().nonfinite_count + sim.health().escaped_count, 0u);
}

TEST_F(SceneChange, APreparedChangeIsRefusedWhenTheRoomHasChangedSince) {
  const core::Scene before = smallScene(1500);
  core::Scene scene = before;
  WaterSim& sim = make(before);
  scene.particles->count = 2900;
  const auto prepare = [&] { return *prepareScene(scene, sim.sceneBasis(scene)); };
  core::Scene thicker = before;
  thicker.particles->viscosity_pas = 150.0;
  PreparedScene late = prepare();
  ASSERT_TRUE(sim.setScene(thicker));
  const auto refused = sim.adopt(std::move(late));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(refused.error().message, HasSubstr("try again"));
  EXPECT_EQ(sim.scene().particles->viscosity_pas, 150.0);
  late = prepare();
  sim.reset();
  EXPECT_FALSE(sim.adopt(std::move(late)));
  EXPECT_TRUE(sim.adopt(prepare()));
}

TEST_F(SceneChange, AChangeThatKeepsTheParticlesCopiesNoState) {
  core::Scene scene = smallScene(1500);
  WaterSim& sim = make(scene);
  scene.wave->depth_m = 0.9;
  EXPECT_FALSE(sim.relaysParticles(scene));
  const SceneBasis basis = sim.sceneBasis(scene);
  EXPECT_TRUE(basis.state.position.empty() && basis.state.elevation_m.empty());
}

}  // namespace
}  // namespace spindrift::sim
