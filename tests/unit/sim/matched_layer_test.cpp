// Perfectly matched layers at absorbing sides: the step beside the one in double precision, the ledger, and that
// nothing in them grows.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/dispersion.h>

#include "dispersion_reference.h"
#include "sim_fixture.h"
#include "wave_reference.h"

namespace spindrift::sim {
namespace {

/// Water of 12 m whose four sides absorb.
core::Scene openWater(core::Dispersion dispersion) {
  core::Scene scene;
  scene.name = "open";
  scene.wave.emplace();
  scene.wave->resolution_count = 96;
  scene.wave->side_m = 12.0;
  scene.wave->depth_m = 0.9;
  scene.wave->damping_per_s = 0.0;
  scene.wave->sponge_width_m = 2.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  scene.wave->absorption = core::Absorption::kPml;
  scene.wave->dispersion = dispersion;
  return scene;
}

/// The same with a wall, rocks in layers and in a corner, and a beach that rises through the layer at +x.
core::Scene roughWater(core::Dispersion dispersion) {
  core::Scene scene = openWater(dispersion);
  scene.obstacles = {core::Rock{5.2, 1.0, 0.5, 0.5}, core::Rock{-5.0, -5.0, 0.4, 0.5}, core::Rock{0.5, -4.8, 0.7, 0.5},
                     core::Breakwater{-3.0, 2.0, 4.0, 0.3, 30.0, 0.5}};
  scene.beaches = {core::Beach{core::Side::kPlusX, 3.0, 0.2}};
  return scene;
}

constexpr core::Dispersion kBoth[] = {core::Dispersion::kNone, core::Dispersion::kAiry};

class MatchedLayerOnDevice : public OnDevice {
 protected:
  /// Sets random elevations within `amplitude_m`, without flow.
  StateCopy stir(WaterSim& sim, const Basin& basin, double amplitude_m) {
    StateCopy state = sim.copyState();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> level_m(-amplitude_m, amplitude_m);
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i)
      state.elevation_m[i] = basin.depth_m[i] > 0 ? std::ceil(level_m(random) * 16777216.0) / 16777216.0 : 0.0;
    sim.setState(state);
    return state;
  }

  /// Sum over the cells of g eta^2 and of q^2/d over their faces, without density and the factor 1/2. [m^3/s^2]
  static double energy(WaterSim& sim, const Basin& basin) {
    const StateCopy state = sim.copyState();
    double sum = 0.0;
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
      sum += 9.81 * std::pow(state.elevation_m[i], 2);
      for (std::size_t k = 0; k < 2; ++k) {
        const double depth_m = basin.conductance_m[i][k];
        if (depth_m > 0) sum += std::pow(static_cast<double>(state.flow_m2ps[2 * i + k]), 2) / depth_m;
      }
    }
    return sum;
  }
};

