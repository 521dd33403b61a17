// The same water continues at another resolution: what the pure function keeps, and a simulation that takes over.
#include "carry_state.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/boats.h>
#include <shared/fixed_point.h>
#include <shared/pool.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/random.h>
#include <spindrift/sim_setup/scene_parts.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

/// A harbor without particles: an absorbing side, a rock, a thin breakwater, a beach that runs dry, a boat.
core::Scene harbor(std::uint32_t resolution_count) {
  core::Scene scene;
  scene.name = "harbor";
  scene.wave.emplace();
  scene.wave->resolution_count = resolution_count;
  scene.wave->side_m = 16.0;
  scene.wave->depth_m = 1.5;
  scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
  scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
  scene.wave->boundary_minus_z = core::WaveBoundary::kReflect;
  scene.wave->boundary_plus_z = core::WaveBoundary::kReflect;
  scene.wave->sponge_width_m = 2.0;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.wave->damping_per_s = 0.0;
  scene.obstacles = {core::Rock{3.0, 1.0, 1.1, 0.5}, core::Breakwater{-1.0, -3.0, 6.0, 0.4, 30.0, 0.5}};
  scene.beaches = {core::Beach{core::Side::kPlusX, 3.0, 0.0}};
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{.x_m = -4.0, .z_m = 3.0}};
  return scene;
}

core::Scene basin(std::uint32_t resolution_count) {
  core::Scene scene = harbor(resolution_count);
  scene.obstacles.clear();
  scene.beaches.clear();
  scene.boats.reset();
  scene.wave->boundary_minus_x = core::WaveBoundary::kReflect;
  return scene;
}

core::Scene twoWay(std::uint32_t resolution_count, double droplet_spacing_m) {
  core::Scene scene = basin(resolution_count);
  scene.particles.emplace();
  scene.particles->count = 4000;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = droplet_spacing_m;
  return scene;
}

Derived derivedOf(const core::Scene& scene) {
  auto derived = derive(scene);
  if (!derived) throw std::runtime_error(derived.error().message);
  return *std::move(derived);
}

/// `elevation_m(x, z)` in whole units on wet cells; no flow.
CarriedState stateOf(const core::Scene& scene, const auto& elevation_m) {
  CarriedState out{.scene = scene, .derived = derivedOf(scene)};
  const WaveLayout& wave = *out.derived.wave;
  const Basin floor = layOutBasin(scene, wave);
  const auto n = static_cast<int>(wave.count_x);
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const double eta_m =
          elevation_m((x + 0.5) * wave.cell_m - wave.length_m / 2, (z + 0.5) * wave.cell_m - wave.length_m / 2);
      const bool is_wet = floor.depth_m[static_cast<std::size_t>(x + n * z)] > 0;
      out.state.elevation_m.push_back(is_wet ? std::round(eta_m * ELEVATION_UNITS_PER_M) / ELEVATION_UNITS_PER_M : 0.0);
    }
  }
  out.state.flow_m2ps.assign(2 * out.state.elevation_m.size(), 0.0f);
  if (hasMatchedLayer(scene)) out.state.elevation_x_units.assign(out.state.elevation_m.size(), 0);
  return out;
}

std::int64_t unitsOf(const StateCopy& state) {
  std::int64_t sum = 0;
  for (const double eta_m : state.elevation_m) sum += std::llround(eta_m * ELEVATION_UNITS_PER_M);
  return sum;
}

ResampledState resampledTo(const CarriedState& before, const core::Scene& scene) {
  return resampleState(before, scene, derivedOf(scene));
}

/// Rough waves that stay above the bed.
double rough(double x_m, double z_m) {
  return 0.04 * std::sin(2.1 * x_m) * std::cos(3.3 * z_m) + 0.02 * std::sin(9 * x_m + 7 * z_m);
}

TEST(CarryState, LevelWaterStaysLevelToTheUnitBesideWallsAndOnTheBeach) {
  for (const auto& [from_count, to_count] : {std::pair{96u, 144u}, {144u, 64u}, {64u, 160u}}) {
    const CarriedState before = stateOf(harbor(from_count), [](double, double) { return 0.0; });
    const ResampledState after = resampledTo(before, harbor(to_count));
    for (const double eta_m : after.state.elevation_m) ASSERT_EQ(eta_m, 0.0);
    for (const float q : after.state.flow_m2ps) ASSERT_EQ(q, 0.0f);
    EXPECT_EQ(after.outflow_units, 0);
  }
}

