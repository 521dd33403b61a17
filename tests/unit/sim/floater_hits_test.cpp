// Particles and floaters act on each other: momentum, light floaters, thin planks, storms, and a layer carried by the
// waves.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <shared/pool.h>

#include <spindrift/study/floater_pose.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

constexpr double kHitTick_s = 1.0 / 60.0;
constexpr double kWater_kgpm3 = 1000.0;
constexpr double kDrop_m = 0.12;
constexpr std::size_t kFloaterWords = std::size_t{FLOATER_TEXELS} * 4;

using Vec = std::array<double, 3>;

/// 12 m of water that breaks into drops of 12 cm.
core::Scene dropScene(std::vector<core::Floater> floaters) {
  core::Scene scene;
  scene.name = "drops";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 12.0;
  scene.wave->depth_m = 1.0;
  scene.particles.emplace();
  scene.particles->count = 3000;
  scene.particles->headroom_m = 4.0;
  scene.particles->max_speed_mps = 8.0;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = kDrop_m;
  scene.coupling->emission_ratio = 2.0;
  scene.coupling->downforce_per_m_s2 = 0.0;
  scene.floaters.emplace();
  scene.floaters->floaters = std::move(floaters);
  return scene;
}

/// Volume of a crate or plank, over the cube of its size.
double boxVolume_m3(const float* floater) {
  return 8.0 * floater[16] * floater[17] * floater[18];
}

/// How deep a position is inside a box; negative outside. `floater`: its words in StateCopy::floaters.
double depthInBox_m(const float* floater, const float* position) {
  const Vec q{-floater[4], -floater[5], -floater[6]};
  const double w = floater[7];
  const auto cross = [](const Vec& a, const Vec& b) {
    return Vec{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vec d{position[0] - floater[0], position[1] - floater[1], position[2] - floater[2]};
  Vec inner = cross(q, d);
  for (std::size_t k = 0; k < 3; ++k) inner[k] += w * d[k];
  const Vec turned = cross(q, inner);
  double depth_m = 1e9;
  for (std::size_t k = 0; k < 3; ++k) {
    const double local_m = d[k] + 2.0 * turned[k] + (k == 1 ? floater[21] : 0.0);
    depth_m = std::min(depth_m, floater[16 + k] - std::abs(local_m));
  }
  return depth_m;
}

class FloaterHits : public OnDevice {
 protected:
  /// A state with a lattice of drops that move with one velocity; others hang at a side of the water, out of reach of
  /// all others.
  static StateCopy withDrops(WaterSim& sim, const std::vector<Vec>& drops, Vec velocity_mps) {
    EXPECT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
    StateCopy clean = sim.copyState();
    for (int i = 0; i < 30; ++i) sim.step();
    StateCopy state = sim.copyState();
    const std::size_t count = state.position.size() / 4;
    EXPECT_GE(count, drops.size());
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t rest = k - drops.size();
      const Vec aside{-5.8 + 0.4 * static_cast<double>(rest / 196 % 5), 1.4 + 0.4 * static_cast<double>(rest / 28 % 7),
                      -5.6 + 0.4 * static_cast<double>(rest % 28)};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        state.position[4 * k + axis] = static_cast<float>(k < drops.size() ? drops[k][axis] : aside[axis]);
        state.velocity[4 * k + axis] = static_cast<float>(k < drops.size() ? velocity_mps[axis] : 0.0);
      }
    }
    std::ranges::fill(state.elevation_m, 0.0);
    std::ranges::fill(state.flow_m2ps, 0.0f);
    state.floaters = clean.floaters;
    return state;
  }
  static std::vector<Vec> lattice(Vec first, std::array<int, 3> counts, double apart_m) {
    std::vector<Vec> out;
    for (int x = 0; x < counts[0]; ++x)
      for (int y = 0; y < counts[1]; ++y)
        for (int z = 0; z < counts[2]; ++z)
          out.push_back({first[0] + apart_m * x, first[1] + apart_m * y, first[2] + apart_m * z});
    return out;
  }
  /// A copy may still have drops that were absorbed in its tick.
  static std::size_t liveCount(const StateCopy& state) {
    std::size_t count = 0;
    for (std::size_t k = 3; k < state.position.size(); k += 4) count += state.position[k] != DEAD_ID ? 1 : 0;
    return count;
  }
  static Vec momentum(const StateCopy& state, double drop_kg, double floater_kg) {
    Vec sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < state.velocity.size(); k += 4)
        if (state.position[k + 3] != DEAD_ID) sum[axis] += drop_kg * state.velocity[k + axis];
      sum[axis] += floater_kg * state.floaters[8 + axis];
    }
    return sum;
  }
};

