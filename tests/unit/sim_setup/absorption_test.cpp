// The layers of absorbing sides: which kind a scene has, and their loss rates.
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/scene_parts.h>

#include "small_scene.h"

namespace spindrift::sim {
namespace {

using testing::HasSubstr;

TEST(Absorption, DefaultFollowsTheStencil) {
  core::Scene scene = smallScene();
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave->dispersion = core::Dispersion::kAiry;
  EXPECT_FALSE(hasMatchedLayer(scene)) << "no side absorbs";
  scene.wave->boundary_plus_x = core::WaveBoundary::kAbsorb;
  EXPECT_TRUE(hasMatchedLayer(scene));
  const auto matched = derive(scene);
  scene.wave->absorption = core::Absorption::kSponge;
  EXPECT_FALSE(hasMatchedLayer(scene));
  const auto sponge = derive(scene);
  ASSERT_TRUE(matched && sponge);
  const std::uint64_t cells = std::uint64_t{scene.wave->resolution_count} * scene.wave->resolution_count;
  EXPECT_EQ(matched->device_bytes, sponge->device_bytes + 3 * 4 * cells);
  scene.wave->dispersion = core::Dispersion::kNone;
  scene.wave->absorption.reset();
  EXPECT_TRUE(hasMatchedLayer(scene)) << "without dispersion, too";
  scene.wave->stencil = core::Stencil::kNinePoint;
  EXPECT_FALSE(hasMatchedLayer(scene));
  EXPECT_TRUE(derive(scene));
  scene.wave->absorption = core::Absorption::kPml;
  EXPECT_THAT(derive(scene).error().message, HasSubstr("wave.absorption: ABSORPTION_PML needs STENCIL_FIVE_POINT"));
}

TEST(Absorption, HasMatchedLayersAlongAbsorbingSidesOnly) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = 32;
  scene.wave->side_m = 16.0;
  scene.wave->sponge_width_m = 4.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave->boundary_plus_x = scene.wave->boundary_minus_z = core::WaveBoundary::kAbsorb;
  scene.wave->absorption = core::Absorption::kPml;
  const auto ratesOf = [&](std::size_t x, std::size_t z) {
    const Basin basin = layOutBasin(scene, *derive(scene)->wave);
    return std::array{basin.bed[x + 32 * z][1], basin.bed[x + 32 * z][3]};
  };
  const auto none = std::array{0.0F, 0.0F};
  EXPECT_EQ(ratesOf(0, 16), none) << "a wall";
  EXPECT_EQ(ratesOf(16, 31), none) << "a wall";
  EXPECT_EQ(ratesOf(23, 16), none) << "outside the layer";
  EXPECT_GT(ratesOf(24, 16)[0], 0.0F);
  EXPECT_LT(ratesOf(24, 16)[0], ratesOf(31, 16)[0]);
  EXPECT_LT(ratesOf(31, 16)[1], 0.01F * ratesOf(31, 16)[0]) << "hardly any along the side";
  EXPECT_EQ(ratesOf(31, 16)[0], ratesOf(16, 0)[1]);
  EXPECT_EQ(ratesOf(31, 0)[0], ratesOf(31, 0)[1]) << "a corner has both";
  const float flat_per_s = ratesOf(31, 16)[1];
  scene.obstacles = {core::Rock{0.0, 0.0, 0.7, 0.5}};
  EXPECT_GT(ratesOf(31, 16)[1], 5 * flat_per_s) << "more along the side over an uneven bed";
}

}  // namespace
}  // namespace spindrift::sim
