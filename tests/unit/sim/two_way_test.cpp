// Breaking water becomes particles and returns: the volume ledger, calm water, reproducibility.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <shared/fixed_point.h>
#include <shared/groups.h>
#include <shared/pool.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

/// 12 m of water, 64^2 cells, droplets of 12 cm.
core::Scene twoWayScene() {
  core::Scene scene;
  scene.name = "two_way";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 12.0;
  scene.wave->depth_m = 1.0;
  scene.particles.emplace();
  scene.particles->count = 3000;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = 0.12;
  scene.coupling->emission_ratio = 2.0;
  scene.foam.emplace();
  scene.foam->surface = true;
  return scene;
}

class TwoWay : public OnDevice {
 protected:
  /// Steps until the health of the tick has arrived.
  static void stepAndSettle(WaterSim& sim, int ticks) {
    for (int i = 0; i < ticks; ++i) sim.step();
  }
};

TEST_F(TwoWay, ASplashEmitsWaterThatAllReturns) {
  WaterSim& sim = make(twoWayScene());
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  std::uint32_t most = 0;
  double thrown_m = 0;
  for (int i = 0; i < 900; ++i) {
    sim.step();
    most = std::max(most, sim.health().particle_count);
    ASSERT_EQ(sim.health().volume_error_units, 0) << "tick " << sim.health().tick;
    if (i % 20 == 0) {
      const StateCopy state = sim.copyState();
      for (std::size_t k = 1; k < state.position.size(); k += 4)
        thrown_m = std::max(thrown_m, static_cast<double>(state.position[k]));
    }
  }
  EXPECT_GT(most, 20u);
  EXPECT_GT(thrown_m, 0.3);
  EXPECT_GT(sim.health().emitted_count, 20u);
  EXPECT_EQ(sim.health().particle_count, 0u) << "15 s later all of it is water again";
  EXPECT_EQ(sim.health().absorbed_count, sim.health().emitted_count);
  EXPECT_EQ(sim.escapedCount(), 0u);
}

TEST_F(TwoWay, DropsThatFallObliquelyBringTheirMomentumToNonlinearWater) {
  core::Scene scene = twoWayScene();
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.wave->damping_per_s = 0.0;
  scene.wave->manning_spm13 = 0.0;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  stepAndSettle(sim, 30);
  // The same drops over level water at rest, all with one velocity along the surface.
  constexpr double kVelocity_mps = 2.0;
  StateCopy state = sim.copyState();
  const auto drops = state.position.size() / 4;
  ASSERT_GT(drops, 20u);
  for (std::size_t k = 0; k < drops; ++k) {
    state.position[4 * k + 1] += 0.5f;
    state.velocity[4 * k] = static_cast<float>(kVelocity_mps);
    state.velocity[4 * k + 1] = 0.0f;
    state.velocity[4 * k + 2] = 0.0f;
  }
  std::ranges::fill(state.elevation_m, 0.0);
  std::ranges::fill(state.flow_m2ps, 0.0f);
  sim.setState(state);
  stepAndSettle(sim, 180);
  const StateCopy after = sim.copyState();
  ASSERT_EQ(after.position.size(), 0u) << "all have become water";
  const std::size_t n = 64;
  double momentum_m2ps = 0.0, across_m2ps = 0.0;
  for (std::size_t z = 0; z < n; ++z) {
    for (std::size_t x = 0; x < n; ++x) {
      const auto water_m = [&](std::size_t at_x, std::size_t at_z) {
        return 1.0 + after.elevation_m[at_x % n + n * (at_z % n)];
      };
      const std::size_t at = 4 * (x + n * z);
      momentum_m2ps += after.flow_m2ps[at] * 0.5 * (water_m(x, z) + water_m(x + 1, z));
      across_m2ps += after.flow_m2ps[at + 1] * 0.5 * (water_m(x, z) + water_m(x, z + 1));
    }
  }
  const double cell_m2 = std::pow(sim.derived().wave->cell_m, 2);
  const double drop_m3 = sim.derived().uniforms.droplet_units * double{ELEVATION_UNIT_M} * cell_m2;
  const double brought_m4ps = static_cast<double>(drops) * drop_m3 * kVelocity_mps;
  EXPECT_NEAR(momentum_m2ps * cell_m2, brought_m4ps, 0.05 * brought_m4ps);
  EXPECT_NEAR(across_m2ps, 0.0, 0.05 * brought_m4ps / cell_m2);
}