TEST(CarryState, TheVolumeStaysAndTheLedgerIsExact) {
  for (const auto& [from_count, to_count] : {std::pair{96u, 144u}, {144u, 64u}, {64u, 160u}}) {
    for (const bool is_open : {true, false}) {
      const auto make = [&](std::uint32_t n) { return is_open ? harbor(n) : basin(n); };
      const CarriedState before = stateOf(make(from_count), rough);
      const ResampledState after = resampledTo(before, make(to_count));
      const double ratio = std::pow(static_cast<double>(to_count) / from_count, 2);
      EXPECT_NEAR(static_cast<double>(unitsOf(after.state)), static_cast<double>(unitsOf(before.state)) * ratio,
                  0.5 + 1e-6);
      EXPECT_EQ(unitsOf(after.state) + after.outflow_units, 0);
    }
  }
}

TEST(CarryState, MakesNoExtremesAndLeavesDryCellsAndClosedFacesAlone) {
  for (const auto& [from_count, to_count] : {std::pair{96u, 144u}, {144u, 64u}}) {
    CarriedState before = stateOf(harbor(from_count), rough);
    SplitMix64 random(5);
    for (float& q : before.state.flow_m2ps) q = static_cast<float>(0.1 * random.symmetric());
    const core::Scene scene = harbor(to_count);
    const ResampledState after = resampledTo(before, scene);
    const Basin floor = layOutBasin(scene, *derivedOf(scene).wave);
    const auto [low, high] = std::ranges::minmax(before.state.elevation_m);
    // What shores gain or lose is spread over all cells: less than a millimetre here, where waves are 6 cm high.
    constexpr double kSpread_m = 1e-3;
    for (std::size_t i = 0; i < after.state.elevation_m.size(); ++i) {
      EXPECT_GE(after.state.elevation_m[i], low - kSpread_m);
      EXPECT_LE(after.state.elevation_m[i], high + kSpread_m);
      if (floor.depth_m[i] <= 0) {
        EXPECT_EQ(after.state.elevation_m[i], 0.0);
      }
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_LE(std::abs(after.state.flow_m2ps[2 * i + c]), 0.1f);
        if (floor.conductance_m[i][c] <= 0) {
          EXPECT_EQ(after.state.flow_m2ps[2 * i + c], 0.0f);
        }
      }
    }
  }
}

TEST(CarryState, BringsLongWavesBackFromACoarserGrid) {
  const auto wave = [](double x_m, double z_m) {
    const double k = std::numbers::pi / 16.0;  // modes 8 and 5 of the basin: waves of 4 m, 16 cells of the coarse grid
    return 0.05 * (std::cos(8 * k * (x_m + 8)) + std::cos(5 * k * (z_m + 8)));
  };
  const CarriedState before = stateOf(basin(128), wave);
  CarriedState coarse = stateOf(basin(64), [](double, double) { return 0.0; });
  coarse.state = resampledTo(before, coarse.scene).state;
  const ResampledState after = resampledTo(coarse, before.scene);
  double missing = 0.0, held = 0.0;
  for (std::size_t i = 0; i < after.state.elevation_m.size(); ++i) {
    missing += std::pow(after.state.elevation_m[i] - before.state.elevation_m[i], 2);
    held += std::pow(before.state.elevation_m[i], 2);
  }
  EXPECT_LT(std::sqrt(missing / held), 0.02);
}

TEST(CarryState, FillsUpCellsWhoseBedIsHigherNow) {
  // Almost empty water on the slope of the beach: the coarse cells average deeper ones.
  const CarriedState before = stateOf(harbor(144), [](double x_m, double) { return x_m > 4.0 ? -0.05 : 0.02; });
  const core::Scene scene = harbor(64);
  const ResampledState after = resampledTo(before, scene);
  const Basin floor = layOutBasin(scene, *derivedOf(scene).wave);
  for (std::size_t i = 0; i < after.state.elevation_m.size(); ++i) {
    if (floor.depth_m[i] > 0) {
      EXPECT_GE(after.state.elevation_m[i], -double{floor.depth_m[i]} - 1e-7);
    }
  }
}

