// The wave equation on the device: against the reference step and against closed forms.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <shared/fixed_point.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/study/water_reference.h>

#include "sim_fixture.h"
#include "wave_reference.h"

namespace spindrift::sim {
namespace {

core::Scene waveScene(std::uint32_t n = 48) {
  core::Scene scene;
  scene.name = "wave";
  scene.wave.emplace();
  scene.wave->resolution_count = n;
  scene.wave->side_m = 12.0;
  scene.wave->damping_per_s = 0.0;
  return scene;
}

class WaveOnDevice : public OnDevice {
 protected:
  /// Sets the surface eta(x, z), x and z from the corner, at rest to second order: the flow is that of half a step
  /// before a moment of rest.
  void set(WaterSim& sim, auto&& eta) {
    StateCopy state = sim.copyState();
    const WaveLayout w = *sim.derived().wave;
    const auto n = static_cast<int>(w.count_x);
    for (int z = 0; z < n; ++z) {
      for (int x = 0; x < n; ++x)
        state.elevation_m[static_cast<std::size_t>(x + n * z)] = eta((x + 0.5) * w.cell_m, (z + 0.5) * w.cell_m);
    }
    const bool wraps = sim.scene().wave->boundary_minus_x == core::WaveBoundary::kPeriodic;
    const std::size_t components = state.flow_m2ps.size() / state.elevation_m.size();
    for (int z = 0; z < n; ++z) {
      for (int x = 0; x < n; ++x) {
        const auto at = [&](int i, int k) { return state.elevation_m[static_cast<std::size_t>(i % n + n * (k % n))]; };
        const double half_kick = 0.5 * sim.scene().gravity_mps2 * sim.scene().wave->depth_m * w.dt_s / w.cell_m;
        const auto i = static_cast<std::size_t>(x + n * z) * components;
        if (components != 2) continue;
        state.flow_m2ps[i] = wraps || x < n - 1 ? static_cast<float>(half_kick * (at(x + 1, z) - at(x, z))) : 0.0f;
        state.flow_m2ps[i + 1] = wraps || z < n - 1 ? static_cast<float>(half_kick * (at(x, z + 1) - at(x, z))) : 0.0f;
      }
    }
    sim.setState(state);
  }
};

TEST_F(WaveOnDevice, AgreesWithTheReferenceStepForEachStencilAndBoundary) {
  for (const auto stencil : {core::Stencil::kFivePoint, core::Stencil::kNinePoint}) {
    for (const auto boundary : {core::WaveBoundary::kPeriodic, core::WaveBoundary::kReflect}) {
      core::Scene scene = waveScene();
      scene.wave->stencil = stencil;
      setBoundaries(*scene.wave, boundary);
      scene.wave->damping_per_s = 0.7;
      WaterSim& sim = make(scene);
      ASSERT_EQ(sim.derived().wave->substeps_count, 1u);
      set(sim, [](double x, double z) { return 0.3 * std::sin(1.3 * x) * std::cos(0.7 * z) + 0.1 * x; });
      // Step for step, flow and elevation are the leapfrog on three levels.
      const std::vector<double> before = sim.copyState().elevation_m;
      sim.step();
      const std::vector<double> now = sim.copyState().elevation_m;
      sim.step();
      const std::vector<double> after = sim.copyState().elevation_m;
      const auto expected = study::referenceWaveStep(scene, sim.derived(), now, before);
      double worst = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, std::abs(after[i] - expected[i]));
      EXPECT_LE(worst, 1e-6);
    }
  }
}

TEST_F(WaveOnDevice, AConstantLevelIsAFixedPointToTheLastBit) {
  WaterSim& sim = make(waveScene());
  const auto level = [](double, double) { return 0.3; };
  set(sim, level);
  const StateCopy before = sim.copyState();
  for (int i = 0; i < 50; ++i) sim.step();
  EXPECT_EQ(sim.copyState().elevation_m, before.elevation_m);
}

TEST_F(WaveOnDevice, ASplashPushesDownByItsDepthThenRingsOutAndKeepsTheVolume) {
  core::Scene scene = waveScene(96);
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{1.0, -2.0, 1.5, 0.4, 0.05}));
  double lowest = 0;
  for (int i = 0; i < 60; ++i) {
    sim.step();
    const auto eta = sim.copyState().elevation_m;
    lowest = std::min(lowest, static_cast<double>(*std::ranges::min_element(eta)));
  }
  EXPECT_LT(lowest, -0.3);
  EXPECT_GT(lowest, -0.45);
  const auto eta = sim.copyState().elevation_m;
  EXPECT_GT(*std::ranges::max_element(eta), 0.02) << "rings";
  const double volume = std::accumulate(eta.begin(), eta.end(), 0.0) * std::pow(sim.derived().wave->cell_m, 2);
  EXPECT_EQ(volume, 0.0) << "to the last unit";
}