TEST_F(MatchedLayerOnDevice, AgreesWithTheReferenceStepOverAnyBedAndWhereCellsRunEmpty) {
  for (const core::Dispersion dispersion : kBoth) {
    const core::Scene scene = roughWater(dispersion);
    WaterSim& sim = make(scene);
    const Basin basin = layOutBasin(scene, *sim.derived().wave);
    const ReferenceBed bed(scene, basin);
    const DispersionReference operator_f(layOutDispersion(*sim.derived().wave, basin));
    const bool disperses = dispersion == core::Dispersion::kAiry;
    // Columns from empty to twice the depth, and flows that some of them cannot supply.
    std::mt19937 random(3);
    const auto unit = [&] { return std::generate_canonical<double, 53>(random); };
    StateCopy state = sim.copyState();
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
      const double column_m = unit() < 0.1 ? 0.0 : 2 * unit() * basin.depth_m[i];
      state.elevation_m[i] = std::ceil((column_m - basin.depth_m[i]) * 16777216.0) / 16777216.0;
      const bool in_layer = basin.depth_m[i] > 0 && bed.layer_x_per_s[i] + bed.layer_z_per_s[i] > 0;
      if (in_layer) state.elevation_x_units[i] = static_cast<std::int32_t>((unit() - 0.5) * 1e7);
      for (std::size_t k = 0; k < 2; ++k)
        state.flow_m2ps[2 * i + k] =
            basin.conductance_m[i][k] > 0 ? static_cast<float>((unit() - 0.5) * 10.0 * basin.depth_m[i]) : 0.0F;
    }
    sim.setState(state);
    ReferenceWater water{state.elevation_m, {state.flow_m2ps.begin(), state.flow_m2ps.end()}, {}};
    for (const std::int32_t units : state.elevation_x_units) water.elevation_x_m.push_back(units / 16777216.0);
    for (std::uint32_t tick = 0; tick < 2; ++tick) {
      sim.step();
      for (std::uint32_t step = 0; step < sim.derived().wave->substeps_count; ++step)
        referenceFlowStep(scene, sim.derived(), bed, water, disperses ? &operator_f : nullptr);
      EXPECT_GT(water.limited_count, 20U) << "no cell lacked water";
      const StateCopy after = sim.copyState();
      double error_m = 0.0;
      double error_x_m = 0.0;
      for (std::size_t i = 0; i < after.elevation_m.size(); ++i) {
        error_m = std::max(error_m, std::abs(after.elevation_m[i] - water.elevation_m[i]));
        error_x_m = std::max(error_x_m, std::abs(after.elevation_x_units[i] / 16777216.0 - water.elevation_x_m[i]));
        ASSERT_GE(after.elevation_m[i], -static_cast<double>(basin.depth_m[i]));
      }
      EXPECT_LE(error_m, 2e-5) << disperses;
      EXPECT_LE(error_x_m, 2e-5) << disperses;
    }
  }
}

TEST_F(MatchedLayerOnDevice, AgreesWithTheReferenceAfterManySteps) {
  for (const core::Dispersion dispersion : kBoth) {
    const core::Scene scene = roughWater(dispersion);
    WaterSim& sim = make(scene);
    const Basin basin = layOutBasin(scene, *sim.derived().wave);
    const ReferenceBed bed(scene, basin);
    const DispersionReference operator_f(layOutDispersion(*sim.derived().wave, basin));
    const StateCopy start = stir(sim, basin, 0.02);
    ReferenceWater water{start.elevation_m, std::vector<double>(start.flow_m2ps.size()), {}};
    for (int tick = 0; tick < 50; ++tick) {
      sim.step();
      for (std::uint32_t step = 0; step < sim.derived().wave->substeps_count; ++step)
        referenceFlowStep(scene, sim.derived(), bed, water,
                          dispersion == core::Dispersion::kAiry ? &operator_f : nullptr);
    }
    const StateCopy after = sim.copyState();
    double error_m = 0.0;
    for (std::size_t i = 0; i < after.elevation_m.size(); ++i)
      error_m = std::max(error_m, std::abs(after.elevation_m[i] - water.elevation_m[i]));
    EXPECT_LE(error_m, 1e-5);
  }
}

TEST_F(MatchedLayerOnDevice, KeepsTheLedgerToTheUnitThroughSplashesAndBoats) {
  for (const core::Dispersion dispersion : kBoth) {
    core::Scene scene = roughWater(dispersion);
    scene.wave->steepening_ratio = 0.5;
    core::Boat boat;
    boat.x_m = 2.0;
    boat.z_m = 4.0;
    boat.throttle_ratio = 1.0;
    scene.boats.emplace().boats.push_back(boat);
    WaterSim& sim = make(scene);
    ASSERT_TRUE(sim.start(core::Splash{-4.8, 4.8, 1.0, 0.5, 0.2}));
    ASSERT_TRUE(sim.start(core::Splash{1.0, 0.0, 1.5, 0.6, 0.2}));
    for (int i = 0; i < 150; ++i) {
      sim.step();
      ASSERT_EQ(sim.health().surface_units + sim.health().outflow_units, 0) << "tick " << sim.health().tick;
    }
    EXPECT_NE(sim.health().outflow_units, 0) << "some water crossed the open sides";
    EXPECT_EQ(sim.recoveredCount(), 0U);
  }
}