TEST(CarryState, SprayKeepsItsVolumeWithDropsOfTheNewSize) {
  for (const auto& [from_m, to_m] : {std::pair{0.1, 0.143}, {0.1, 0.06}, {0.1, 0.1}}) {
    CarriedState before = stateOf(twoWay(96, from_m), [](double, double) { return 0.0; });
    SplitMix64 random(9);
    std::int64_t drop_count = 0;
    for (int k = 0; k < 300; ++k) {
      const bool is_dead = k % 10 == 3;
      for (const double place : {3 * random.symmetric(), 0.5 + 0.2 * random.symmetric(), 3 * random.symmetric()})
        before.state.position.push_back(static_cast<float>(place));
      before.state.position.push_back(is_dead ? DEAD_ID : static_cast<float>(k));
      for (const float v : {1.0f, 2.0f, static_cast<float>(k), 1.0f}) before.state.velocity.push_back(v);
      drop_count += is_dead ? 0 : 1;
    }
    before.state.elevation_m[0] =
        -static_cast<double>(drop_count * before.derived.uniforms.droplet_units) * ELEVATION_UNIT_M;
    const core::Scene scene = twoWay(144, to_m);
    const Derived derived = derivedOf(scene);
    const ResampledState after = resampleState(before, scene, derived);
    const std::int64_t count = after.state.pool[POOL_EMITTED];
    EXPECT_GT(count, 50);
    EXPECT_EQ(after.state.position.size(), 4 * static_cast<std::size_t>(count));
    EXPECT_EQ(after.state.velocity.size(), 4 * static_cast<std::size_t>(count));
    EXPECT_EQ(unitsOf(after.state) + count * derived.uniforms.droplet_units + after.outflow_units, 0);
    EXPECT_EQ(after.outflow_units, 0) << "a closed basin";
    const double held_m3 = static_cast<double>(drop_count) * std::pow(before.derived.particles->spacing_m, 3);
    EXPECT_NEAR(static_cast<double>(count) * std::pow(derived.particles->spacing_m, 3), held_m3,
                std::pow(to_m, 3) + 0.001 * held_m3);
    for (std::size_t i = 0; i < after.state.position.size(); ++i)
      EXPECT_LE(std::abs(after.state.position[i]), i % 4 == 3 ? 300.0f : 3.2f);
  }
}

TEST(CarryState, ABoxOfParticlesKeepsItsPlaceAndMotion) {
  core::Scene scene;
  scene.name = "box";
  scene.particles.emplace();
  scene.particles->count = 3000;
  scene.particles->layers_count = 8;
  scene.particles->box_side_m = 2.0;
  scene.particles->fill_x_ratio = 0.5;
  scene.particles->headroom_m = 1.0;
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  CarriedState before{.scene = scene, .derived = derivedOf(scene)};
  core::Scene finer = scene;
  finer.particles->count = 12000;
  finer.particles->layers_count = 13;
  // The water has moved to the other side of the box.
  const ParticleLayout& layout = *before.derived.particles;
  std::array<double, 2> centre_m{};
  for (std::uint32_t y = 0; y < layout.layers_count; ++y) {
    for (std::uint32_t z = 0; z < layout.columns_z_count; ++z) {
      for (std::uint32_t x = 0; x < layout.columns_x_count; ++x) {
        const double x_m = layout.max_m[0] - (x + 0.5) * layout.pitch_x_m;
        const double y_m = -layout.band_m + layout.layer_heights_m[y];
        for (const double v : {x_m, y_m, layout.min_m[2] + (z + 0.5) * layout.pitch_z_m, 0.0})
          before.state.position.push_back(static_cast<float>(v));
        for (const float v : {0.5f, 0.0f, -0.25f, 0.0f}) before.state.velocity.push_back(v);
        centre_m[0] += x_m / layout.count;
        centre_m[1] += y_m / layout.count;
      }
    }
  }
  const Derived derived = derivedOf(finer);
  const ResampledState after = resampleState(before, finer, derived);
  ASSERT_EQ(after.state.position.size(), 4 * std::size_t{derived.particles->count});
  std::array<double, 2> centre_after_m{};
  for (std::size_t i = 0; i < after.state.position.size(); i += 4) {
    centre_after_m[0] += double{after.state.position[i]} / derived.particles->count;
    centre_after_m[1] += double{after.state.position[i + 1]} / derived.particles->count;
    EXPECT_NEAR(after.state.velocity[i], 0.5f, 1e-5f);
    EXPECT_NEAR(after.state.velocity[i + 2], -0.25f, 1e-5f);
  }
  EXPECT_NEAR(centre_after_m[0], centre_m[0], layout.spacing_m / 2);
  EXPECT_NEAR(centre_after_m[1], centre_m[1], layout.spacing_m / 2);
}

