#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim/derive.h>

#include "lattice.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

TEST(Derive, KeepsEveryStepRule) {
  for (const double c0 : {5.0, 18.0, 60.0, 200.0}) {
    core::Scene scene = smallScene();
    scene.particles->sound_speed_mps = c0;
    const auto d = derive(scene);
    ASSERT_TRUE(d) << d.error().message;
    for (const StepRule& rule : d->rules) {
      const double dt_s = rule.name.starts_with("wave") ? d->wave->dt_s : d->dt_s;
      EXPECT_LE(dt_s, rule.max_dt_s * (1 + 1e-9)) << rule.name;
    }
    EXPECT_LE(d->dt_s, 0.4 * d->particles->support_radius_m / (c0 + scene.particles->max_speed_mps) * (1 + 1e-9));
    EXPECT_NEAR(d->dt_s * d->substeps_count, d->tick_s, 1e-12);
    EXPECT_NEAR(d->wave->dt_s * d->wave->substeps_count, d->tick_s, 1e-12);
  }
}

TEST(Derive, TilesAPeriodicPatchWithWholeCells) {
  for (const std::uint32_t count : {200u, 777u, 1000u, 8192u, 16384u}) {
    for (const double ratio : {1.7, 2.0, 2.3}) {
      core::Scene scene = smallScene(count);
      scene.particles->support_ratio = ratio;
      const auto d = derive(scene);
      ASSERT_TRUE(d) << d.error().message;
      const ParticleLayout& p = *d->particles;
      EXPECT_NEAR(p.cells[0] * p.support_radius_m, p.max_m[0] - p.min_m[0], 1e-9);
      EXPECT_GE(p.support_radius_m, ratio * p.spacing_m - 1e-9) << "never fewer neighbours than asked for";
      EXPECT_EQ(p.count, p.columns_x_count * p.columns_z_count * p.layers_count);
      EXPECT_NEAR(p.count, count, 0.25 * count);
    }
  }
}

TEST(Derive, CalibratesMassSoThatTheLatticeHasRestDensity) {
  const double s = 0.3;
  const double H = 0.6;
  for (const auto set : {core::KernelSet::kMuller, core::KernelSet::kCubicSpline, core::KernelSet::kWendlandC2}) {
    const double m = calibratedMass(set, s, H, 1000.0);
    double rho = 0.0;
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z) {
          const double r2 = s * s * (x * x + y * y + z * z);
          rho += m * densityKernel(set, std::sqrt(r2), H);
        }
    EXPECT_NEAR(rho, 1000.0, 1e-6);
    EXPECT_NEAR(m, 1000.0 * s * s * s, 0.05 * m) << "calibration corrects rho0 s^3, it does not replace it";
  }
}

TEST(Derive, RestingLayersLieAboveEachOtherAndCloserThanTheLattice) {
  const auto d = derive(smallScene());
  ASSERT_TRUE(d);
  const ParticleLayout& p = *d->particles;
  ASSERT_EQ(p.layer_heights_m.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(p.layer_heights_m[k], k == 0 ? 0.0 : p.layer_heights_m[k - 1]);
  EXPECT_LT(p.layer_heights_m.back(), 2.5 * p.spacing_m) << "the weight of the water presses the layers together";
  EXPECT_GT(p.layer_heights_m.back(), 1.5 * p.spacing_m);
}

TEST(Derive, RefusesAFixedStepThatBreaksARuleAndNamesFieldValueAndBound) {
  core::Scene scene = smallScene();
  scene.fixed_substeps_count = 1;
  scene.particles->sound_speed_mps = 100.0;
  const auto d = derive(scene);
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_THAT(d.error().message, HasSubstr("fixed_substeps_count"));
  EXPECT_THAT(d.error().message, HasSubstr("16.67 ms"));
  EXPECT_THAT(d.error().message, HasSubstr("at least"));
  scene.allow_unstable = true;
  EXPECT_TRUE(derive(scene));
}

TEST(Derive, RefusesCouplingWithoutItsParts) {
  core::Scene scene = smallScene();
  scene.wave.reset();
  EXPECT_FALSE(derive(scene));
  scene = smallScene();
  scene.particles.reset();
  EXPECT_FALSE(derive(scene));
}

TEST(Derive, RefusesAPeriodicPatchOfFewerThanThreeCells) {
  core::Scene scene = smallScene(12);
  const auto d = derive(scene);
  ASSERT_FALSE(d);
  EXPECT_THAT(d.error().message, HasSubstr("particles.count"));
}

TEST(Derive, RefusesAPatchThatLeavesTheWater) {
  core::Scene scene = smallScene();
  scene.particles->patch_scale = 0.5;
  scene.particles->patch_shift_x_m = 3.0;
  const auto d = derive(scene);
  ASSERT_FALSE(d);
  EXPECT_THAT(d.error().message, HasSubstr("patch_shift_x_m"));
}

TEST(Derive, GivesTheNinePointStencilALargerStep) {
  core::Scene scene = smallScene();
  scene.particles.reset();
  scene.coupling.reset();
  scene.foam.reset();
  scene.wave->depth_m = 20.0;
  const auto five = derive(scene);
  scene.wave->stencil = core::Stencil::kNinePoint;
  const auto nine = derive(scene);
  ASSERT_TRUE(five && nine);
  EXPECT_LE(five->wave->courant, 0.7072);
  EXPECT_LE(nine->wave->courant, 0.8661);
  EXPECT_LE(nine->wave->substeps_count, five->wave->substeps_count);
}

}  // namespace
}  // namespace spindrift::sim
