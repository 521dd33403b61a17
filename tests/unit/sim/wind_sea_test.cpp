// The wind sea that comes in at absorbing sides: the pass that computes it, and what it does to the water.
#include "wind_sea.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <shared/bindings.h>
#include <shared/fixed_point.h>

#include <spindrift/sim_setup/basin.h>

#include "shader_defines.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

core::Scene openSea(std::uint32_t n = 64) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = n;
  scene.wave->side_m = 20.0;
  scene.wave->depth_m = 2.0;
  scene.wave->damping_per_s = 0.0;
  scene.wave->sponge_width_m = 3.0;
  scene.wave->dispersion = core::Dispersion::kAiry;
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.storm->drops_per_m2_s = 0.0;
  scene.storm->wave_height_m = 0.4;
  return scene;
}

class WindSeaOnDevice : public OnDevice {
 protected:
  /// Root mean square elevations over `ticks`, each over the cells that one of `selections` takes by their position.
  using Selection = std::function<bool(double x_m, double z_m)>;
  std::vector<double> roughness(WaterSim& sim, int ticks, const std::vector<Selection>& selections) {
    const WaveLayout& layout = *sim.derived().wave;
    const std::uint32_t n = layout.count_x;
    std::vector<double> sums(selections.size());
    std::vector<double> counts(selections.size());
    for (int k = 0; k < ticks; ++k) {
      sim.step();
      if (k % 10 != 0) continue;
      const auto eta_m = sim.copyState().elevation_m;
      for (std::uint32_t i = 0; i < n * n; ++i) {
        const double x_m = (i % n + 0.5) * layout.cell_m - layout.length_m / 2;
        const double z_m = (i / n + 0.5) * layout.cell_m - layout.length_m / 2;
        for (std::size_t s = 0; s < selections.size(); ++s) {
          if (!selections[s](x_m, z_m)) continue;
          sums[s] += eta_m[i] * eta_m[i];
          ++counts[s];
        }
      }
    }
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s] = std::sqrt(sums[s] / counts[s]);
    return sums;
  }
};

TEST_F(WindSeaOnDevice, AgreesWithTheSumOfItsWavesInDoublePrecision) {
  core::Scene scene = openSea(96);
  scene.wave->damping_per_s = 0.4;
  const Derived derived = *derive(scene);
  const WaveLayout& layout = *derived.wave;
  const SeaState sea = seaState(scene, layout);
  ASSERT_FALSE(sea.waves.empty());
  Creation create(*ctx_, shaderDefines(scene));
  WindSea incoming(create, scene, layout);
  ASSERT_FALSE(create.error()) << create.error()->message;
  auto uniforms = gpu::Buffer::create(*ctx_, "uniforms", sizeof(shared::SimUniforms), gpu::BufferUse::kUpdatable);
  uniforms->uploadValue(derived.uniforms);
  uniforms->bindUniform(SIM_UNIFORMS);
  const Basin basin = layOutBasin(scene, layout);
  auto conductance = gpu::TexelBuffer::create(*ctx_, "basin", basin.conductance_m.size(), gpu::TexelFormat::kRGBA32F);
  auto bed = gpu::TexelBuffer::create(*ctx_, "bed", basin.bed.size(), gpu::TexelFormat::kRGBA32F);
  conductance->upload(basin.conductance_m);
  bed->upload(basin.bed);
  conductance->bindTexel(BASIN);
  bed->bindTexel(BED);
  incoming.fadeTo(sea);
  const int n = static_cast<int>(layout.count_x);
  const double dt_s = layout.dt_s;
  const std::size_t values = static_cast<std::size_t>(n) * n * 4;
  const auto steps = static_cast<int>(std::ceil(10.0 / dt_s));
  const gpu::TexelBuffer* incident = nullptr;
  for (int k = 0; k < steps; ++k) incident = incoming.advance(k * dt_s, dt_s);
  ASSERT_NE(incident, nullptr);
  const auto got = incident->downloadVector<float>(values);
  const double now_s = (steps - 1) * dt_s;
  double worst = 0.0;
  double square = 0.0;
  int count = 0;
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const std::size_t i = static_cast<std::size_t>(x) + static_cast<std::size_t>(n) * z;
      if (basin.bed[i][1] <= 0.0F || x == 0 || z == 0 || x == n - 1 || z == n - 1) continue;
      // Each block was computed for some time within the last steps: the nearest one must fit.
      const double x_m = (x + 0.5) * layout.cell_m - 10.0;
      const double z_m = (z + 0.5) * layout.cell_m - 10.0;
      double nearest = 1e9;
      double level_m = 0.0;
      for (int shift = -16; shift <= 16; ++shift) {
        const double t_s = now_s + 0.5 * shift * dt_s;
        double eta_m = 0.0;
        for (const PlaneWave& wave : sea.waves) {
          const double k = std::hypot(wave.kx_radpm, wave.kz_radpm);
          const double way_m = (wave.kx_radpm * x_m + wave.kz_radpm * z_m) / k +
                               10.0 * (std::abs(wave.kx_radpm) + std::abs(wave.kz_radpm)) / k;
          eta_m += wave.amplitude_m * std::exp(-wave.decay_pm * way_m) *
                   std::cos(wave.kx_radpm * x_m + wave.kz_radpm * z_m - wave.omega_radps * t_s + wave.phase_rad);
        }
        if (shift == 0) level_m = eta_m;
        nearest = std::min(nearest, std::abs((got[4 * i] + got[4 * i + 3]) * ELEVATION_UNIT_M - eta_m));
      }
      worst = std::max(worst, nearest);
      square += level_m * level_m;
      ++count;
    }
  }
  ASSERT_GT(count, 0);
  EXPECT_LE(worst, 0.05 * std::sqrt(square / count));
  for (std::size_t i = 0; i < basin.bed.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (basin.conductance_m[i][axis] > 0) continue;
      EXPECT_EQ(got[4 * i + 1 + axis], 0.0F) << "nothing passes a closed face";
    }
  }
}