TEST_F(TwoWay, LandingDropsWiderThanTheCellsAddNoWaveEnergy) {
  // When drops of every size were spread over 5 cells, those on 256 cells broke the water that they fell into, without
  // end.
  const auto run = [&](std::uint32_t resolution_count) {
    core::Scene scene = twoWayScene();
    scene.wave->resolution_count = resolution_count;
    WaterSim& sim = make(scene);
    EXPECT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
    double highest_j = 0.0;
    for (int i = 0; i < 120; ++i) {
      sim.step();
      if (i < 30) highest_j = std::max(highest_j, sim.health().wave_energy_j);
      if (i >= 30) {
        EXPECT_LE(sim.health().wave_energy_j, 1.02 * highest_j) << "tick " << i;
      }
    }
    EXPECT_EQ(sim.recoveredCount(), 0u);
    return sim.health().emitted_m3;
  };
  const double coarse_m3 = run(64);
  const double fine_m3 = run(256);
  EXPECT_GT(coarse_m3, 0.0);
  EXPECT_NEAR(fine_m3 / coarse_m3, 1.0, 0.6);
}

TEST_F(TwoWay, CalmWaterDispatchesNoParticlePass) {
  WaterSim& sim = make(twoWayScene());
  for (int i = 0; i < 40; ++i) sim.step();
  const StateCopy state = sim.copyState();
  ASSERT_EQ(state.pool.size(), std::size_t{POOL_WORDS});
  for (const int args : {POOL_EMIT_ARGS, POOL_PARTICLE_ARGS, POOL_CELL_ARGS, POOL_BLOCK_ARGS, POOL_ONE_ARGS})
    EXPECT_EQ(state.pool[static_cast<std::size_t>(args)], 0u) << "groups of the indirect dispatch at word " << args;
  EXPECT_TRUE(state.position.empty());
  EXPECT_EQ(sim.health().max_elevation_m, 0.0);
}

TEST_F(TwoWay, RepeatsBitForBit) {
  const auto hash = [&](std::uint64_t seed) {
    core::Scene scene = twoWayScene();
    scene.seed = seed;
    WaterSim& sim = make(scene);
    for (int i = 0; i < 40; ++i) {
      if (i == 3) {
        EXPECT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.5, 0.9, 0.15}));
      }
      sim.step();
    }
    EXPECT_GT(sim.health().particle_count, 10u);
    return sim.stateHash();
  };
  const auto first = hash(5);
  EXPECT_EQ(first, hash(5));
  EXPECT_NE(first, hash(6)) << "spray is drawn by the seed";
}

