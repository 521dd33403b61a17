// What the state of another resolution of the same water keeps.
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>
#include <shared/fixed_point.h>
#include <shared/pool.h>

#include <spindrift/core/random.h>
#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_state/resample_state.h>

#include "same_water_scenes.h"

namespace spindrift::sim {
namespace {

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

TEST(ResampledState, LevelWaterStaysLevelToTheUnitBesideWallsAndOnTheBeach) {
  for (const auto& [from_count, to_count] : {std::pair{96u, 144u}, {144u, 64u}, {64u, 160u}}) {
    const CarriedState before = stateOf(harbor(from_count), [](double, double) { return 0.0; });
    const ResampledState after = resampledTo(before, harbor(to_count));
    for (const double eta_m : after.state.elevation_m) ASSERT_EQ(eta_m, 0.0);
    for (const float q : after.state.flow_m2ps) ASSERT_EQ(q, 0.0f);
    EXPECT_EQ(after.outflow_units, 0);
  }
}

TEST(ResampledState, TheVolumeStaysAndTheLedgerIsExact) {
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

TEST(ResampledState, MakesNoExtremesAndLeavesDryCellsAndClosedFacesAlone) {
  for (const auto& [from_count, to_count] : {std::pair{96u, 144u}, {144u, 64u}}) {
    CarriedState before = stateOf(harbor(from_count), rough);
    core::SplitMix64 random(5);
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

TEST(ResampledState, BringsLongWavesBackFromACoarserGrid) {
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

TEST(ResampledState, FillsUpCellsWhoseBedIsHigherNow) {
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

TEST(ResampledState, SprayKeepsItsVolumeWithDropsOfTheNewSize) {
  for (const auto& [from_m, to_m] : {std::pair{0.1, 0.143}, {0.1, 0.06}, {0.1, 0.1}}) {
    CarriedState before = stateOf(twoWay(96, from_m), [](double, double) { return 0.0; });
    core::SplitMix64 random(9);
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

TEST(ResampledState, ABoxOfParticlesKeepsItsPlaceAndMotion) {
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

TEST(ResampledState, OnlyTheSameWaterGoesOn) {
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

}  // namespace
}  // namespace spindrift::sim