TEST_F(WindSeaOnDevice, CalmWaterStaysStillToTheUnit) {
  core::Scene scene = openSea();
  scene.storm->level_ratio = 0.0;
  WaterSim& sim = make(scene);
  const StateCopy before = sim.copyState();
  for (int k = 0; k < 120; ++k) sim.step();
  EXPECT_TRUE(sim.copyState() == before);
}

TEST_F(WindSeaOnDevice, WindFromAWallRaisesNoWaves) {
  core::Scene scene = openSea();
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave->boundary_plus_x = core::WaveBoundary::kAbsorb;
  scene.storm->wind_direction_deg = 0.0;
  WaterSim& sim = make(scene);
  const StateCopy before = sim.copyState();
  for (int k = 0; k < 120; ++k) sim.step();
  EXPECT_TRUE(sim.copyState() == before) << "the waves would come from the closed side";
}

TEST_F(WindSeaOnDevice, FillsOpenWaterAndLeavesIt) {
  core::Scene scene = openSea();
  WaterSim& sim = make(scene);
  const double target_m = seaState(scene, *sim.derived().wave).significant_height_m;
  ASSERT_GT(target_m, 0.2);
  const auto middle = [](double x_m, double z_m) { return std::abs(x_m) < 5 && std::abs(z_m) < 5; };
  for (int k = 0; k < 25 * 60; ++k) sim.step();
  EXPECT_NEAR(4 * roughness(sim, 15 * 60, {middle})[0], target_m, 0.2 * target_m);
  EXPECT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
  scene.storm->level_ratio = 0.0;
  ASSERT_TRUE(sim.setScene(scene));
  for (int k = 0; k < 40 * 60; ++k) sim.step();
  EXPECT_LT(sim.health().max_elevation_m, 0.02 * target_m) << "40 s after the wind";
  EXPECT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(WindSeaOnDevice, PassesTheEdgeOfTheWaterWithoutPilingUp) {
  core::Scene scene = openSea();
  WaterSim& sim = make(scene);
  const double target_m = seaState(scene, *sim.derived().wave).significant_height_m;
  const double cell_m = sim.derived().wave->cell_m;
  for (int k = 0; k < 10 * 60; ++k) sim.step();
  std::vector<Selection> rings;
  for (const double inside_cells : {0.0, 1.0, 2.0}) {
    rings.push_back([=](double x_m, double z_m) {
      return std::abs(std::max(std::abs(x_m), std::abs(z_m)) - (10.0 - (inside_cells + 0.5) * cell_m)) < 0.1 * cell_m;
    });
  }
  for (const double edge_m : roughness(sim, 15 * 60, rings)) EXPECT_NEAR(4 * edge_m, target_m, 0.2 * target_m);
}

TEST_F(WindSeaOnDevice, LeavesAShadowBehindAWall) {
  // The same wall, sea and cells in water of two sizes: in the small one the layer that lets the sea out is close
  // behind the wall. If the layer filled the shadow, the shadow there would be weaker.
  double share[2] = {};
  for (const bool large : {false, true}) {
    core::Scene scene = openSea(large ? 96 : 64);
    scene.wave->side_m = large ? 30.0 : 20.0;
    scene.storm->wind_direction_deg = 0.0;
    scene.storm->fetch_m = 1000.0;
    scene.obstacles = {core::Breakwater{0.0, 0.0, 10.0, 0.7, 90.0, 0.5}};
    WaterSim& sim = make(scene);
    for (int k = 0; k < 20 * 60; ++k) sim.step();
    const auto shadow = [](double x_m, double z_m) { return x_m > 2.0 && x_m < 7.0 && std::abs(z_m) < 2; };
    const auto wall = [](double x_m, double z_m) { return x_m > -4.0 && x_m < -1.0 && std::abs(z_m) < 2; };
    const std::vector<double> both_m = roughness(sim, 900, {shadow, wall});
    share[large] = both_m[0] / both_m[1];
    RecordProperty(large ? "share_large" : "share_small", std::to_string(share[large]));
  }
  EXPECT_GT(share[true], 0.02) << "waves bend around the ends";
  EXPECT_LT(share[true], 0.4);
  EXPECT_NEAR(share[false], share[true], 0.1 * share[true]);
}

TEST_F(WindSeaOnDevice, RepeatsWithChangesOnTheWay) {
  const auto run = [&] {
    core::Scene scene = openSea();
    WaterSim& sim = make(scene);
    std::vector<std::uint64_t> hashes;
    for (int k = 0; k < 400; ++k) {
      if (k == 50 || k == 60 || k == 300) {
        scene.storm->level_ratio = k == 60 ? 0.3 : 0.8;
        scene.storm->wind_direction_deg = k;
        EXPECT_TRUE(sim.setScene(scene));
      }
      if (k == 350) sim.reset();
      sim.step();
      if (k % 50 == 49) hashes.push_back(sim.stateHash());
    }
    return hashes;
  };
  const auto first = run();
  EXPECT_EQ(run(), first);
  EXPECT_NE(first[2], first[3]) << "nothing moved";
}

TEST_F(WindSeaOnDevice, ChangesWithoutAJump) {
  core::Scene scene = openSea();
  WaterSim& sim = make(scene);
  std::vector<double> before;
  double usual_m = 0.0;
  double after_change_m = 0.0;
  for (int k = 0; k < 1500; ++k) {
    if (k == 1200) {
      scene.storm->level_ratio = 0.2;
      scene.storm->wind_direction_deg = 90.0;
      ASSERT_TRUE(sim.setScene(scene));
    }
    sim.step();
    const auto eta_m = sim.copyState().elevation_m;
    double change_m = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) change_m = std::max(change_m, std::abs(eta_m[i] - before[i]));
    (k < 1200 ? usual_m : after_change_m) = std::max(k < 1200 ? usual_m : after_change_m, change_m);
    before = eta_m;
  }
  EXPECT_GT(usual_m, 0.0);
  EXPECT_LE(after_change_m, 1.3 * usual_m) << "largest change of an elevation per tick";
}

