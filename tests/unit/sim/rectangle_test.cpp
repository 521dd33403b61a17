// Water that is not square: any number of cells along each axis, down to one.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/study/water_reference.h>

#include "sim_fixture.h"
#include "wave_reference.h"

namespace spindrift::sim {
namespace {

constexpr double kCell_m = 0.2;

core::Scene rectangle(std::uint32_t nx, std::uint32_t nz) {
  core::Scene scene;
  scene.name = "rectangle";
  scene.wave.emplace();
  scene.wave->resolution_count = nx;
  scene.wave->side_m = nx * kCell_m;
  scene.wave->width_m = nz * kCell_m;
  scene.wave->depth_m = 1.0;
  scene.wave->damping_per_s = 0.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

/// The same water with x and z exchanged. Rocks, beaches and splashes only.
core::Scene turned(core::Scene scene) {
  const core::WaveCells cells = core::waveCellsOf(*scene.wave);
  core::WaveScene& w = *scene.wave;
  w.resolution_count = cells.count.z;
  w.side_m = cells.width_m;
  w.width_m = cells.length_m;
  std::swap(w.boundary_minus_x, w.boundary_minus_z);
  std::swap(w.boundary_plus_x, w.boundary_plus_z);
  for (core::Obstacle& obstacle : scene.obstacles) {
    auto& rock = std::get<core::Rock>(obstacle);
    std::swap(rock.x_m, rock.z_m);
  }
  for (core::Beach& beach : scene.beaches)
    beach.side = beach.side == core::Side::kPlusX ? core::Side::kPlusZ : core::Side::kMinusZ;
  return scene;
}

class Rectangle : public OnDevice {
 protected:
  /// Elevation of a random surface, with waves from 3 cells up. Row by row.
  static std::vector<double> roughness(core::CellCounts count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<double> out(count.total());
    for (int wave = 0; wave < 6; ++wave) {
      const double kx = 2 * unit(random), kz = 2 * unit(random), phase = 3 * unit(random);
      for (std::uint32_t z = 0; z < count.z; ++z)
        for (std::uint32_t x = 0; x < count.x; ++x) out[x + count.x * z] += 0.03 * std::sin(kx * x + kz * z + phase);
    }
    return out;
  }

  static std::vector<double> transposed(const std::vector<double>& rows, core::CellCounts count) {
    std::vector<double> out(rows.size());
    for (std::uint32_t z = 0; z < count.z; ++z)
      for (std::uint32_t x = 0; x < count.x; ++x) out[z + count.z * x] = rows[x + count.x * z];
    return out;
  }

  /// Dry cells stay at 0.
  static void setElevation(WaterSim& sim, std::vector<double> eta_m) {
    const Basin basin = layOutBasin(sim.scene(), *sim.derived().wave);
    StateCopy state = sim.copyState();
    for (std::size_t i = 0; i < eta_m.size(); ++i) state.elevation_m[i] = basin.depth_m[i] > 0 ? eta_m[i] : 0.0;
    std::ranges::fill(state.flow_m2ps, 0.0F);
    sim.setState(state);
  }
};

TEST_F(Rectangle, AgreesWithTheReferenceStepForEachStencilAndBoundary) {
  for (const auto& [nx, nz] : {std::pair{37u, 113u}, {113u, 37u}, {9u, 5u}, {50u, 2u}, {1u, 40u}, {40u, 1u}}) {
    for (const auto stencil : {core::Stencil::kFivePoint, core::Stencil::kNinePoint}) {
      for (const auto boundary : {core::WaveBoundary::kPeriodic, core::WaveBoundary::kReflect}) {
        core::Scene scene = rectangle(nx, nz);
        scene.wave->stencil = stencil;
        setBoundaries(*scene.wave, boundary);
        scene.wave->damping_per_s = 0.7;
        WaterSim& sim = make(scene);
        ASSERT_EQ(sim.derived().wave->count_x, nx);
        ASSERT_EQ(sim.derived().wave->count_z, nz);
        setElevation(sim, roughness({nx, nz}, 3));
        const std::vector<double> before = sim.copyState().elevation_m;
        sim.step();
        const std::vector<double> now = sim.copyState().elevation_m;
        sim.step();
        const std::vector<double> after = sim.copyState().elevation_m;
        const auto expected = study::referenceWaveStep(scene, sim.derived(), now, before);
        double worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, std::abs(after[i] - expected[i]));
        EXPECT_LE(worst, 1e-6) << nx << " x " << nz;
      }
    }
  }
}

TEST_F(Rectangle, WaterTurnedByNinetyDegreesHasTheSameBits) {
  core::Scene scene = rectangle(61, 23);
  scene.wave->boundary_plus_x = core::WaveBoundary::kAbsorb;
  scene.wave->sponge_width_m = 2.0;
  // A matched layer would take the elevation set here as water that came along z.
  scene.wave->absorption = core::Absorption::kSponge;
  scene.obstacles.emplace_back(core::Rock{.x_m = 1.3, .z_m = -0.7, .radius_m = 0.6});
  scene.beaches.push_back({.side = core::Side::kMinusX, .width_m = 3.0, .shore_depth_m = 0.2});
  WaterSim& sim = make(scene);
  const auto eta_m = roughness({61, 23}, 5);
  setElevation(sim, eta_m);
  ASSERT_TRUE(sim.start(core::Splash{-1.0, 0.4, 0.9, 0.2, 0.2}));
  ASSERT_TRUE(sim.start(core::BreakingWave{.side = core::Side::kMinusX, .amplitude_m = 0.1, .length_m = 2.0}));
  for (int k = 0; k < 300; ++k) sim.step();
  const auto along = sim.copyState().elevation_m;

  WaterSim& other = make(turned(scene));
  setElevation(other, transposed(eta_m, {61, 23}));
  ASSERT_TRUE(other.start(core::Splash{0.4, -1.0, 0.9, 0.2, 0.2}));
  ASSERT_TRUE(other.start(core::BreakingWave{.side = core::Side::kMinusZ, .amplitude_m = 0.1, .length_m = 2.0}));
  for (int k = 0; k < 300; ++k) other.step();
  const auto expected = transposed(along, {61, 23});
  const auto across = other.copyState().elevation_m;
  if (ctx_->device().is_software) {
    EXPECT_EQ(expected, across);
    return;
  }
  // A GPU's compiler may fuse the products along x and those along z in different ways: rounding differs.
  ASSERT_EQ(expected.size(), across.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(expected[i], across[i], 1e-5) << i;
}

TEST_F(Rectangle, ADispersedCrestAlongAChannelIsTheSameAlongXAndAlongZ) {
  for (const std::uint32_t across : {1u, 10u, 13u}) {
    core::Scene scene = rectangle(150, across);
    scene.wave->dispersion = core::Dispersion::kAiry;
    const auto run = [&](const core::Scene& of, core::Side side) {
      WaterSim& sim = make(of);
      EXPECT_TRUE(
          sim.start(core::BreakingWave{.side = side, .amplitude_m = 0.05, .length_m = 0.2 * std::min(across, 5u)}));
      for (int k = 0; k < 300; ++k) sim.step();
      return sim.copyState().elevation_m;
    };
    const auto along_x = transposed(run(scene, core::Side::kMinusX), {150, across});
    const auto along_z = run(turned(scene), core::Side::kMinusZ);
    if (across == 1) {
      EXPECT_EQ(along_x, along_z) << "to the bit";
      continue;
    }
    // The passes add up x before z.
    double worst_m = 0.0;
    for (std::size_t i = 0; i < along_x.size(); ++i) worst_m = std::max(worst_m, std::abs(along_x[i] - along_z[i]));
    EXPECT_LT(worst_m, 5e-6) << across;
  }
}

/// 37 x 113 cells with everything that a scene can have on a wave.
core::Scene everything() {
  core::Scene scene = rectangle(37, 113);
  scene.seed = 4;
  scene.wave->depth_m = 1.2;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.wave->steepening_ratio = 0.5;
  scene.wave->sponge_width_m = 2.0;
  scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
  scene.wave->boundary_minus_z = scene.wave->boundary_plus_z = core::WaveBoundary::kAbsorb;
  scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 2.0, .shore_depth_m = 0.0});
  scene.obstacles.emplace_back(core::Rock{.x_m = 0.0, .z_m = 4.0, .radius_m = 0.7});
  scene.particles.emplace();
  scene.particles->count = 2000;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = 0.1;
  scene.foam.emplace();
  scene.foam->surface = true;
  scene.boats.emplace();
  scene.boats->boats = {
      core::Boat{.z_m = -5.0, .length_m = 1.6, .beam_m = 0.6, .throttle_ratio = 1.0, .rudder_ratio = 0.2},
      core::Boat{.x_m = -1.0, .z_m = 8.0, .length_m = 1.2, .beam_m = 0.5, .throttle_ratio = -0.7}};
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.storm->wind_speed_mps = 10.0;
  scene.storm->drops_per_m2_s = 0.5;
  return scene;
}

TEST_F(Rectangle, AnOddRectangleWithEverythingKeepsItsLedgerAndNeedsNoWatchdog) {
  WaterSim& sim = make(everything());
  const std::int64_t droplet_units = sim.derived().uniforms.droplet_units;
  for (int tick = 0; tick < 450; ++tick) {
    if (tick % 200 == 100) {
      ASSERT_TRUE(sim.start(core::BreakingWave{.side = core::Side::kMinusX, .amplitude_m = 0.5, .length_m = 2.0}));
    }
    sim.step();
    const Health& h = sim.health();
    ASSERT_EQ(
        h.surface_units + h.outflow_units +
            droplet_units * (static_cast<std::int64_t>(h.emitted_count) - static_cast<std::int64_t>(h.absorbed_count)),
        0)
        << tick;
  }
  EXPECT_EQ(sim.recoveredCount(), 0u);
  EXPECT_GT(sim.health().emitted_count, 0u) << "it broke";
  EXPECT_LT(sim.health().max_elevation_m, 2.4);
}

TEST_F(Rectangle, WaterOfOneCellPerAxisStaysStill) {
  for (const auto dispersion : {core::Dispersion::kNone, core::Dispersion::kAiry}) {
    core::Scene scene = rectangle(1, 1);
    scene.wave->dispersion = dispersion;
    WaterSim& sim = make(scene);
    for (int k = 0; k < 10; ++k) sim.step();
    EXPECT_EQ(sim.copyState().elevation_m.at(0), 0.0);
    EXPECT_EQ(sim.recoveredCount(), 0u);
  }
}

TEST_F(Rectangle, ANumberOfCellsThatPeriodicSidesCannotHalveIsRefusedWithThoseThatCan) {
  core::Scene scene = rectangle(64, 37);
  scene.wave->dispersion = core::Dispersion::kAiry;
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  const auto refused = derive(scene);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("37 cells along z between periodic sides"), std::string::npos)
      << refused.error().message;
  EXPECT_NE(refused.error().message.find("use 32 or 48"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace spindrift::sim