TEST_F(FloaterHits, AJetPushesAndTurnsACrateAndTheirMomentumStays) {
  WaterSim& sim = make(dropScene({core::Floater{.y_m = 2.3, .heading_deg = 20, .size_m = 0.8}}));
  // The drops are farther apart than they act on each other, and hit beside the middle.
  const StateCopy start = withDrops(sim, lattice({-1.6, 2.2, 0.1}, {3, 2, 2}, 0.4), {5.0, 0.0, 0.0});
  sim.setState(start);
  const double crate_kg = 0.4 * kWater_kgpm3 * boxVolume_m3(start.floaters.data());
  constexpr int kTicks = 15;
  for (int i = 0; i < kTicks; ++i) sim.step();
  const StateCopy end = sim.copyState();
  ASSERT_EQ(liveCount(end), liveCount(start)) << "nothing has fallen into the water yet";
  const double drop_kg = sim.derived().uniforms.mass_kg;
  const Vec before = momentum(start, drop_kg, crate_kg), after = momentum(end, drop_kg, crate_kg);
  // In the first tick the crate still has the acceleration of its first state, which is 0.
  const double fall =
      -9.81 * kHitTick_s * (crate_kg * (kTicks - 1) + drop_kg * static_cast<double>(liveCount(start)) * kTicks);
  // Floats of 1e-7 of each velocity and tick: 1e-5 of the whole.
  EXPECT_NEAR(after[0], before[0], 1e-5 * before[0]);
  EXPECT_NEAR(after[1], before[1] + fall, 2e-5 * std::abs(fall));
  EXPECT_NEAR(after[2], before[2], 1e-5 * before[0]);
  const auto crate = study::floaterPoses(end).at(0);
  EXPECT_GT(crate.velocity_x_mps, 0.2);
  EXPECT_GT(crate.spin_radps, 0.1);
}

TEST_F(FloaterHits, ALightCrateIsNotFasterThanTheManyDropsThatHitItAtOnce) {
  WaterSim& sim = make(dropScene({core::Floater{.y_m = 2.3, .size_m = 0.6, .density_ratio = 0.02}}));
  const StateCopy start = withDrops(sim, lattice({-0.9, 2.06, -0.24}, {1, 5, 5}, 0.12), {6.0, 0.0, 0.0});
  sim.setState(start);
  double fastest_mps = 0.0;
  for (int i = 0; i < 20; ++i) {
    sim.step();
    fastest_mps = std::max(fastest_mps, study::floaterPoses(sim.copyState()).at(0).velocity_x_mps);
  }
  EXPECT_GT(fastest_mps, 3.0) << "25 drops, each of 1.7 kg, hit a crate of 4.3 kg";
  EXPECT_LT(fastest_mps, 6.0) << "pushed one by one, it would be at the limit of 25 m/s";
}

TEST_F(FloaterHits, NoDropPassesThroughAPlankThatIsThinnerThanItsStep) {
  // 4.8 cm thick; a drop of 7 m/s moves 12 cm per tick.
  WaterSim& sim = make(
      dropScene({core::Floater{.kind = core::FloaterKind::kRaft, .y_m = 2.0, .size_m = 0.4, .density_ratio = 8.0}}));
  for (const double above_m : {0.5, 0.53, 0.56, 0.59}) {
    sim.reset();
    sim.setState(withDrops(sim, {{0.03, 2.0 + above_m, 0.02}}, {0.0, -7.0, 0.0}));
    for (int i = 0; i < 9; ++i) sim.step();
    const StateCopy state = sim.copyState();
    int near = 0;
    for (std::size_t k = 0; k < state.position.size(); k += 4) {
      const float* at = &state.position[k];
      if (std::abs(at[0]) > 1.0f || std::abs(at[2]) > 1.0f) continue;
      ++near;
      EXPECT_GT(at[1], state.floaters[1]) << "from " << above_m;
    }
    EXPECT_EQ(near, 1);
  }
}