TEST(CarryState, OnlyTheSameWaterGoesOn) {
  const core::Scene scene = harbor(96);
  core::Scene other = harbor(160);
  other.tick_rate_hz = 120;
  other.wave->damping_per_s = 0.3;
  EXPECT_TRUE(isSameWater(scene, other));
  other.wave->side_m = 17.0;
  EXPECT_FALSE(isSameWater(scene, other));
  other = harbor(96);
  other.beaches.clear();
  EXPECT_FALSE(isSameWater(scene, other));
  other = harbor(96);
  other.boats.reset();
  EXPECT_FALSE(isSameWater(scene, other));
}

class TakeOver : public OnDevice {
 protected:
  std::unique_ptr<WaterSim> another(const core::Scene& scene) {
    auto made = WaterSim::create(*ctx_, scene);
    if (!made) throw std::runtime_error(made.error().message);
    return *std::move(made);
  }
  /// Mean elevation of 8 x 8 squares over the water, x fastest.
  static std::vector<double> squares(WaterSim& sim) {
    const StateCopy state = sim.copyState();
    const std::uint32_t n = sim.derived().wave->count_x;
    std::vector<double> out(64, 0.0);
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i)
      out[8 * (i / n / (n / 8)) + i % n / (n / 8)] +=
          state.elevation_m[i] * 64.0 / static_cast<double>(std::size_t{n} * n);
    return out;
  }
};

TEST_F(TakeOver, AWaveGoesOnAtAnotherResolution) {
  for (const std::uint32_t to_count : {96u, 240u}) {
    WaterSim& sim = make(basin(160));
    ASSERT_TRUE(sim.start(core::Splash{1.0, -1.0, 2.5, 0.3, 0.2}));
    for (int k = 0; k < 60; ++k) sim.step();
    const auto next = another(basin(to_count));
    for (int k = 0; k < 4; ++k) next->step();
    next->reset();
    ASSERT_TRUE(next->takeOver(sim.carriedState()));
    EXPECT_NEAR(next->time_s(), 1.0, 1e-9);
    for (int k = 0; k < 60; ++k) {
      sim.step();
      next->step();
      ASSERT_EQ(next->health().volume_error_units, 0);
    }
    EXPECT_GT(next->health().tick, 0u);
    const auto wanted = squares(sim);
    const auto found = squares(*next);
    double off = 0.0, held = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      off += std::pow(found[i] - wanted[i], 2);
      held += std::pow(wanted[i], 2);
    }
    EXPECT_LT(std::sqrt(off / held), 0.08) << "to " << to_count << " cells";
  }
}

TEST_F(TakeOver, BoatsKeepIdsPosesSpeedsAndControls) {
  WaterSim& sim = make(harbor(96));
  const auto boat = sim.spawnBoat(core::Boat{.x_m = -2.0, .z_m = 4.0});
  ASSERT_TRUE(boat);
  ASSERT_TRUE(sim.removeBoat(1));
  ASSERT_TRUE(sim.controlBoat(*boat, 0.7, -0.3));
  for (int k = 0; k < 90; ++k) sim.step();
  const auto next = another(harbor(144));
  const CarriedState carried = sim.carriedState();
  ASSERT_TRUE(next->takeOver(carried));
  EXPECT_EQ(next->copyState().boats, carried.state.boats);
  ASSERT_EQ(next->boats().size(), 1u);
  EXPECT_EQ(next->boats()[0].boat_id, *boat);
  EXPECT_EQ(next->nextBoatId(), sim.nextBoatId());
  for (int k = 0; k < 60; ++k) {
    sim.step();
    next->step();
  }
  const StateCopy a = sim.copyState(), b = next->copyState();
  const std::size_t slot = 4 * BOAT_TEXELS;  // the second one
  EXPECT_NEAR(a.boats[slot], b.boats[slot], 0.1f) << "x: it drives on";
  EXPECT_NEAR(a.boats[slot + 2], b.boats[slot + 2], 0.1f);
  EXPECT_NEAR(a.boats[slot + 1], b.boats[slot + 1], 0.03f) << "y: it does not jump";
  EXPECT_GT(std::hypot(b.boats[slot] - carried.state.boats[slot], b.boats[slot + 2] - carried.state.boats[slot + 2]),
            0.3f);
  EXPECT_EQ(next->health().volume_error_units, 0);
}

