// The dispersion's V-cycle on the device beside the one in double precision, and the waves that it makes.
#include "dispersed_slope.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <shared/bindings.h>

#include <spindrift/sim_setup/scene_parts.h>

#include "dispersion_reference.h"
#include "shader_defines.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class DispersedSlopeOnDevice : public OnDevice {
 protected:
  /// Largest difference from the reference over the root mean square, for a random level. `first_depth_m`: the depth
  /// with which the buffers are made, if another one.
  double largestDifference(const core::Scene& scene, bool has_head, std::optional<double> first_depth_m = {}) {
    const WaveLayout layout = *derive(scene)->wave;
    const Basin basin = layOutBasin(scene, layout);
    core::Scene first = scene;
    first.wave->depth_m = first_depth_m.value_or(scene.wave->depth_m);
    const WaveLayout first_layout = *derive(first)->wave;
    gpu::Defines defines = shaderDefines(scene);
    for (auto& [name, value] : defines) {
      if (name == "HEAD") value = has_head ? "1" : "0";
    }
    Creation create(*ctx_, defines);
    DispersedSlope slope(create, first_layout, layOutDispersion(first_layout, layOutBasin(first, first_layout)), false);
    EXPECT_FALSE(create.error()) << create.error()->message;
    if (first_depth_m) slope.upload(layOutDispersion(layout, basin));
    auto uniforms = gpu::Buffer::create(*ctx_, "uniforms", sizeof(shared::SimUniforms), gpu::BufferUse::kUpdatable);
    uniforms->uploadValue(derive(scene)->uniforms);
    uniforms->bindUniform(SIM_UNIFORMS);
    const std::size_t cells = basin.depth_m.size();
    auto elevation = gpu::TexelBuffer::create(*ctx_, "elevation", cells, gpu::TexelFormat::kR32I);
    auto head = gpu::TexelBuffer::create(*ctx_, "head", cells, gpu::TexelFormat::kR32I);
    std::mt19937 random(7);
    std::uniform_int_distribution<std::int32_t> units(-(1 << 22), 1 << 22);
    std::vector<std::int32_t> eta(cells);
    std::vector<std::int32_t> pressed(cells);
    std::vector<double> level(cells);
    for (std::size_t i = 0; i < cells; ++i) {
      if (basin.depth_m[i] > 0) eta[i] = units(random);
      if (basin.depth_m[i] > 0 && has_head) pressed[i] = units(random);
      level[i] = eta[i] + pressed[i];
    }
    elevation->upload(eta);
    head->upload(pressed);
    elevation->bindTexel(ELEVATION);
    if (has_head) head->bindTexel(PRESSURE_HEAD);
    slope.compute();
    const auto got = slope.texels().downloadVector<float>(2 * cells);
    const auto wanted = DispersionReference(layOutDispersion(layout, basin)).apply(level);
    double square = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < cells; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        square += std::pow(wanted[i][axis], 2) / (2.0 * static_cast<double>(cells));
        largest = std::max(largest, std::abs(static_cast<double>(got[2 * i + axis]) - wanted[i][axis]));
      }
    }
    return largest / std::sqrt(square);
  }

  static core::Scene sea(std::uint32_t n, double depth_m) {
    core::Scene scene;
    scene.wave.emplace();
    scene.wave->resolution_count = n;
    scene.wave->side_m = 0.125 * n;
    scene.wave->depth_m = depth_m;
    scene.wave->dispersion = core::Dispersion::kAiry;
    return scene;
  }
};

TEST_F(DispersedSlopeOnDevice, AgreesWithTheReference) {
  for (const std::uint32_t n : {32u, 80u, 192u}) EXPECT_LE(largestDifference(sea(n, 1.2), false), 2e-5) << n;
  EXPECT_LE(largestDifference(sea(128, 5.0), false), 2e-5);
  EXPECT_LE(largestDifference(sea(128, 0.1), true), 2e-5);
}

