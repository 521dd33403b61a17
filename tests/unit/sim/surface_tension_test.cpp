// Surface tension on the device: what does not move, what it keeps, and that scenes without it have none of it.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class SurfaceTension : public OnDevice {
 protected:
  static core::Scene tray() {
    core::Scene scene;
    scene.name = "tray";
    scene.wave.emplace();
    scene.wave->side_m = 0.2;
    scene.wave->resolution_count = 80;
    scene.wave->depth_m = 0.05;
    scene.wave->damping_per_s = 0.0;
    scene.wave->dispersion = core::Dispersion::kAiry;
    scene.wave->surface_tension_npm = 0.0728;
    setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
    return scene;
  }

  /// 1,000 particles, 1 mm apart, in the middle of a box.
  static core::Scene droplet(core::PressureSolver solver) {
    core::Scene scene;
    scene.name = "droplet";
    scene.gravity_mps2 = 0.0;
    scene.tick_rate_hz = 250.0;
    scene.particles.emplace();
    core::ParticleScene& p = *scene.particles;
    p.solver = solver;
    p.boundary_x = p.boundary_z = core::Boundary::kWall;
    p.count = 1000;
    p.layers_count = 10;
    p.box_side_m = 0.03;
    p.fill_x_ratio = p.fill_z_ratio = 1.0 / 3.0;
    p.headroom_m = 0.02;
    p.sound_speed_mps = 3.0;
    p.max_speed_mps = 0.5;
    p.viscosity_pas = 0.01;
    p.surface_tension_npm = 0.0728;
    return scene;
  }
};

TEST_F(SurfaceTension, LeavesLevelWaterLevelToTheUnit) {
  core::Scene scene = tray();
  scene.obstacles.emplace_back(core::Rock{.x_m = 0.03, .z_m = -0.02, .radius_m = 0.05});
  auto water = WaterSim::create(*ctx_, scene);
  ASSERT_TRUE(water) << water.error().message;
  const StateCopy before = (*water)->copyState();
  for (int k = 0; k < 10; ++k) (*water)->step();
  EXPECT_EQ((*water)->copyState(), before);
}

TEST_F(SurfaceTension, RipplesStayBoundedAndKeepTheirWater) {
  for (const auto sides : {core::WaveBoundary::kReflect, core::WaveBoundary::kAbsorb}) {
    core::Scene scene = tray();
    setBoundaries(*scene.wave, sides);
    scene.wave->sponge_width_m = 0.05;
    auto water = WaterSim::create(*ctx_, scene);
    ASSERT_TRUE(water) << water.error().message;
    StateCopy state = (*water)->copyState();
    // A chequerboard, the fastest wave of the grid, under a hump.
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
      const double x = static_cast<double>(i % 80) - 39.5, z = static_cast<double>(i / 80) - 39.5;
      state.elevation_m[i] = 1e-3 * std::exp(-(x * x + z * z) / 50) * ((i + i / 80) % 2 == 0 ? 1.0 : 0.5);
    }
    (*water)->setState(state);
    const auto sumOf = [](const StateCopy& s) {
      return std::accumulate(s.elevation_m.begin(), s.elevation_m.end(), 0.0);
    };
    const double volume = sumOf((*water)->copyState());
    double highest_m = 0.0;
    for (int k = 0; k < 120; ++k) {
      (*water)->step();
      if (k % 20 != 19) continue;
      const StateCopy now = (*water)->copyState();
      highest_m = std::max(std::abs(*std::ranges::max_element(now.elevation_m)),
                           std::abs(*std::ranges::min_element(now.elevation_m)));
      EXPECT_LT(highest_m, 1e-3);
      if (sides == core::WaveBoundary::kReflect) {
        EXPECT_EQ(sumOf(now), volume);
      }
    }
    // The chequerboard has an amplitude of 0.25 mm and does not travel; the hump has left.
    if (sides == core::WaveBoundary::kAbsorb) {
      EXPECT_LT(highest_m, 2.5e-4);
    }
  }
}

TEST_F(SurfaceTension, OfParticlesKeepsTheirMomentum) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    auto water = WaterSim::create(*ctx_, droplet(solver));
    ASSERT_TRUE(water) << water.error().message;
    StateCopy state = (*water)->copyState();
    for (std::size_t i = 0; i < state.position.size(); i += 4) {  // from the corner to the middle
      state.position[i] += 0.01f;
      state.position[i + 1] += 0.01f;
      state.position[i + 2] += 0.01f;
    }
    (*water)->setState(state);
    for (int k = 0; k < 10; ++k) (*water)->step();
    const StateCopy now = (*water)->copyState();
    double momentum[3] = {};
    double speed_mps = 0.0;
    for (std::size_t i = 0; i < now.velocity.size(); i += 4) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        momentum[axis] += now.velocity[i + axis] / 1000;
        speed_mps += std::abs(now.velocity[i + axis]) / 3000;
      }
    }
    EXPECT_GT(speed_mps, 3e-3) << "the cube becomes round";
    for (const double each : momentum) EXPECT_LT(std::abs(each), 1e-3 * speed_mps);
  }
}

}  // namespace
}  // namespace spindrift::sim