TEST_F(WindSeaOnDevice, DoesNotGrowInNonlinearWaterManyCellsDeep) {
  core::Scene scene = openSea(32);
  scene.tick_rate_hz = 10.0;
  scene.wave->side_m = 3.2;
  scene.wave->sponge_width_m = 0.5;
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.storm->wave_height_m = 10.0;
  scene.storm->wind_speed_mps = 60.0;
  for (const double depth_m : {6.0, 50.0}) {
    scene.wave->depth_m = depth_m;
    WaterSim& sim = make(scene);
    const double height_m = seaState(scene, *sim.derived().wave).significant_height_m;
    for (int k = 0; k < 150; ++k) sim.step();
    EXPECT_LE(sim.health().max_elevation_m, 3.0 * height_m) << depth_m << " m deep";
    EXPECT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
    EXPECT_EQ(sim.recoveredCount(), 0u);
  }
}

TEST_F(WindSeaOnDevice, ContinuesUnderOtherGravityWithTheSameLevelsAndWavesThatFitIt) {
  core::Scene scene = openSea();
  const WaveLayout layout = *derive(scene)->wave;
  const SeaState before = seaState(scene, layout);
  for (const double gravity_mps2 : {50.0, 2.0, 0.01}) {
    scene.gravity_mps2 = gravity_mps2;
    const SeaState after = continued(before, scene, 12.5);
    ASSERT_EQ(after.waves.size(), before.waves.size());
    for (std::size_t k = 0; k < after.waves.size(); ++k) {
      const PlaneWave& a = before.waves[k];
      const PlaneWave& b = after.waves[k];
      EXPECT_EQ(std::tuple(b.kx_radpm, b.kz_radpm, b.amplitude_m), std::tuple(a.kx_radpm, a.kz_radpm, a.amplitude_m));
      EXPECT_NEAR(std::sin(b.phase_rad - b.omega_radps * 12.5), std::sin(a.phase_rad - a.omega_radps * 12.5), 1e-9);
      EXPECT_NEAR(b.omega_radps, a.omega_radps * std::sqrt(gravity_mps2 / 9.81), 1e-9);
    }
  }
  scene.gravity_mps2 = 0.0;
  EXPECT_TRUE(continued(before, scene, 12.5).waves.empty());
  scene.gravity_mps2 = 9.81;
  scene.wave->depth_m = 0.05;
  EXPECT_NEAR(continued(before, scene, 12.5).significant_height_m, 0.025, 1e-9) << "higher waves break";
}