TEST_F(DispersedSlopeOnDevice, AgreesWithTheReferenceInRectanglesOfAnyNumberOfCells) {
  struct Counts {
    std::uint32_t x, z;
  };
  for (const Counts n :
       {Counts{37, 113}, {113, 37}, {400, 10}, {10, 400}, {200, 1}, {1, 200}, {7, 5}, {3, 90}, {65, 66}}) {
    core::Scene scene = sea(n.x, 1.2);
    scene.wave->width_m = 0.125 * n.z;
    setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
    EXPECT_LE(largestDifference(scene, false), 2e-5) << n.x << " x " << n.z;
    if (std::min(n.x, n.z) < 10) continue;
    scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 0.06 * n.x, .shore_depth_m = 0.3});
    scene.obstacles.emplace_back(core::Rock{.x_m = 0.1, .z_m = -0.1, .radius_m = 0.4});
    EXPECT_LE(largestDifference(scene, true), 2e-5) << n.x << " x " << n.z;
  }
  for (const Counts n : {Counts{48, 96}, {96, 1}, {2, 64}, {8, 200}, {496, 16}}) {
    core::Scene scene = sea(n.x, 1.2);
    scene.wave->width_m = 0.125 * n.z;
    if (n.z == 200) scene.wave->boundary_minus_z = scene.wave->boundary_plus_z = core::WaveBoundary::kReflect;
    EXPECT_LE(largestDifference(scene, false), 2e-5) << n.x << " x " << n.z << ", periodic";
  }
}

TEST_F(DispersedSlopeOnDevice, AgreesWithTheReferenceBesideWallsRocksAndBeaches) {
  core::Scene scene = sea(96, 1.2);
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  EXPECT_LE(largestDifference(scene, true), 2e-5);
  scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 4.0, .shore_depth_m = 0.3});
  EXPECT_LE(largestDifference(scene, true), 2e-5);
  scene.obstacles.emplace_back(core::Rock{.x_m = 2.1, .z_m = -1.3, .radius_m = 0.9});
  scene.obstacles.emplace_back(
      core::Breakwater{.x_m = -1.0, .z_m = 2.0, .length_m = 5.0, .width_m = 0.2, .heading_deg = 30});
  EXPECT_LE(largestDifference(scene, true), 2e-5);
}

TEST_F(DispersedSlopeOnDevice, AgreesWithTheReferenceBesideThinWallsThatDivideBlocksOfAllGrids) {
  for (const std::uint32_t n : {80u, 96u}) {
    core::Scene scene = sea(n, 1.2);
    setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
    // From 1/4 to 3/4 of the basin along column and row 55: off the edges of blocks of 2 to 32 cells.
    const double wall_m = (55.5 - n / 2.0) * 0.125;
    scene.obstacles.emplace_back(
        core::Breakwater{.x_m = wall_m, .length_m = 0.0625 * n, .width_m = 0.11, .heading_deg = 90});
    scene.obstacles.emplace_back(core::Breakwater{.z_m = wall_m, .length_m = 0.0625 * n, .width_m = 0.11});
    EXPECT_LE(largestDifference(scene, false), 2e-5) << n;
  }
}

TEST_F(DispersedSlopeOnDevice, AgreesWithTheReferenceAfterTheDepthChanged) {
  for (const double depth_m : {0.1, 1.2, 50.0})
    for (const double first_depth_m : {0.1, 1.2, 50.0}) {
      if (depth_m == first_depth_m) continue;
      EXPECT_LE(largestDifference(sea(96, depth_m), false, first_depth_m), 2e-5) << first_depth_m << " to " << depth_m;
    }
  core::Scene shore = sea(96, 5.0);
  shore.beaches.push_back({.side = core::Side::kPlusX, .width_m = 4.0, .shore_depth_m = 0.05});
  EXPECT_LE(largestDifference(shore, false, 0.5), 2e-5) << "cells at the shore are dry where the water is deep";
}

TEST_F(DispersedSlopeOnDevice, ALevelSurfaceStaysStillToTheUnit) {
  core::Scene scene = sea(96, 1.2);
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.obstacles.emplace_back(core::Rock{.x_m = 2.1, .z_m = -1.3, .radius_m = 0.9});
  WaterSim& sim = make(scene);
  const StateCopy before = sim.copyState();
  for (int k = 0; k < 200; ++k) sim.step();
  EXPECT_TRUE(sim.copyState() == before);
}

/// Sets the surface, without flow.
void setSurface(WaterSim& sim, const std::vector<double>& elevation_m) {
  StateCopy state = sim.copyState();
  state.elevation_m = elevation_m;
  std::ranges::fill(state.flow_m2ps, 0.0F);
  sim.setState(state);
}