TEST_F(TakeOver, AnEffectInProgressAndSprayInTheAirGoOn) {
  WaterSim& sim = make(twoWay(96, 0.12));
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 2.0, 1.0, 0.15}));
  while (sim.health().particle_count < 100 && sim.time_s() < 5) sim.step();
  ASSERT_GE(sim.health().particle_count, 100u);
  ASSERT_TRUE(sim.start(core::Splash{4.0, 4.0, 1.0, 0.3, 0.5}));
  for (int k = 0; k < 5; ++k) sim.step();
  const auto next = another(twoWay(144, 0.09));
  ASSERT_TRUE(next->takeOver(sim.carriedState()));
  for (int k = 0; k < 20; ++k) {
    sim.step();
    next->step();
    ASSERT_EQ(next->health().volume_error_units, 0);
  }
  EXPECT_GT(next->health().particle_count, sim.health().particle_count) << "the drops are smaller";
  const auto depthAt = [](WaterSim& water) {
    const StateCopy state = water.copyState();
    const WaveLayout& wave = *water.derived().wave;
    const auto at = static_cast<std::size_t>((4.0 + wave.length_m / 2) / wave.cell_m);
    return state.elevation_m[at + at * wave.count_x];
  };
  EXPECT_LT(depthAt(*next), -0.05);
  EXPECT_NEAR(depthAt(*next), depthAt(sim), 0.05);
  for (int k = 0; k < 900 && next->health().particle_count > 0; ++k) next->step();
  EXPECT_EQ(next->health().particle_count, 0u);
  EXPECT_EQ(next->health().volume_error_units, 0);
}

TEST_F(TakeOver, AWindSeaComesInWithoutABreak) {
  const auto stormy = [](std::uint32_t n) {
    core::Scene scene = harbor(n);
    scene.boats.reset();
    scene.storm.emplace();
    scene.storm->level_ratio = 0.5;
    scene.storm->drops_per_m2_s = 0.0;
    scene.storm->wind_speed_mps = 12.0;
    scene.storm->wind_direction_deg = 0.0;  // from the open side
    return scene;
  };
  WaterSim& sim = make(stormy(96));
  for (int k = 0; k < 600; ++k) sim.step();
  const auto next = another(stormy(144));
  ASSERT_TRUE(next->takeOver(sim.carriedState()));
  double off = 0.0, held = 0.0;
  for (int k = 0; k < 60; ++k) {
    sim.step();
    next->step();
    ASSERT_EQ(next->health().volume_error_units, 0);
    if (k % 10 != 9) continue;
    const auto wanted = squares(sim), found = squares(*next);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      off += std::pow(found[i] - wanted[i], 2);
      held += std::pow(wanted[i], 2);
    }
  }
  RecordProperty("off_percent", static_cast<int>(100 * std::sqrt(off / held)));
  EXPECT_GT(std::sqrt(held / (6 * 64)), 0.005) << "there is a sea";
  // The finer grid resolves other waves; those of the coarser one fade into them in four seconds.
  EXPECT_LT(std::sqrt(off / held), 0.1);
}

TEST_F(TakeOver, IsTheSameTwiceAndAfterItAResetStartsAtTheBeginning) {
  WaterSim& sim = make(harbor(96));
  for (int k = 0; k < 30; ++k) sim.step();
  const CarriedState carried = sim.carriedState();
  const auto next = another(harbor(144));
  const auto start = next->stateHash();
  ASSERT_TRUE(next->takeOver(carried));
  next->step();
  const auto one = next->stateHash();
  next->reset();
  EXPECT_EQ(next->stateHash(), start);
  ASSERT_TRUE(next->takeOver(carried));
  next->step();
  EXPECT_EQ(next->stateHash(), one);
}

TEST_F(TakeOver, OfOtherWaterIsRefusedAndChangesNothing) {
  WaterSim& sim = make(harbor(96));
  const CarriedState carried = sim.carriedState();
  const auto next = another(basin(96));
  const auto before = next->stateHash();
  const auto taken = next->takeOver(carried);
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, testing::HasSubstr("cannot continue"));
  EXPECT_EQ(next->stateHash(), before);
}

}  // namespace
}  // namespace spindrift::sim