TEST_F(MatchedLayerOnDevice, ALevelSurfaceStaysStillToTheUnit) {
  WaterSim& sim = make(roughWater(core::Dispersion::kAiry));
  const StateCopy before = sim.copyState();
  for (int k = 0; k < 200; ++k) sim.step();
  EXPECT_TRUE(sim.copyState() == before);
}

TEST_F(MatchedLayerOnDevice, NoiseLosesEnergyOverRocksBeachesAndCornersAlsoWhereWavesSteepen) {
  for (const core::Dispersion dispersion : kBoth) {
    for (const double steepening_ratio : {0.0, 0.5}) {
      core::Scene scene = roughWater(dispersion);
      scene.wave->steepening_ratio = steepening_ratio;
      WaterSim& sim = make(scene);
      const Basin basin = layOutBasin(scene, *sim.derived().wave);
      stir(sim, basin, 0.02);
      double before = energy(sim, basin);
      for (int part = 0; part < 4; ++part) {
        for (int k = 0; k < 150; ++k) sim.step();
        const double now = energy(sim, basin);
        EXPECT_LT(now, before) << "part " << part;
        before = now;
      }
    }
  }
}

TEST_F(MatchedLayerOnDevice, ARaisedSurfaceFallsToTheStillLevel) {
  core::Scene scene = openWater(core::Dispersion::kAiry);
  scene.wave->boundary_minus_z = scene.wave->boundary_plus_z = core::WaveBoundary::kPeriodic;
  scene.wave->width_m = 2.0;  // all rows are equal
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kMinusX, 0.2, 1.5, 0.5}));
  // Waves of 0.5 m (4 cells) travel at 0.44 m/s, so that the last of them leave after half a minute.
  for (int k = 0; k < 3600; ++k) sim.step();
  const StateCopy after = sim.copyState();
  EXPECT_LT(std::ranges::max(after.elevation_m), 1e-4);
  EXPECT_GT(std::ranges::min(after.elevation_m), -1e-4);
  double sum_m = 0.0;
  for (const double eta_m : after.elevation_m) sum_m += eta_m;
  EXPECT_NEAR(sum_m / static_cast<double>(after.elevation_m.size()), 0.0, 1e-6);
}

TEST_F(MatchedLayerOnDevice, ACopyOfTheStateBringsTheLayerBack) {
  WaterSim& sim = make(openWater(core::Dispersion::kAiry));
  ASSERT_TRUE(sim.start(core::Splash{4.0, 0.0, 1.0, 0.3, 0.05}));
  for (int k = 0; k < 60; ++k) sim.step();
  const StateCopy copy = sim.copyState();
  EXPECT_TRUE(std::ranges::any_of(copy.elevation_x_units, [](std::int32_t units) { return units != 0; }));
  for (int k = 0; k < 30; ++k) sim.step();
  const StateCopy wanted = sim.copyState();
  sim.setState(copy);
  for (int k = 0; k < 30; ++k) sim.step();
  EXPECT_TRUE(sim.copyState() == wanted);
  sim.reset();
  EXPECT_TRUE(std::ranges::all_of(sim.copyState().elevation_x_units, [](std::int32_t units) { return units == 0; }));
}

TEST_F(MatchedLayerOnDevice, WaterWithoutAbsorbingSidesIsUntouched) {
  for (const core::WaveBoundary sides : {core::WaveBoundary::kPeriodic, core::WaveBoundary::kReflect}) {
    std::uint64_t hash[2];
    for (int k = 0; k < 2; ++k) {
      core::Scene scene = openWater(core::Dispersion::kAiry);
      setBoundaries(*scene.wave, sides);
      scene.wave->absorption = k == 0 ? core::Absorption::kSponge : core::Absorption::kPml;
      WaterSim& sim = make(scene);
      ASSERT_TRUE(sim.start(core::Splash{1.0, 0.0, 1.0, 0.3, 0.05}));
      for (int tick = 0; tick < 40; ++tick) sim.step();
      hash[k] = sim.stateHash();
    }
    EXPECT_EQ(hash[0], hash[1]);
  }
}

}  // namespace
}  // namespace spindrift::sim
