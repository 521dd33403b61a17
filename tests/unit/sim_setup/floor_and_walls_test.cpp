// How floors and walls replace the water that is missing beyond them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/lattice.h>

#include "small_scene.h"

namespace spindrift::sim {
namespace {

TEST(FloorAndWalls, ReplaceTheDensityOfTheMissingLayers) {
  const double s = 0.1;
  for (const auto set : {core::KernelSet::kMuller, core::KernelSet::kCubicSpline, core::KernelSet::kWendlandC2}) {
    for (const double H : {0.17, 0.2, 0.24, 0.3}) {
      const double m = calibratedMass(set, s, H, 1000.0);
      const WallSupport wall = calibratedWall(set, s, H, 1000.0, m);
      double missing = 0.0;
      for (int x = 1; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
          for (int z = -3; z <= 3; ++z) missing += m * densityKernel(set, s * std::sqrt(x * x + y * y + z * z), H);
      EXPECT_NEAR(1000.0 * wall.share * std::pow(1 - s / 2 / wall.reach_m, 2), missing, 1e-6);
      EXPECT_GT(wall.reach_m, s / 2);
      EXPECT_LE(wall.reach_m, H);
    }
  }
}

TEST(FloorAndWalls, AFlatFloorContinuesAnEvenShearThroughZero) {
  // Its drag on the lowest layer of water with speed proportional to height balances the pull of the layers above.
  const double s = 0.1;
  for (const double H : {0.17, 0.2, 0.24, 0.3}) {
    const double m = calibratedMass(core::KernelSet::kMuller, s, H, 1000.0);
    const WallSupport wall = calibratedWall(core::KernelSet::kMuller, s, H, 1000.0, m);
    double pull = 0.0;
    for (int y = 1; y <= 3; ++y)
      for (int x = -3; x <= 3; ++x)
        for (int z = -3; z <= 3; ++z)
          pull += m / 1000.0 * y * s * viscosityNorm(H) * std::max(H - s * std::sqrt(x * x + y * y + z * z), 0.0);
    const double drag = calibratedFloorDrag(s, H, 1000.0, m, wall) * std::pow(1 - s / 2 / wall.reach_m, 2);
    EXPECT_NEAR(drag * s / 2, pull, 1e-9 * pull);
  }
}

TEST(FloorAndWalls, LowestLayerStaysInTheLattice) {
  core::Scene scene = smallScene();
  const auto gapRatio = [&] {
    const auto d = derive(scene);
    return d->uniforms.floor_gap_m / d->particles->spacing_m;
  };
  EXPECT_NEAR(gapRatio(), 0.1, 1e-6);
  scene.particles->solver = core::PressureSolver::kPositionBased;
  EXPECT_NEAR(gapRatio(), 0.45, 1e-6);
  scene.wave.reset();
  scene.coupling.reset();
  scene.foam.reset();
  EXPECT_NEAR(gapRatio(), 0.1, 1e-6) << "a flat floor supports the layer";
}

}  // namespace
}  // namespace spindrift::sim