TEST_F(WaveOnDevice, ManySplashesDisplaceTheSumOfWhatEachDisplacesAlone) {
  for (const auto boundary : {core::WaveBoundary::kPeriodic, core::WaveBoundary::kReflect}) {
    core::Scene scene = waveScene();
    setBoundaries(*scene.wave, boundary);
    // Surface at rest, plus these splashes in one step; in units, which the device adds without rounding.
    const auto displaced = [&](const std::vector<core::Splash>& splashes) {
      WaterSim& sim = make(scene);
      EXPECT_EQ(sim.derived().wave->substeps_count, 1u);
      for (core::Splash splash : splashes) {
        splash.duration_s = sim.derived().tick_s;  // everything in the first step
        EXPECT_TRUE(sim.start(splash));
      }
      sim.step();
      std::vector<std::int64_t> out;
      for (const double elevation_m : sim.copyState().elevation_m)
        out.push_back(std::llround(elevation_m * ELEVATION_UNITS_PER_M));
      return out;
    };
    // Alone, the first two are computed on the square that they reach, the others on every cell; together all are
    // computed on every cell.
    const std::vector<core::Splash> splashes = {
        {1.0, -2.0, 0.5, 0.04}, {-5.8, 5.9, 0.4, 0.03}, {2.0, 2.5, 3.0, 0.02}, {-4.0, 1.0, 6.0, 0.05}};
    std::vector<std::int64_t> sum(std::size_t{48} * 48);
    for (const core::Splash& splash : splashes) {
      const auto alone = displaced({splash});
      EXPECT_TRUE(std::ranges::any_of(alone, [](std::int64_t units) { return units < 0; }));
      std::ranges::transform(sum, alone, sum.begin(), std::plus<>());
    }
    EXPECT_EQ(displaced(splashes), sum);
  }
}

TEST_F(WaveOnDevice, WhereWavesDisperseEffectsMoveNothingToWhereTheSurfaceStandsTwiceTheDepthHigh) {
  for (const auto boundary : {core::WaveBoundary::kPeriodic, core::WaveBoundary::kReflect}) {
    core::Scene scene = waveScene(64);
    scene.wave->dispersion = core::Dispersion::kAiry;
    setBoundaries(*scene.wave, boundary);
    // What a splash and a crest change in one step, at a level of so many depths. [units]
    const auto changed = [&](double level_depths) {
      WaterSim& sim = make(scene);
      EXPECT_EQ(sim.derived().wave->substeps_count, 1u);
      const double level_m = level_depths * scene.wave->depth_m;
      set(sim, [&](double, double) { return level_m; });
      const double tick_s = sim.derived().tick_s;
      EXPECT_TRUE(
          sim.start(core::Splash{.x_m = 1.0, .z_m = -2.0, .radius_m = 1.0, .depth_m = 0.1, .duration_s = tick_s}));
      EXPECT_TRUE(sim.start(core::BreakingWave{.side = core::Side::kMinusX, .amplitude_m = 0.1, .duration_s = tick_s}));
      sim.step();
      std::vector<std::int64_t> out;
      for (const double elevation_m : sim.copyState().elevation_m)
        out.push_back(std::llround((elevation_m - level_m) * ELEVATION_UNITS_PER_M));
      return out;
    };
    const auto sizeOf = [](const std::vector<std::int64_t>& units) {
      return std::transform_reduce(units.begin(), units.end(), 0.0, std::plus<>(),
                                   [](std::int64_t u) { return std::abs(static_cast<double>(u)); });
    };
    const auto still = changed(0.0);
    ASSERT_GT(sizeOf(still), 0.01 * ELEVATION_UNITS_PER_M);
    EXPECT_EQ(changed(0.5), still);
    EXPECT_NEAR(sizeOf(changed(1.5)) / sizeOf(still), 0.5, 1e-3);
    EXPECT_EQ(sizeOf(changed(2.0)), 0.0);
    EXPECT_EQ(sizeOf(changed(3.0)), 0.0);
  }
}

TEST_F(WaveOnDevice, RemovedWaterTakesItsMotionAndAddedWaterIsAtRest) {
  core::Scene scene = waveScene(64);
  scene.wave->depth_m = 2.0;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.3, 0.2, 1.0, 0.5, 0.1}));
  for (int i = 0; i < 20; ++i) sim.step();
  const StateCopy before = sim.copyState();
  ASSERT_GT(std::ranges::max(before.flow_m2ps), 0.01f);
  scene.wave->depth_m = 0.5;
  ASSERT_TRUE(sim.setScene(scene));
  const StateCopy shallow = sim.copyState();
  for (std::size_t i = 0; i < before.flow_m2ps.size(); ++i)
    ASSERT_FLOAT_EQ(shallow.flow_m2ps[i], 0.25f * before.flow_m2ps[i]) << "the same speed in a quarter of the water";
  EXPECT_EQ(shallow.elevation_m, before.elevation_m);
  scene.wave->depth_m = 20.0;
  ASSERT_TRUE(sim.setScene(scene));
  EXPECT_EQ(sim.copyState().flow_m2ps, shallow.flow_m2ps);
}