TEST_F(TwoWay, TheLedgerIsExactThroughStormsWavesBoatsRocksAndOpenSides) {
  core::Scene scene = twoWayScene();
  scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
  scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
  scene.wave->sponge_width_m = 1.5;
  scene.wave->steepening_ratio = 0.6;
  scene.obstacles = {core::Rock{2.0, 1.5, 0.8, 0.6}, core::Breakwater{-1.0, -3.0, 4.0, 0.6, 20.0, 0.6}};
  scene.beaches = {core::Beach{core::Side::kPlusX, 2.5, 0.0}};
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.storm->drops_per_m2_s = 0.5;
  scene.boats.emplace();
  scene.boats->boats = {
      core::Boat{.x_m = -2.0, .z_m = 2.0, .max_speed_mps = 5.0, .throttle_ratio = 1.0, .rudder_ratio = 0.4}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 500; ++i) {
    if (i % 150 == 10) {
      ASSERT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.5, 0.8, 0.15}));
    }
    if (i % 200 == 60) {
      ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kMinusX, 0.6, 1.5, 0.4}));
    }
    sim.step();
    ASSERT_EQ(sim.health().volume_error_units, 0) << "tick " << sim.health().tick;
  }
  EXPECT_GT(sim.health().emitted_count, 100u);
  EXPECT_NE(sim.health().outflow_units, 0);
  EXPECT_EQ(sim.nonfiniteCount(), 0u);
  EXPECT_EQ(sim.escapedCount(), 0u);
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(TwoWay, AGridOfWholeScanBlocksCountsItsParticles) {
  core::Scene scene = twoWayScene();
  scene.wave->side_m = 16.0;
  scene.particles->headroom_m = 3.0;
  scene.coupling->droplet_spacing_m = 0.25;  // cells of 0.5 m: 32 x 8 x 32 = two blocks of 4096
  WaterSim& sim = make(scene);
  ASSERT_EQ(sim.derived().particles->cell_count % SCAN_BLOCK, 0u) << sim.derived().particles->cell_count;
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.8, 0.9, 0.15}));
  for (int i = 0; i < 60; ++i) sim.step();
  EXPECT_GT(sim.health().emitted_count, 5u);
  EXPECT_EQ(sim.nonfiniteCount(), 0u);
  EXPECT_EQ(sim.health().volume_error_units, 0);
}

TEST_F(TwoWay, AFullPoolEmitsNothingAndLosesNoWater) {
  core::Scene scene = twoWayScene();
  scene.particles->count = 30;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  for (int i = 0; i < 240; ++i) {
    sim.step();
    ASSERT_LE(sim.health().particle_count, 30u);
    ASSERT_EQ(sim.health().volume_error_units, 0);
  }
  EXPECT_GT(sim.health().pool_refused_count, 0u);
}

TEST_F(TwoWay, FramesHaveTheLiveParticles) {
  WaterSim& sim = make(twoWayScene());
  const auto frame = [&] {
    EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true, .particles = true, .foam = true})));
    ctx_->finish();
    auto frames = sim.takeFrames();
    return std::move(frames.at(0));
  };
  EXPECT_EQ(frame().at(core::Level::kFull).particles->count, 0u);
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  for (int i = 0; i < 40; ++i) sim.step();
  const core::FrameView view = frame();
  const core::ParticleView& particles = *view.at(core::Level::kFull).particles;
  EXPECT_EQ(particles.count, sim.copyState().pool[POOL_LIVE]);
  EXPECT_GT(particles.count, 10u);
  EXPECT_EQ(particles.words.size(), 3u * particles.count);
  const auto& foam = view.at(core::Level::kFull).foam;
  ASSERT_TRUE(foam);
  EXPECT_EQ(foam->count.x, 32u);
  std::uint32_t white = 0;
  for (const std::uint32_t word : foam->words) {
    for (int byte = 0; byte < 4; ++byte) white = std::max(white, word >> (8 * byte) & 0xffu);
  }
  EXPECT_GT(white, 100u) << "breaking water leaves foam";
}

TEST_F(TwoWay, FoamFadesByItsLifetime) {
  core::Scene scene = twoWayScene();
  scene.foam->breaking_lifetime_s = 1.0;
  scene.foam->landing_lifetime_s = 1.0;
  scene.wave->damping_per_s = 2.0;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  const auto white = [&] {
    EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.foam = true})));
    ctx_->finish();
    const auto frames = sim.takeFrames();
    double sum = 0;
    for (const std::uint32_t word : frames.at(0).at(core::Level::kFull).foam->words) {
      for (int byte = 0; byte < 4; ++byte) sum += word >> (8 * byte) & 0xffu;
    }
    return sum;
  };
  for (int i = 0; i < 200; ++i) sim.step();
  const double early = white();
  for (int i = 0; i < 60; ++i) sim.step();
  const double later = white();
  ASSERT_GT(early, 300.0);
  EXPECT_NEAR(later / early, std::exp(-1.0), 0.12) << "a second is one lifetime";
}

}  // namespace
}  // namespace spindrift::sim
