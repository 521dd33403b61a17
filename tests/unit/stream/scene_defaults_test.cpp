// Defaults stand twice, as options in proto and as initializers in core; these tests keep them one.
#include <gtest/gtest.h>

#include <spindrift/core/scene.h>
#include <spindrift/stream/scene_loader.h>

namespace spindrift::stream {
namespace {

v1::Scene sceneWithEveryPart() {
  v1::Scene scene;
  scene.mutable_wave();
  scene.mutable_particles();
  scene.mutable_coupling();
  scene.mutable_foam();
  scene.add_events()->mutable_effect()->mutable_splash();
  scene.add_events()->mutable_effect()->mutable_breaking_wave();
  return scene;
}

TEST(SceneDefaults, EqualThoseOfCoreForTheScene) {
  const core::Scene actual = toCore(sceneWithEveryPart());
  const core::Scene expected;
  EXPECT_EQ(actual.seed, expected.seed);
  EXPECT_EQ(actual.gravity_mps2, expected.gravity_mps2);
  EXPECT_EQ(actual.tick_rate_hz, expected.tick_rate_hz);
  EXPECT_EQ(actual.fixed_substeps_count, expected.fixed_substeps_count);
  EXPECT_EQ(actual.allow_unstable, expected.allow_unstable);
  EXPECT_EQ(actual.stream.frame_rate_hz, expected.stream.frame_rate_hz);
  EXPECT_EQ(actual.stream.surface_quantum_m, expected.stream.surface_quantum_m);
}

TEST(SceneDefaults, EqualThoseOfCoreForTheWave) {
  const core::WaveScene actual = toCore(sceneWithEveryPart()).wave.value();
  const core::WaveScene expected;
  EXPECT_EQ(actual.resolution_count, expected.resolution_count);
  EXPECT_EQ(actual.side_m, expected.side_m);
  EXPECT_EQ(actual.depth_m, expected.depth_m);
  EXPECT_EQ(actual.damping_per_s, expected.damping_per_s);
  EXPECT_EQ(actual.stencil, expected.stencil);
  EXPECT_EQ(actual.boundary, expected.boundary);
}

TEST(SceneDefaults, EqualThoseOfCoreForTheParticles) {
  const core::ParticleScene actual = toCore(sceneWithEveryPart()).particles.value();
  const core::ParticleScene expected;
  EXPECT_EQ(actual.count, expected.count);
  EXPECT_EQ(actual.layers_count, expected.layers_count);
  EXPECT_EQ(actual.patch_shift_x_m, expected.patch_shift_x_m);
  EXPECT_EQ(actual.patch_shift_z_m, expected.patch_shift_z_m);
  EXPECT_EQ(actual.patch_scale, expected.patch_scale);
  EXPECT_EQ(actual.box_side_m, expected.box_side_m);
  EXPECT_EQ(actual.headroom_m, expected.headroom_m);
  EXPECT_EQ(actual.support_ratio, expected.support_ratio);
  EXPECT_EQ(actual.rest_density_kgpm3, expected.rest_density_kgpm3);
  EXPECT_EQ(actual.sound_speed_mps, expected.sound_speed_mps);
  EXPECT_EQ(actual.max_speed_mps, expected.max_speed_mps);
  EXPECT_EQ(actual.viscosity_pas, expected.viscosity_pas);
  EXPECT_EQ(actual.jitter_ratio, expected.jitter_ratio);
  EXPECT_EQ(actual.boundary_x, expected.boundary_x);
  EXPECT_EQ(actual.boundary_z, expected.boundary_z);
}

TEST(SceneDefaults, EqualThoseOfCoreForCouplingAndFoam) {
  const core::Scene actual = toCore(sceneWithEveryPart());
  EXPECT_EQ(actual.coupling.value().lattice_count, core::CouplingScene{}.lattice_count);
  EXPECT_EQ(actual.coupling.value().downforce_per_m_s2, core::CouplingScene{}.downforce_per_m_s2);
  EXPECT_EQ(actual.foam.value().density_deficit_ratio, core::FoamScene{}.density_deficit_ratio);
  EXPECT_EQ(actual.foam.value().lifetime_s, core::FoamScene{}.lifetime_s);
}

TEST(SceneDefaults, EqualThoseOfCoreForEvents) {
  const core::Scene actual = toCore(sceneWithEveryPart());
  ASSERT_EQ(actual.events.size(), 2u);
  EXPECT_EQ(actual.events[0].at_s, core::TimedEvent{}.at_s);
  EXPECT_EQ(actual.events[0].every_s, core::TimedEvent{}.every_s);
  const core::Splash splash = std::get<core::Splash>(actual.events[0].effect);
  EXPECT_EQ(splash.x_m, core::Splash{}.x_m);
  EXPECT_EQ(splash.z_m, core::Splash{}.z_m);
  EXPECT_EQ(splash.radius_m, core::Splash{}.radius_m);
  EXPECT_EQ(splash.depth_m, core::Splash{}.depth_m);
  EXPECT_EQ(splash.duration_s, core::Splash{}.duration_s);
  const core::BreakingWave wave = std::get<core::BreakingWave>(actual.events[1].effect);
  EXPECT_EQ(wave.side, core::BreakingWave{}.side);
  EXPECT_EQ(wave.amplitude_m, core::BreakingWave{}.amplitude_m);
  EXPECT_EQ(wave.length_m, core::BreakingWave{}.length_m);
  EXPECT_EQ(wave.duration_s, core::BreakingWave{}.duration_s);
}

TEST(SceneDefaults, LeaveAbsentPartsAbsent) {
  v1::Scene scene;
  fillDefaults(scene);
  EXPECT_FALSE(scene.has_wave() || scene.has_particles() || scene.has_coupling() || scene.has_foam());
  EXPECT_TRUE(scene.has_stream());
  const core::Scene core_scene = toCore(scene);
  EXPECT_FALSE(core_scene.wave || core_scene.particles || core_scene.coupling || core_scene.foam);
}

TEST(SceneDefaults, FillOnlyWhatWasLeftOutAndTwiceIsTheSame) {
  v1::Scene scene = sceneWithEveryPart();
  scene.set_seed(7);
  scene.mutable_wave()->set_damping_per_s(0);
  scene.mutable_particles()->set_boundary_x(v1::BOUNDARY_WALL);
  fillDefaults(scene);
  EXPECT_EQ(scene.seed(), 7u);
  EXPECT_EQ(scene.wave().damping_per_s(), 0.0);
  EXPECT_EQ(scene.particles().boundary_x(), v1::BOUNDARY_WALL);
  EXPECT_EQ(scene.particles().boundary_z(), v1::BOUNDARY_PERIODIC);
  EXPECT_EQ(scene.particles().kernel_set(), v1::KERNEL_SET_WENDLAND_C2);
  EXPECT_EQ(scene.wave().stencil(), v1::STENCIL_FIVE_POINT);
  const std::string once = scene.SerializeAsString();
  fillDefaults(scene);
  EXPECT_EQ(scene.SerializeAsString(), once);
}

TEST(SceneDefaults, DoNotHideWhatAFileSays) {
  const auto scene = parseSceneText(
      "name: 'n' title: 't' description: 'd' seed: 3 gravity_mps2: 1 tick_rate_hz: 30 fixed_substeps_count: 2\n"
      "allow_unstable: true\n"
      "wave { resolution_count: 64 side_m: 8 depth_m: 2 damping_per_s: 0.3 stencil: STENCIL_NINE_POINT\n"
      "       boundary: BOUNDARY_WALL }\n"
      "particles { count: 100 layers_count: 2 patch_shift_x_m: 0.5 patch_shift_z_m: -0.5 patch_scale: 0.25\n"
      "            box_side_m: 3 headroom_m: 4 support_ratio: 2.5 rest_density_kgpm3: 900 sound_speed_mps: 20\n"
      "            max_speed_mps: 5 viscosity_pas: 1 jitter_ratio: 0.01 boundary_x: BOUNDARY_WALL\n"
      "            boundary_z: BOUNDARY_WALL }\n"
      "coupling { lattice_count: 3 downforce_per_m_s2: 2 }\n"
      "foam { density_deficit_ratio: 0.2 lifetime_s: 3 }\n"
      "stream { frame_rate_hz: 20 surface_quantum_m: 0.002 }\n"
      "events { at_s: 2 every_s: 5 effect { breaking_wave { side: SIDE_MINUS_Z amplitude_m: 0.2 length_m: 1\n"
      "         duration_s: 0.4 } } }\n"
      "events { effect { splash { x_m: 1 z_m: -1 radius_m: 0.5 depth_m: 0.25 duration_s: 0.1 } } }\n",
      "full.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::Scene out = toCore(*scene);
  EXPECT_EQ(out.name + out.title + out.description, "ntd");
  EXPECT_EQ(out.seed, 3u);
  EXPECT_EQ(out.gravity_mps2, 1.0);
  EXPECT_EQ(out.tick_rate_hz, 30.0);
  EXPECT_EQ(out.fixed_substeps_count, 2u);
  EXPECT_TRUE(out.allow_unstable);
  EXPECT_EQ(out.wave->resolution_count, 64u);
  EXPECT_EQ(out.wave->side_m, 8.0);
  EXPECT_EQ(out.wave->depth_m, 2.0);
  EXPECT_EQ(out.wave->damping_per_s, 0.3);
  EXPECT_EQ(out.wave->stencil, core::Stencil::kNinePoint);
  EXPECT_EQ(out.wave->boundary, core::Boundary::kWall);
  EXPECT_EQ(out.particles->count, 100u);
  EXPECT_EQ(out.particles->layers_count, 2.0);
  EXPECT_EQ(out.particles->patch_shift_x_m, 0.5);
  EXPECT_EQ(out.particles->patch_shift_z_m, -0.5);
  EXPECT_EQ(out.particles->patch_scale, 0.25);
  EXPECT_EQ(out.particles->box_side_m, 3.0);
  EXPECT_EQ(out.particles->headroom_m, 4.0);
  EXPECT_EQ(out.particles->support_ratio, 2.5);
  EXPECT_EQ(out.particles->rest_density_kgpm3, 900.0);
  EXPECT_EQ(out.particles->sound_speed_mps, 20.0);
  EXPECT_EQ(out.particles->max_speed_mps, 5.0);
  EXPECT_EQ(out.particles->viscosity_pas, 1.0);
  EXPECT_EQ(out.particles->jitter_ratio, 0.01);
  EXPECT_EQ(out.particles->boundary_x, core::Boundary::kWall);
  EXPECT_EQ(out.particles->boundary_z, core::Boundary::kWall);
  EXPECT_EQ(out.coupling->lattice_count, 3u);
  EXPECT_EQ(out.coupling->downforce_per_m_s2, 2.0);
  EXPECT_EQ(out.foam->density_deficit_ratio, 0.2);
  EXPECT_EQ(out.foam->lifetime_s, 3.0);
  EXPECT_EQ(out.stream.frame_rate_hz, 20.0);
  EXPECT_EQ(out.stream.surface_quantum_m, 0.002);
  ASSERT_EQ(out.events.size(), 2u);
  EXPECT_EQ(out.events[0].at_s, 2.0);
  EXPECT_EQ(out.events[0].every_s, 5.0);
  const auto wave = std::get<core::BreakingWave>(out.events[0].effect);
  EXPECT_EQ(wave.side, core::Side::kMinusZ);
  EXPECT_EQ(wave.amplitude_m, 0.2);
  EXPECT_EQ(wave.length_m, 1.0);
  EXPECT_EQ(wave.duration_s, 0.4);
  const auto splash = std::get<core::Splash>(out.events[1].effect);
  EXPECT_EQ(splash.x_m, 1.0);
  EXPECT_EQ(splash.z_m, -1.0);
  EXPECT_EQ(splash.radius_m, 0.5);
  EXPECT_EQ(splash.depth_m, 0.25);
  EXPECT_EQ(splash.duration_s, 0.1);
}

}  // namespace
}  // namespace spindrift::stream