TEST_F(WaveOnDevice, ACrestTravelsOneWayAtTheWaveSpeed) {
  core::Scene scene = waveScene(96);
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kMinusX, 0.3, 1.5, 0.2}));
  const auto crestAt = [&] {
    const auto eta = sim.copyState().elevation_m;
    const std::uint32_t n = sim.derived().wave->count_x;
    const auto row = eta.begin() + n * (n / 2);
    return (static_cast<double>(std::max_element(row, row + n) - row) + 0.5) * sim.derived().wave->cell_m;
  };
  for (int i = 0; i < 30; ++i) sim.step();
  const double first = crestAt();
  for (int i = 0; i < 60; ++i) sim.step();
  const double second = crestAt();
  EXPECT_NEAR(second - first, sim.derived().wave->speed_mps * 60 / scene.tick_rate_hz, 2 * sim.derived().wave->cell_m);
  const auto eta = sim.copyState().elevation_m;
  EXPECT_NEAR(*std::ranges::max_element(eta), 0.3, 0.05) << "its amplitude above the lowered mean";
}

TEST_F(WaveOnDevice, VolumeIsExactWithEveryKindOfSideBedAndEffect) {
  for (const auto stencil : {core::Stencil::kFivePoint, core::Stencil::kNinePoint}) {
    core::Scene scene = waveScene(96);
    scene.wave->stencil = stencil;
    scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
    scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
    scene.wave->sponge_width_m = 1.5;
    scene.wave->steepening_ratio = 0.5;
    scene.obstacles = {core::Rock{1.0, 1.0, 0.7, 0.5}, core::Breakwater{-1.0, -2.0, 3.0, 0.5, 30.0, 0.5}};
    scene.beaches = {core::Beach{core::Side::kPlusX, 2.0, 0.0}};
    scene.storm.emplace();
    scene.storm->level_ratio = 1.0;
    scene.storm->drops_per_m2_s = 1.0;
    WaterSim& sim = make(scene);
    ASSERT_TRUE(sim.start(core::Splash{1.5, 1.0, 2.0, 0.8, 0.2}));
    ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kMinusX, 0.4, 1.5, 0.3}));
    ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kDirection, 0.4, 1.5, 0.3, core::WaveShape::kSwell, 50.0}));
    double highest = 0;
    for (int i = 0; i < 300; ++i) {
      sim.step();
      ASSERT_EQ(sim.health().surface_units + sim.health().outflow_units, 0) << "tick " << sim.health().tick;
      highest = std::max(highest, sim.health().max_elevation_m);
    }
    EXPECT_NE(sim.health().outflow_units, 0) << "some water crossed the open side";
    EXPECT_GT(highest, 0.3);
    EXPECT_LT(highest, 3.0);
    EXPECT_EQ(sim.health().nonfinite_count, 0u);
  }
}

/// Water whose four sides absorb, as in scene `splash_wave`.
core::Scene openScene(std::uint32_t n, double side_m, double sponge_width_m, core::Stencil stencil) {
  core::Scene scene = waveScene(n);
  scene.wave->side_m = side_m;
  scene.wave->sponge_width_m = sponge_width_m;
  scene.wave->stencil = stencil;
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  return scene;
}

TEST_F(WaveOnDevice, AbsorbingSidesKeepTheStepRuleAtEveryDepth) {
  // Depths for which the step of the rule is close to its bound. With the loss applied after the step instead of around
  // its middle, they grew into a checkerboard within two seconds (scenes splash, open_water and boat_wake, with a
  // splash of 0.5 m).
  struct Case {
    std::uint32_t n;
    double side_m, sponge_width_m;
    core::Stencil stencil;
    double depth_m;
  };
  const Case cases[] = {{192, 16.0, 2.0, core::Stencil::kFivePoint, 1.2},
                        {256, 30.0, 4.0, core::Stencil::kNinePoint, 3.5},
                        {256, 28.0, 3.0, core::Stencil::kFivePoint, 2.05}};
  for (const Case& each : cases) {
    core::Scene scene = openScene(each.n, each.side_m, each.sponge_width_m, each.stencil);
    scene.wave->depth_m = each.depth_m;
    WaterSim& sim = make(scene);
    ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 1.6, 0.5, 0.22}));
    for (int i = 0; i < 300; ++i) sim.step();
    EXPECT_GT(sim.derived().wave->courant, 0.9 * (each.stencil == core::Stencil::kFivePoint ? 0.7071 : 0.866))
        << "a step far below the bound proves nothing";
    EXPECT_LT(sim.health().max_elevation_m, 0.05) << "depth " << each.depth_m << " m: the rings have left";
    EXPECT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
    EXPECT_EQ(sim.recoveredCount(), 0u);
  }
}

