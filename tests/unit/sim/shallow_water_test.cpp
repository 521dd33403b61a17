// The nonlinear bulk on the device: water stays, never goes below the bed, keeps its volume, and moves over its shore.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <shared/fixed_point.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::WaveBoundary;

/// 40 x 56 cells of half a metre, 1.5 m deep, with a beach that rises to land, a rock and a wall across the water.
core::Scene shore(bool disperses) {
  core::Scene scene;
  scene.name = "shore";
  scene.wave.emplace();
  core::WaveScene& wave = *scene.wave;
  wave.resolution_count = 40;
  wave.side_m = 20.0;
  wave.width_m = 28.0;
  wave.depth_m = 1.5;
  wave.damping_per_s = 0.0;
  wave.bulk = core::Bulk::kNonlinear;
  wave.dispersion = disperses ? core::Dispersion::kAiry : core::Dispersion::kNone;
  setBoundaries(wave, WaveBoundary::kReflect);
  scene.beaches = {core::Beach{core::Side::kPlusX, 12.0, -1.0}};
  scene.obstacles = {
      core::Rock{.x_m = -5, .z_m = 6, .radius_m = 2.0, .height_m = 0.6},
      core::Breakwater{.x_m = 0, .z_m = -6, .length_m = 40, .width_m = 1.2, .heading_deg = 0, .height_m = 0.5}};
  return scene;
}

/// Water over the bed of each cell, in units.
std::vector<std::int64_t> heldUnits(WaterSim& water) {
  const Basin basin = layOutBasin(water.scene(), *water.derived().wave);
  const StateCopy state = water.copyState();
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i)
    out.push_back(std::llround(state.elevation_m[i] * double{ELEVATION_UNITS_PER_M}) + bedUnits(basin.bed[i][2]));
  return out;
}

void setLevels(WaterSim& water, double far_m, double near_m) {
  const Basin basin = layOutBasin(water.scene(), *water.derived().wave);
  StateCopy state = water.copyState();
  const std::size_t nx = water.derived().wave->count_x;
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
    const double ground_m = static_cast<double>(-bedUnits(basin.bed[i][2])) / double{ELEVATION_UNITS_PER_M};
    state.elevation_m[i] = std::max(i / nx < 16 ? far_m : near_m, ground_m);
  }
  water.setState(state);
}

class ShallowWater : public OnDevice, public ::testing::WithParamInterface<bool> {};

TEST_P(ShallowWater, AtRestAtTwoLevelsDoesNotMoveByOneUnit) {
  WaterSim& water = make(shore(GetParam()));
  setLevels(water, 0.2, -0.15);
  const auto before = water.copyState();
  for (int k = 0; k < 200; ++k) water.step();
  const auto after = water.copyState();
  EXPECT_EQ(before.elevation_m, after.elevation_m);
  EXPECT_TRUE(std::ranges::all_of(after.flow_m2ps, [](float v) { return v == 0.0f; }));
}

TEST_P(ShallowWater, BesideLandOfAnyHeightRunsWithoutTheWatchdog) {
  for (const double land_m : {65.0, 70.0, 9000.0}) {
    core::Scene scene = shore(GetParam());
    scene.beaches = {core::Beach{core::Side::kPlusX, 5.0, -land_m}};
    WaterSim& water = make(scene);
    ASSERT_TRUE(water.start(core::Splash{.x_m = 0, .z_m = 0, .radius_m = 1.5, .depth_m = 0.5, .duration_s = 0.1}));
    for (int k = 0; k < 60; ++k) water.step();
    EXPECT_EQ(water.recoveredCount(), 0u) << land_m;
    EXPECT_EQ(water.health().volume_error_units, 0) << land_m;
    EXPECT_GT(water.health().max_elevation_m, 0.0) << land_m;
    EXPECT_LT(water.health().max_elevation_m, 1.0) << land_m << ": water, not land";
  }
}

TEST_P(ShallowWater, NeverHoldsLessThanNothingAndKeepsItsVolume) {
  WaterSim& water = make(shore(GetParam()));
  for (int k = 0; k < 400; ++k) {
    if (k % 20 == 0) {
      const double place_m = -9.0 + 0.9 * (k / 20 % 20);
      ASSERT_TRUE(water.start(
          core::Splash{.x_m = place_m * 0.9, .z_m = place_m, .radius_m = 1.5, .depth_m = 1.2, .duration_s = 0.1}));
    }
    water.step();
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << k;
    if (k % 7 == 0) {
      ASSERT_GE(std::ranges::min(heldUnits(water)), 0) << "tick " << k;
    }
  }
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_EQ(water.nonfiniteCount(), 0u);
}

TEST_P(ShallowWater, RunsUpTheBeachAndLeavesItAgain) {
  WaterSim& water = make(shore(GetParam()));
  const Basin basin = layOutBasin(water.scene(), *water.derived().wave);
  ASSERT_TRUE(water.start(
      core::BreakingWave{.side = core::Side::kMinusX, .amplitude_m = 0.5, .length_m = 4.0, .duration_s = 0.6}));
  const auto wetLand = [&] {
    const auto held = heldUnits(water);
    std::size_t count = 0;
    for (std::size_t i = 0; i < held.size(); ++i)
      count += basin.bed[i][2] < 0 && static_cast<double>(held[i]) > 0.02 * double{ELEVATION_UNITS_PER_M} ? 1 : 0;
    return count;
  };
  EXPECT_EQ(wetLand(), 0u);
  std::size_t most = 0;
  for (int k = 0; k < 600; ++k) {
    water.step();
    if (k % 5 == 0) most = std::max(most, wetLand());
  }
  EXPECT_GT(most, 40u) << "a wave of half a metre floods more than one row of land";
  EXPECT_LT(wetLand(), most / 2) << "it runs back";
  EXPECT_EQ(water.health().volume_error_units, 0);
}

