// What follows from a scene, value by value; waves: derive_waves_test.cpp.
#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/lattice.h>
#include <spindrift/sim_setup/particle_layout.h>

#include "small_scene.h"

namespace spindrift::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Derive, KeepsEveryStepRule) {
  for (const double c0 : {5.0, 18.0, 60.0, 200.0}) {
    core::Scene scene = smallScene();
    scene.particles->sound_speed_mps = c0;
    const auto d = derive(scene);
    ASSERT_TRUE(d) << d.error().message;
    EXPECT_FALSE(d->rules.empty());
    for (const StepRule& rule : d->rules) {
      const double dt_s = rule.name.starts_with("wave") ? d->wave->dt_s : d->dt_s;
      EXPECT_LE(dt_s, rule.max_dt_s * (1 + 1e-9)) << rule.name;
    }
    EXPECT_LE(d->dt_s, 0.7 * d->particles->support_radius_m / (c0 + scene.particles->max_speed_mps) * (1 + 1e-9));
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

TEST(Derive, RestingLayersLieCloserThanTheLattice) {
  const auto d = derive(smallScene());
  ASSERT_TRUE(d);
  const ParticleLayout& p = *d->particles;
  ASSERT_EQ(p.layer_heights_m.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(p.layer_heights_m[k], k == 0 ? 0.0 : p.layer_heights_m[k - 1]);
  EXPECT_LT(p.layer_heights_m.back(), 2.5 * p.spacing_m) << "the weight of the water presses the layers together";
  EXPECT_GT(p.layer_heights_m.back(), 1.5 * p.spacing_m);
}

TEST(Derive, LayersWithoutGravityLieAsInTheLattice) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    core::Scene scene = smallScene();
    scene.gravity_mps2 = 0.0;
    scene.particles->solver = solver;
    const ParticleLayout p = *layOutParticles(scene);
    for (std::size_t k = 0; k < p.layer_heights_m.size(); ++k)
      EXPECT_EQ(p.layer_heights_m[k], (static_cast<double>(k) + 0.5) * p.spacing_m);
  }
}

TEST(Derive, RefusesAFixedStepThatBreaksARule) {
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

TEST(Derive, RefusesAFixedWaveStepThatBreaksItsRule) {
  core::Scene scene = smallScene();
  scene.wave->depth_m = 40.0;
  const auto free = derive(scene);
  ASSERT_TRUE(free);
  ASSERT_GT(free->wave->substeps_count, 1u);
  scene.wave->fixed_substeps_count = free->wave->substeps_count - 1;
  const auto d = derive(scene);
  ASSERT_FALSE(d);
  EXPECT_THAT(d.error().message, HasSubstr("wave.fixed_substeps_count"));
  EXPECT_THAT(d.error().message, HasSubstr("at least " + std::to_string(free->wave->substeps_count)));
  scene.allow_unstable = true;
  const auto unstable = derive(scene);
  ASSERT_TRUE(unstable);
  EXPECT_EQ(unstable->wave->substeps_count, free->wave->substeps_count - 1);
  scene.wave->fixed_substeps_count = 2 * free->wave->substeps_count;
  const auto finer = derive(scene);
  ASSERT_TRUE(finer);
  EXPECT_NEAR(finer->wave->courant, 0.5 * free->wave->courant, 1e-12);
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

/// Particles alone between walls.
core::Scene boxScene(std::uint32_t count) {
  core::Scene scene = smallScene(count);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  return scene;
}

TEST(Derive, LaysOutOblongBoxesAndDams) {
  for (const std::uint32_t count : {100u, 777u, 5000u, 50'000u}) {
    core::Scene scene = boxScene(count);
    scene.particles->box_side_m = 8.0;
    scene.particles->box_width_m = 2.0;
    scene.particles->fill_x_ratio = 0.3;
    scene.particles->fill_z_ratio = 0.9;
    scene.particles->layers_count = 6;
    const auto d = derive(scene);
    ASSERT_TRUE(d) << d.error().message;
    const ParticleLayout& p = *d->particles;
    EXPECT_NEAR(p.max_m[0] - p.min_m[0], 8.0, 1e-12);
    EXPECT_NEAR(p.max_m[2] - p.min_m[2], 2.0, 1e-12);
    EXPECT_NEAR(p.max_m[0] + p.min_m[0], 0.0, 1e-12) << "centred on the origin";
    EXPECT_NEAR(p.pitch_x_m * p.columns_x_count, 0.3 * 8.0, 1e-9);
    EXPECT_NEAR(p.pitch_z_m * p.columns_z_count, 0.9 * 2.0, 1e-9);
    EXPECT_NEAR(p.pitch_x_m / p.pitch_z_m, 1.0, 0.5 / p.columns_z_count + 1e-9);
    EXPECT_EQ(p.count, p.columns_x_count * p.columns_z_count * p.layers_count);
    EXPECT_NEAR(p.spacing_m * p.spacing_m * p.spacing_m * p.count, p.volume_m3, 1e-9 * p.volume_m3);
  }
}

TEST(Derive, TilesOblongPeriodicBoxesOrSaysWhyNot) {
  core::Scene scene = boxScene(4000);
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kPeriodic;
  scene.particles->box_side_m = 8.0;
  scene.particles->box_width_m = 4.0;
  const auto d = derive(scene);
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_NEAR(d->particles->cells[0] * d->particles->support_radius_m, 8.0, 1e-9);
  EXPECT_NEAR(d->particles->cells[2] * d->particles->support_radius_m, 4.0, 1e-9);
  scene.particles->box_width_m = 4.0 * std::sqrt(2.0);
  const auto refused = derive(scene);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("particles.box_width_m"));
}

TEST(Derive, TaitWaterTakesSmallerSteps) {
  core::Scene scene = smallScene();
  const auto linear = derive(scene);
  scene.particles->equation_of_state = core::EquationOfState::kTait;
  const auto tait = derive(scene);
  ASSERT_TRUE(linear && tait);
  const auto bound = [](const Derived& d) {
    return std::ranges::find(d.rules, std::string("particles.sound_speed_mps"), &StepRule::field)->max_dt_s;
  };
  EXPECT_LT(bound(*tait), bound(*linear));
  const core::ParticleScene& p = *scene.particles;
  const double c0 = p.sound_speed_mps;
  const double rho_ratio =
      std::pow(1 + 7 * (0.5 * p.max_speed_mps * p.max_speed_mps + 9.81 * tait->particles->band_m) / (c0 * c0), 1.0 / 7);
  EXPECT_NEAR(bound(*tait), 0.7 * tait->particles->support_radius_m / (c0 * std::pow(rho_ratio, 3) + p.max_speed_mps),
              1e-12);
}

TEST(Derive, TheLargestNumberOfParticlesFitsItsDispatch) {
  for (const double layers_count : {1.0, 3.0, 16.0, 64.0}) {
    core::Scene scene = boxScene(kMaxParticleCount);
    scene.particles->layers_count = layers_count;
    scene.particles->headroom_m = 0.5;
    const auto d = derive(scene);
    ASSERT_TRUE(d) << d.error().message;
    EXPECT_LE(d->particles->count, kMaxParticleCount) << "a lattice of fewer, not of more";
    EXPECT_GT(d->particles->count, 0.98 * kMaxParticleCount);
    EXPECT_GE(d->device_bytes, std::uint64_t{d->particles->count} * 7 * 16);
  }
}

TEST(Derive, FourMillionParticlesFitTheDefaultHeadroom) {
  core::Scene scene;
  scene.wave.emplace();
  scene.particles.emplace();
  scene.particles->count = kMaxParticleCount;
  scene.coupling.emplace();
  const auto d = derive(scene);
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_GT(d->particles->cell_count, 1u << 22);
  EXPECT_LE(d->particles->cell_count, kMaxCellCount);
}

TEST(Derive, RefusesMoreCellsThanTheBoundAndNamesIt) {
  core::Scene scene = boxScene(262'144);
  scene.particles->layers_count = 64;  // 64^3: about 33^2 cells over the floor
  const auto low = derive(scene);
  ASSERT_TRUE(low) << low.error().message;
  const double cell_m = low->particles->support_radius_m;
  const double floor_cells = 1.0 * low->particles->cells[0] * low->particles->cells[2];
  scene.particles->headroom_m = (std::floor(kMaxCellCount / floor_cells) - 2) * cell_m + low->particles->min_m[1];
  const auto d = derive(scene);
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_GT(d->particles->cell_count, kMaxCellCount - 3 * floor_cells);
  scene.particles->headroom_m += 4 * cell_m;
  const auto refused = derive(scene);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("67108864"));
  EXPECT_THAT(refused.error().message, HasSubstr("particles.headroom_m"));
}

TEST(Derive, AnotherCountKeepsTheVolumeOfTheWater) {
  core::Scene scene = boxScene(8000);
  scene.particles->layers_count = 10;
  const auto first = derive(scene);
  ASSERT_TRUE(first);
  ParticleLayout layout = *first->particles;
  for (const std::uint32_t count : {1000u, 65'536u, 4000u, 8000u}) {
    scene.particles->count = count;
    const auto again = layOutAgain(scene, layout);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->volume_m3, first->particles->volume_m3);
    EXPECT_NEAR(again->count, count, 0.1 * count);
    const double volume = std::pow(again->spacing_m, 3) * again->count;
    EXPECT_NEAR(volume, again->volume_m3, 0.75 / again->layers_count * 1.1 * again->volume_m3)
        << "half a layer, at one and a half powers of it";
    layout = *again;
  }
  EXPECT_EQ(layout.layers_count, 10u);
  EXPECT_EQ(layout.columns_x_count, first->particles->columns_x_count);
}

TEST(Derive, TensionOfParticlesHasStepsAndBounds) {
  core::Scene scene;
  scene.gravity_mps2 = 0.0;
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.boundary_x = p.boundary_z = core::Boundary::kWall;
  p.count = 1000;
  p.layers_count = 10;
  p.box_side_m = 0.01;  // particles 1 mm apart
  p.viscosity_pas = 0.01;
  p.max_speed_mps = 0.5;
  p.surface_tension_npm = 0.0728;
  p.solver = core::PressureSolver::kPositionBased;
  const auto d = derive(scene);
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_THAT(d->rules.front().name, HasSubstr("surface tension"));
  EXPECT_NEAR(d->dt_s, 0.74e-3, 0.05e-3);
  EXPECT_GT(d->uniforms.tension_area_ps2, 0.0f);
  p.solver = core::PressureSolver::kWeaklyCompressible;
  p.sound_speed_mps = 2.0;
  EXPECT_THAT(derive(scene).error().message, AllOf(HasSubstr("2 m/s is too soft"), HasSubstr("at least 2.7 m/s")));
  p.sound_speed_mps = 3.0;
  EXPECT_TRUE(derive(scene));
  p.cohesion = true;
  EXPECT_THAT(derive(scene).error().message, HasSubstr("remove cohesion"));
}

/// A box that is periodic in every direction.
core::Scene weightlessScene() {
  core::Scene scene = smallScene(5 * 12 * 12);
  scene.wave.reset();
  scene.coupling.reset();
  scene.gravity_mps2 = 0.0;
  scene.particles->box_side_m = 2.0;
  scene.particles->layers_count = 5;
  scene.particles->periodic_y = true;
  return scene;
}

TEST(Derive, PeriodicBoxIsAsHighAsItsLayers) {
  core::Scene scene = weightlessScene();
  const auto whole = derive(scene);
  ASSERT_TRUE(whole) << whole.error().message;
  const ParticleLayout& l = *whole->particles;
  EXPECT_NEAR(l.max_m[1] - l.min_m[1], l.layers_count * l.spacing_m, 1e-12);
  scene.particles->fill_density_ratio = 1.1;
  const auto fuller = derive(scene);
  ASSERT_TRUE(fuller) << fuller.error().message;
  EXPECT_NEAR(fuller->particles->mass_kg, 1.1 * l.mass_kg, 1e-9 * l.mass_kg);
}

TEST(Derive, PeriodicBoxRefusesPartsThatNeedAFloor) {
  const auto refuses = [](const core::Scene& scene, const char* field) {
    const auto derived = derive(scene);
    ASSERT_FALSE(derived) << field;
    EXPECT_NE(derived.error().message.find(field), std::string::npos) << derived.error().message;
  };
  core::Scene scene = weightlessScene();
  scene.gravity_mps2 = 9.81;
  refuses(scene, "particles.periodic_y");
  scene = weightlessScene();
  scene.boats.emplace();
  refuses(scene, "particles.periodic_y");
  scene = weightlessScene();
  scene.particles->fill_x_ratio = 0.5;
  refuses(scene, "particles.periodic_y");
  scene = weightlessScene();
  scene.wave.emplace();
  refuses(scene, "particles.periodic_y");
  scene = weightlessScene();
  scene.particles->layers_count = 3;
  refuses(scene, "particles.layers_count");
  scene = weightlessScene();
  scene.particles->periodic_y = false;
  scene.particles->fill_density_ratio = 0.98;
  refuses(scene, "particles.fill_density_ratio");
}

}  // namespace
}  // namespace spindrift::sim