/// A rock, a wall, a beach that runs dry, and one side that absorbs.
core::Scene roughScene(core::Stencil stencil) {
  core::Scene scene = waveScene(64);
  scene.wave->stencil = stencil;
  scene.wave->damping_per_s = 0.3;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
  scene.wave->sponge_width_m = 1.5;
  scene.obstacles = {core::Rock{1.0, 1.0, 0.7, 0.5}, core::Breakwater{-1.0, -2.0, 3.0, 0.5, 30.0, 0.5}};
  scene.beaches = {core::Beach{core::Side::kPlusX, 3.0, 0.0}};
  return scene;
}

TEST_F(WaveOnDevice, AgreesWithTheReferenceStepOverAnyBedInSpongesAndWhereCellsRunEmpty) {
  for (const auto stencil : {core::Stencil::kFivePoint, core::Stencil::kNinePoint}) {
    const core::Scene scene = roughScene(stencil);
    WaterSim& sim = make(scene);
    ASSERT_EQ(sim.derived().wave->substeps_count, 1u);
    const Basin basin = layOutBasin(scene, *sim.derived().wave);
    const ReferenceBed bed(scene, basin);
    // Columns from empty to twice the depth, and flows that some of them cannot supply.
    std::mt19937 random(3);
    const auto unit = [&] { return std::generate_canonical<double, 53>(random); };
    StateCopy state = sim.copyState();
    const std::size_t components = state.flow_m2ps.size() / state.elevation_m.size();
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
      const double column_m = unit() < 0.1 ? 0.0 : 2 * unit() * basin.depth_m[i];
      state.elevation_m[i] = std::ceil((column_m - basin.depth_m[i]) * 16777216.0) / 16777216.0;
      for (std::size_t k = 0; k < components; ++k)
        state.flow_m2ps[components * i + k] =
            basin.conductance_m[i][k] > 0 ? static_cast<float>((unit() - 0.5) * 10.0 * basin.depth_m[i]) : 0.0f;
    }
    sim.setState(state);
    ReferenceWater water{state.elevation_m, {state.flow_m2ps.begin(), state.flow_m2ps.end()}, {}};
    for (int step = 0; step < 3; ++step) {
      SCOPED_TRACE(step);
      sim.step();
      referenceFlowStep(scene, sim.derived(), bed, water);
      EXPECT_GT(water.limited_count, 20u) << "no cell lacked water";
      const StateCopy after = sim.copyState();
      double elevation_error_m = 0.0;
      double flow_error_m2ps = 0.0;
      for (std::size_t i = 0; i < after.elevation_m.size(); ++i) {
        elevation_error_m = std::max(elevation_error_m, std::abs(after.elevation_m[i] - water.elevation_m[i]));
        ASSERT_GE(after.elevation_m[i], -static_cast<double>(basin.depth_m[i]));
      }
      for (std::size_t i = 0; i < after.flow_m2ps.size(); ++i)
        flow_error_m2ps = std::max(flow_error_m2ps, std::abs(after.flow_m2ps[i] - water.flow_m2ps[i]));
      EXPECT_LE(elevation_error_m, 1e-5);
      EXPECT_LE(flow_error_m2ps, 1e-4);
    }
  }
}

TEST_F(WaveOnDevice, ARisingBedLiftsTheSurfaceAndKeepsTheLedger) {
  core::Scene scene = roughScene(core::Stencil::kFivePoint);
  scene.wave->depth_m = 2.0;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{-2.0, 2.0, 1.5, 1.5, 0.1}));
  for (int i = 0; i < 8; ++i) sim.step();
  const StateCopy deep = sim.copyState();
  ASSERT_LT(std::ranges::min(deep.elevation_m), -0.6);
  scene.wave->depth_m = 0.5;
  ASSERT_TRUE(sim.setScene(scene));
  const StateCopy shallow = sim.copyState();
  EXPECT_GE(std::ranges::min(shallow.elevation_m), -0.5);
  EXPECT_EQ(std::accumulate(shallow.elevation_m.begin(), shallow.elevation_m.end(), 0.0),
            std::accumulate(deep.elevation_m.begin(), deep.elevation_m.end(), 0.0))
      << "whole units: the sums are exact";
  for (int i = 0; i < 20; ++i) {
    sim.step();
    ASSERT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
  }
}

}  // namespace
}  // namespace spindrift::sim