TEST_F(FloaterHits, InAStormDropsLeaveFloatersAndTheLedgerIsExact) {
  std::vector<core::Floater> floaters;
  for (int i = 0; i < 16; ++i)
    floaters.push_back({.kind = i % 3 == 0 ? core::FloaterKind::kPlank : core::FloaterKind::kCrate,
                        .x_m = 0.9 * (i % 4 - 1.5),
                        .y_m = 0.1,
                        .z_m = 0.9 * (i / 4 - 1.5),
                        .heading_deg = 25.0 * i,
                        .size_m = 0.8});
  core::Scene scene = dropScene(floaters);
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.events.push_back({.at_s = 0.2, .every_s = 2.0, .effect = core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}});
  WaterSim& sim = make(scene);
  std::map<float, int> ticks_inside;
  int longest = 0, touched = 0;
  for (int i = 0; i < 360; ++i) {
    sim.step();
    ASSERT_EQ(sim.health().volume_error_units, 0) << "tick " << sim.health().tick;
    const StateCopy state = sim.copyState();
    std::map<float, int> now;
    for (std::size_t k = 0; k < state.position.size(); k += 4) {
      double depth_m = -1.0;
      for (std::size_t slot = 0; slot < floaters.size(); ++slot)
        depth_m = std::max(depth_m, depthInBox_m(&state.floaters[slot * kFloaterWords], &state.position[k]));
      touched += depth_m > -1e-3 ? 1 : 0;
      if (depth_m < 0.1 * kDrop_m) continue;
      const float id = state.position[k + 3];
      longest = std::max(longest, now[id] = ticks_inside[id] + 1);
    }
    ticks_inside = std::move(now);
  }
  EXPECT_GT(touched, 100);
  EXPECT_LE(longest, 20) << "ticks that one drop stayed in a floater";
  EXPECT_EQ(sim.recoveredCount(), 0u);
  EXPECT_EQ(sim.escapedCount(), 0u);
}

TEST_F(FloaterHits, RunsRepeatBitForBit) {
  const auto hash = [&] {
    core::Scene scene = dropScene({core::Floater{.y_m = 0.1, .size_m = 0.8},
                                   core::Floater{.kind = core::FloaterKind::kBall, .x_m = 0.9, .y_m = 0.1},
                                   core::Floater{.kind = core::FloaterKind::kBarrel, .y_m = 0.1, .z_m = 0.9}});
    scene.events.push_back({.at_s = 0.1, .every_s = 1.0, .effect = core::Splash{0.3, 0.2, 1.5, 0.9, 0.15}});
    WaterSim& sim = make(scene);
    for (int i = 0; i < 120; ++i) sim.step();
    return sim.stateHash();
  };
  const auto first = hash();
  EXPECT_EQ(first, hash());
}

TEST_F(FloaterHits, ACrateAmongParticlesCarriedByTheWaveFloatsAsDeepAndAsCalmAsWithout) {
  const auto rest = [&](bool with_particles) {
    core::Scene scene = smallScene(2000);
    scene.wave->depth_m = 2.0;
    scene.wave->damping_per_s = 0.5;
    if (!with_particles) {
      scene.particles.reset();
      scene.coupling.reset();
      scene.foam.reset();
    }
    scene.floaters.emplace();
    scene.floaters->floaters = {core::Floater{.y_m = 0.1, .size_m = 0.8}};
    WaterSim& sim = make(scene);
    for (int i = 0; i < 600; ++i) sim.step();
    double fastest_mps = 0.0;
    for (int i = 0; i < 60; ++i) {
      sim.step();
      fastest_mps = std::max(fastest_mps, study::floaterPoses(sim.copyState()).at(0).speed_mps());
    }
    EXPECT_LT(fastest_mps, 0.02);
    EXPECT_EQ(sim.recoveredCount(), 0u);
    return study::floaterPoses(sim.copyState()).at(0).middle_m();
  };
  EXPECT_NEAR(rest(true), rest(false), 0.01);
}

}  // namespace
}  // namespace spindrift::sim