TEST_F(DispersedSlopeOnDevice, StandingWavesOscillateAtAirysFrequency) {
  struct Case {
    double depth_m;
    int periods;  ///< in 64 cells of 0.125 m; kd up to 10
  };
  for (const Case& each : {Case{0.25, 4}, Case{0.9, 2}, Case{0.9, 8}, Case{2.0, 2}, Case{2.0, 6}}) {
    core::Scene scene = sea(64, each.depth_m);
    scene.wave->damping_per_s = 0.0;
    WaterSim& sim = make(scene);
    const double dt_s = sim.derived().wave->dt_s;
    const auto mode = [&](std::size_t i) {
      return std::cos(2 * std::numbers::pi * each.periods * static_cast<double>(i % 64) / 64);
    };
    std::vector<double> eta_m(64 * 64);
    for (std::size_t i = 0; i < eta_m.size(); ++i) eta_m[i] = 0.01 * mode(i);
    setSurface(sim, eta_m);
    // For a mode, eta(t + dt) + eta(t - dt) = 2 cos(omega dt) eta(t): least squares over the run.
    std::vector<double> amplitude;
    for (std::uint32_t k = 0; k < 120; ++k) {
      const std::vector<double> now_m = sim.copyState().elevation_m;
      double sum = 0.0;
      for (std::size_t i = 0; i < now_m.size(); ++i) sum += now_m[i] * mode(i);
      amplitude.push_back(sum);
      sim.step();
    }
    ASSERT_EQ(sim.derived().wave->substeps_count, 1u);
    double product = 0.0;
    double square = 0.0;
    for (std::size_t k = 1; k + 1 < amplitude.size(); ++k) {
      product += 0.5 * (amplitude[k + 1] + amplitude[k - 1]) * amplitude[k];
      square += amplitude[k] * amplitude[k];
    }
    const double omega = std::acos(product / square) / dt_s;
    const double k_pm = 2 * std::numbers::pi * each.periods / scene.wave->side_m;
    EXPECT_NEAR(omega / std::sqrt(scene.gravity_mps2 * k_pm * std::tanh(k_pm * each.depth_m)), 1.0, 0.01)
        << each.depth_m << " m, " << each.periods;
  }
}

TEST_F(DispersedSlopeOnDevice, RoughWaterKeepsItsEnergyOverSlopesAndBetweenRocksAndWalls) {
  core::Scene scene = sea(64, 1.2);
  scene.wave->damping_per_s = 0.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 4.0, .shore_depth_m = 0.2});
  scene.obstacles.emplace_back(core::Rock{.x_m = 2.1, .z_m = -1.3, .radius_m = 0.6});
  scene.obstacles.emplace_back(
      core::Breakwater{.x_m = -1.0, .z_m = 1.0, .length_m = 3.0, .width_m = 0.2, .heading_deg = 40});
  WaterSim& sim = make(scene);
  const WaveLayout layout = *sim.derived().wave;
  const Basin basin = layOutBasin(scene, layout);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> level_m(-0.02, 0.02);
  std::vector<double> eta_m(basin.depth_m.size());
  for (std::size_t i = 0; i < eta_m.size(); ++i) eta_m[i] = basin.depth_m[i] > 0 ? level_m(random) : 0.0;
  setSurface(sim, eta_m);
  // The leapfrog conserves |eta' - eta|^2/dt^2 + <eta', S eta>, with S from the reference.
  const DispersionReference reference(layOutDispersion(layout, basin));
  const DispersionLevel& grid = reference.dispersion().levels.front();
  const auto energy = [&](const std::vector<double>& before_m, const std::vector<double>& now_m) {
    const auto faces = reference.apply(before_m);
    double sum = 0.0;
    for (int z = 0; z < 64; ++z) {
      for (int x = 0; x < 64; ++x) {
        const std::size_t i = grid.index(x, z);
        const double pull = faces[grid.index(x - 1, z)][0] - faces[i][0] + faces[grid.index(x, z - 1)][1] - faces[i][1];
        sum += std::pow((now_m[i] - before_m[i]) / layout.dt_s, 2) +
               scene.gravity_mps2 / std::pow(layout.cell_m, 2) * now_m[i] * pull;
      }
    }
    return sum;
  };
  const auto measured = [&] {
    const std::vector<double> before_m = sim.copyState().elevation_m;
    sim.step();
    return energy(before_m, sim.copyState().elevation_m);
  };
  const double at_start = measured();
  for (int k = 0; k < 3000; ++k) sim.step();
  EXPECT_NEAR(measured() / at_start, 1.0, 1e-4);
}

}  // namespace
}  // namespace spindrift::sim
