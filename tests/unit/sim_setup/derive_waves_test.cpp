// What follows from a scene for its waves: dispersion, ripples, steps.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/derive.h>

#include "small_scene.h"

namespace spindrift::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DeriveWaves, RefusesDispersionWhereItsGridsDoNotFit) {
  core::Scene scene = smallScene();
  scene.wave->dispersion = core::Dispersion::kAiry;
  ASSERT_TRUE(derive(scene));
  scene.wave->stencil = core::Stencil::kNinePoint;
  EXPECT_THAT(derive(scene).error().message, HasSubstr("STENCIL_FIVE_POINT"));
  scene.wave->stencil = core::Stencil::kFivePoint;
  scene.wave->resolution_count = 528;  // 33 * 16
  EXPECT_THAT(derive(scene).error().message, HasSubstr("use 512 or 544"));
  scene.wave->resolution_count = 544;
  EXPECT_TRUE(derive(scene));
}

/// A square of half a metre with ripples.
core::Scene rippleScene() {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->side_m = 0.5;
  scene.wave->resolution_count = 192;
  scene.wave->depth_m = 0.05;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.wave->surface_tension_npm = 0.0728;
  return scene;
}

TEST(DeriveWaves, GivesRipplesShorterSteps) {
  core::Scene scene = rippleScene();
  const auto ripples = derive(scene);
  scene.wave->surface_tension_npm = 0.0;
  const auto plain = derive(scene);
  ASSERT_TRUE(ripples) << ripples.error().message;
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(plain->uniforms.capillary_ratio, 0.0f);
  // l^2 / dx^2 = 1.09, 6 % more for the curvature that cells of 2.6 mm do not see.
  EXPECT_NEAR(ripples->uniforms.capillary_ratio, 1.16, 0.01);
  EXPECT_NEAR(plain->rules.back().max_dt_s / ripples->rules.back().max_dt_s, std::sqrt(1 + 8 * 1.16), 0.02);
  EXPECT_GT(ripples->device_bytes, plain->device_bytes);
}

TEST(DeriveWaves, RefusesRipplesThatItCannotCompute) {
  const auto messageOf = [](const auto& change) {
    core::Scene scene = rippleScene();
    change(scene);
    const auto d = derive(scene);
    return d ? "accepted" : d.error().message;
  };
  ASSERT_EQ(messageOf([](core::Scene&) {}), "accepted");
  EXPECT_THAT(messageOf([](core::Scene& s) { s.wave->dispersion = core::Dispersion::kNone; }),
              HasSubstr("use dispersion: DISPERSION_AIRY"));
  EXPECT_THAT(messageOf([](core::Scene& s) { s.wave->bulk = core::Bulk::kNonlinear; }), HasSubstr("BULK_LINEAR"));
  EXPECT_THAT(messageOf([](core::Scene& s) { s.wave->resolution_count = 128; }),
              AllOf(HasSubstr("cells of at most 2.85 mm"), HasSubstr("resolution_count of 176 or more")));
  EXPECT_THAT(messageOf([](core::Scene& s) { s.gravity_mps2 = 0.0; }), HasSubstr("use at least 0.0115"));
  EXPECT_THAT(messageOf([](core::Scene& s) { s.wave_makers.emplace_back(); }), HasSubstr("wave_makers"));
}

core::Scene smallWave() {
  core::Scene scene = smallScene();
  scene.particles.reset();
  scene.coupling.reset();
  scene.foam.reset();
  return scene;
}

TEST(DeriveWaves, GivesDispersedWavesLongerSteps) {
  core::Scene scene = smallWave();
  scene.wave->resolution_count = 256;
  scene.wave->side_m = 25.6;
  scene.wave->depth_m = 4.0;
  const auto plain = derive(scene);
  scene.wave->dispersion = core::Dispersion::kAiry;
  const auto dispersed = derive(scene);
  ASSERT_TRUE(plain) << plain.error().message;
  ASSERT_TRUE(dispersed) << dispersed.error().message;
  EXPECT_GE(plain->wave->substeps_count, 2 * dispersed->wave->substeps_count);
}

TEST(DeriveWaves, GivesTheNinePointStencilALargerStep) {
  core::Scene scene = smallWave();
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