TEST_P(ShallowWater, GoesOnInFinerCellsWithItsVolumeAndWithoutANegativeDepth) {
  WaterSim& coarse = make(shore(GetParam()));
  ASSERT_TRUE(coarse.start(
      core::BreakingWave{.side = core::Side::kMinusX, .amplitude_m = 0.5, .length_m = 4.0, .duration_s = 0.6}));
  for (int k = 0; k < 250; ++k) coarse.step();
  const CarriedState carried = coarse.carriedState();
  core::Scene finer = shore(GetParam());
  finer.wave->resolution_count = 60;
  auto made = WaterSim::create(*ctx_, finer);
  ASSERT_TRUE(made) << made.error().message;
  WaterSim& fine = **made;
  const auto taken = fine.takeOver(carried);
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_GE(std::ranges::min(heldUnits(fine)), 0);
  const auto mean = [](const std::vector<std::int64_t>& held) {
    double sum = 0.0;
    for (const std::int64_t units : held) sum += static_cast<double>(units);
    return sum / static_cast<double>(held.size()) / double{ELEVATION_UNITS_PER_M};
  };
  EXPECT_NEAR(mean(heldUnits(fine)), mean(heldUnits(coarse)), 0.02) << "the shores of the two grids differ";
  for (int k = 0; k < 100; ++k) fine.step();
  EXPECT_EQ(fine.health().volume_error_units, 0);
  EXPECT_EQ(fine.recoveredCount(), 0u);
  EXPECT_GE(std::ranges::min(heldUnits(fine)), 0);
}

TEST_P(ShallowWater, RepeatsBitForBit) {
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    WaterSim& water = make(shore(GetParam()));
    ASSERT_TRUE(water.start(core::Splash{.x_m = -3, .z_m = 8, .radius_m = 2.0, .depth_m = 1.0, .duration_s = 0.2}));
    for (int k = 0; k < 100; ++k) water.step();
    hash = water.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

INSTANTIATE_TEST_SUITE_P(Waves, ShallowWater, ::testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "Dispersed" : "Long"; });

class ShallowRules : public OnDevice {};

TEST_F(ShallowRules, NineNeighboursSteepeningAndGreatDepthsAreRefusedByName) {
  const auto messageOf = [](core::Scene scene) {
    const auto derived = derive(scene);
    return derived ? std::string() : derived.error().message;
  };
  core::Scene scene = shore(false);
  EXPECT_EQ(messageOf(scene), "");
  scene.wave->stencil = core::Stencil::kNinePoint;
  EXPECT_NE(messageOf(scene).find("wave.bulk: BULK_NONLINEAR needs STENCIL_FIVE_POINT"), std::string::npos);
  scene = shore(false);
  scene.wave->steepening_ratio = 0.4;
  EXPECT_NE(messageOf(scene).find("wave.steepening_ratio: 0.4"), std::string::npos);
  scene = shore(false);
  scene.wave->depth_m = 60.0;
  EXPECT_NE(messageOf(scene).find("at most 50 m"), std::string::npos);
}

TEST_F(ShallowRules, DepthCannotChangeWhileTheWaterRuns) {
  WaterSim& water = make(shore(false));
  core::Scene deeper = water.scene();
  deeper.wave->depth_m = 2.0;
  const auto changed = water.setScene(deeper);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().message.find("wave.depth_m: cannot change"), std::string::npos);
  core::Scene rougher = water.scene();
  rougher.wave->manning_spm13 = 0.05;
  EXPECT_TRUE(water.setScene(rougher));
}

TEST_F(ShallowRules, BoatsGroundOnABeachThatFallsDryAndKeepTheirHeight) {
  core::Scene scene = shore(true);
  scene.boats.emplace();
  // Above the waterline: the slope of 2.5 in 12 meets the still water 4.8 m from the side.
  scene.boats->boats = {
      core::Boat{.x_m = 6.5, .z_m = 6.0, .heading_deg = 90, .length_m = 2.0, .beam_m = 0.8, .height_m = 0.6}};
  WaterSim& water = make(scene);
  for (int k = 0; k < 300; ++k) water.step();
  const BoatRecord boat = water.boats().front();
  ASSERT_TRUE(water.controlBoat(boat.boat_id, 1.0, 0.0));
  for (int k = 0; k < 300; ++k) water.step();
  const StateCopy state = water.copyState();
  EXPECT_TRUE(std::ranges::all_of(state.boats, [](float v) { return std::isfinite(v); }));
  const float height_m = state.boats[1];
  const double ground_m = -1.0 + 2.5 * (6.5 - -2.0) / 12.0 - 0.5;  // of the beach under its start
  EXPECT_GT(height_m, ground_m - 0.1) << "it stands on the ground";
  EXPECT_LT(height_m, ground_m + 0.6);
  EXPECT_NEAR(state.boats[2], 6.0f, 0.5f) << "and does not sail there";
}

}  // namespace
}  // namespace spindrift::sim