TEST_F(WindSeaOnDevice, RaisesNoWaterWhenGravityFallsToNothingAndComesBack) {
  for (const bool nonlinear : {false, true}) {
    core::Scene scene = openSea();
    if (nonlinear) scene.wave->bulk = core::Bulk::kNonlinear;
    WaterSim& sim = make(scene);
    double usual_m = 0.0;
    for (int k = 0; k < 5 * 60; ++k) {
      sim.step();
      usual_m = std::max(usual_m, sim.health().max_elevation_m);
    }
    for (const double gravity_mps2 : {0.01, 9.81, 0.0, 1e-4, 50.0, 9.81}) {
      scene.gravity_mps2 = gravity_mps2;
      ASSERT_TRUE(sim.setScene(scene));
      for (int k = 0; k < 90; ++k) {
        sim.step();
        ASSERT_LE(sim.health().max_elevation_m, 1.5 * usual_m) << "under " << gravity_mps2;
        ASSERT_EQ(sim.health().surface_units + sim.health().outflow_units, 0);
      }
      EXPECT_EQ(sim.recoveredCount(), 0u);
    }
  }
}

TEST_F(WindSeaOnDevice, StaysBoundedForEveryWindAndWater) {
  struct Case {
    std::uint32_t n;
    double side_m, depth_m, sponge_m, wind_mps, fetch_m;
  };
  for (const Case& each : {Case{32, 1000.0, 100.0, 200.0, 60.0, 1e6}, Case{32, 1000.0, 0.5, 100.0, 60.0, 10.0},
                           Case{32, 20.0, 0.05, 3.0, 60.0, 1e6}, Case{32, 1.0, 1.0, 0.1, 60.0, 1e6},
                           Case{64, 20.0, 5.0, 0.2, 60.0, 1e5}}) {
    core::Scene scene = openSea(each.n);
    scene.wave->side_m = each.side_m;
    scene.wave->depth_m = each.depth_m;
    scene.wave->sponge_width_m = each.sponge_m;
    scene.wave->steepening_ratio = 0.5;
    scene.storm->wind_speed_mps = each.wind_mps;
    scene.storm->fetch_m = each.fetch_m;
    scene.storm->wave_height_m = 10.0;
    WaterSim& sim = make(scene);
    for (int k = 0; k < 600; ++k) {
      sim.step();
      ASSERT_EQ(sim.health().nonfinite_count, 0u);
      ASSERT_EQ(sim.health().surface_units + sim.health().outflow_units, 0) << each.side_m << " m, " << each.depth_m;
    }
    EXPECT_EQ(sim.recoveredCount(), 0u) << each.side_m << " m, " << each.depth_m;
    EXPECT_LE(sim.health().max_elevation_m, std::min(10.0, 2 * each.depth_m)) << each.side_m << " m, " << each.depth_m;
  }
}

}  // namespace
}  // namespace spindrift::sim
