// What a scene holds where a file leaves a field out.
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <spindrift/core/scene.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/v1/options.pb.h>

namespace spindrift::scene {
namespace {

v1::Scene sceneWithEveryPart() {
  v1::Scene scene;
  scene.mutable_wave();
  scene.mutable_particles();
  scene.mutable_coupling();
  scene.mutable_foam();
  scene.add_obstacles()->mutable_rock();
  scene.add_obstacles()->mutable_breakwater();
  scene.add_beaches();
  scene.mutable_boats()->add_boats();
  scene.mutable_storm();
  scene.add_events()->mutable_effect()->mutable_splash();
  scene.add_events()->mutable_effect()->mutable_breaking_wave();
  return scene;
}

// Numbers have one source: core's defaults are generated from the options in the proto. Enumerations have two.
TEST(SceneDefaults, OfEnumerationsEqualThoseOfCore) {
  const core::Scene actual = toCore(sceneWithEveryPart());
  const core::WaveScene& wave = actual.wave.value();
  EXPECT_EQ(wave.stencil, core::WaveScene{}.stencil);
  EXPECT_EQ(wave.boundary_minus_x, core::WaveScene{}.boundary_minus_x);
  EXPECT_EQ(wave.boundary_plus_x, core::WaveScene{}.boundary_plus_x);
  EXPECT_EQ(wave.boundary_minus_z, core::WaveScene{}.boundary_minus_z);
  EXPECT_EQ(wave.boundary_plus_z, core::WaveScene{}.boundary_plus_z);
  const core::ParticleScene& particles = actual.particles.value();
  EXPECT_EQ(particles.boundary_x, core::ParticleScene{}.boundary_x);
  EXPECT_EQ(particles.boundary_z, core::ParticleScene{}.boundary_z);
  EXPECT_EQ(particles.kernel_set, core::ParticleScene{}.kernel_set);
  EXPECT_EQ(particles.solver, core::ParticleScene{}.solver);
  EXPECT_EQ(particles.equation_of_state, core::ParticleScene{}.equation_of_state);
  EXPECT_EQ(particles.pressure_force, core::ParticleScene{}.pressure_force);
  EXPECT_EQ(actual.coupling.value().mode, core::CouplingScene{}.mode);
  EXPECT_EQ(actual.coupling->patch_follow, core::CouplingScene{}.patch_follow);
  ASSERT_EQ(actual.beaches.size(), 1u);
  EXPECT_EQ(actual.beaches[0].side, core::Beach{}.side);
  ASSERT_EQ(actual.events.size(), 2u);
  const core::BreakingWave crest = std::get<core::BreakingWave>(actual.events[1].effect);
  EXPECT_EQ(crest.side, core::BreakingWave{}.side);
  EXPECT_EQ(crest.shape, core::BreakingWave{}.shape);
}

// One field of each message: the generated header is that of this proto, and a scene is filled from it.
TEST(SceneDefaults, OfNumbersReachCore) {
  const core::Scene actual = toCore(sceneWithEveryPart());
  const auto option = [](const google::protobuf::Descriptor* message, const char* field) {
    return message->FindFieldByName(field)->options().GetExtension(v1::parameter).default_();
  };
  EXPECT_EQ(actual.gravity_mps2, option(v1::Scene::descriptor(), "gravity_mps2"));
  EXPECT_EQ(core::Scene{}.gravity_mps2, actual.gravity_mps2);
  EXPECT_EQ(actual.wave->resolution_count, option(v1::WaveScene::descriptor(), "resolution_count"));
  EXPECT_EQ(core::WaveScene{}.resolution_count, actual.wave->resolution_count);
  EXPECT_EQ(actual.storm->wind_direction_deg, option(v1::StormScene::descriptor(), "wind_direction_deg"));
  EXPECT_EQ(core::StormScene{}.wind_direction_deg, actual.storm->wind_direction_deg);
  EXPECT_EQ(actual.seed, core::Scene{}.seed);
}

TEST(SceneDefaults, LetAsManyBoatsInAsCoreCanHold) {
  const auto& options =
      v1::BoatsScene::descriptor()->FindFieldByName("capacity_count")->options().GetExtension(v1::parameter);
  EXPECT_EQ(options.max(), core::kMaxBoats);
}

TEST(SceneDefaults, LeaveAbsentPartsAbsent) {
  v1::Scene scene;
  fillDefaults(scene);
  EXPECT_FALSE(scene.has_wave() || scene.has_particles() || scene.has_coupling() || scene.has_foam());
  EXPECT_TRUE(scene.has_stream());
  const core::Scene core_scene = toCore(scene);
  EXPECT_FALSE(core_scene.wave || core_scene.particles || core_scene.coupling || core_scene.foam);
}

TEST(SceneDefaults, ChooseMatchedLayersUnlessTheStencilHasNinePoints) {
  const auto chosen = [](const std::string& wave) {
    const auto scene = parseSceneText("wave { " + wave + " }", "scene");
    EXPECT_TRUE(scene) << wave;
    return toCore(*scene).wave->absorption;
  };
  EXPECT_EQ(chosen(""), core::Absorption::kPml);
  EXPECT_EQ(chosen("dispersion: DISPERSION_AIRY"), core::Absorption::kPml);
  EXPECT_EQ(chosen("stencil: STENCIL_NINE_POINT"), core::Absorption::kSponge);
  EXPECT_EQ(chosen("absorption: ABSORPTION_SPONGE"), core::Absorption::kSponge);
  EXPECT_EQ(chosen("dispersion: DISPERSION_AIRY absorption: ABSORPTION_SPONGE"), core::Absorption::kSponge);
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
      "       boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_ABSORB\n"
      "       boundary_minus_z: WAVE_BOUNDARY_ABSORB boundary_plus_z: WAVE_BOUNDARY_REFLECT\n"
      "       sponge_width_m: 1.5 steepening_ratio: 0.5 fixed_substeps_count: 7 absorption: ABSORPTION_SPONGE }\n"
      "particles { count: 100 layers_count: 2 patch_shift_x_m: 0.5 patch_shift_z_m: -0.5 patch_scale: 0.25\n"
      "            box_side_m: 3 headroom_m: 4 support_ratio: 2.5 rest_density_kgpm3: 900 sound_speed_mps: 20\n"
      "            max_speed_mps: 5 viscosity_pas: 1 jitter_ratio: 0.01 boundary_x: BOUNDARY_WALL\n"
      "            boundary_z: BOUNDARY_WALL kernel_set: KERNEL_SET_MULLER solver: PRESSURE_SOLVER_POSITION_BASED\n"
      "            equation_of_state: EQUATION_OF_STATE_TAIT pressure_force: PRESSURE_FORCE_MEAN iterations_count: 7\n"
      "            cohesion: true fill_x_ratio: 0.5 fill_z_ratio: 0.75 box_width_m: 2 settle_s: 3\n"
      "            periodic_y: true fill_density_ratio: 1.1 }\n"
      "coupling { lattice_count: 3 downforce_per_m_s2: 2 mode: COUPLING_MODE_TWO_WAY patch_follow: PATCH_FOLLOW_BOAT\n"
      "           emission_ratio: 2 droplet_spacing_m: 0.2 }\n"
      "foam { density_deficit_ratio: 0.2 lifetime_s: 3 neighbours_count: 4 surface: true breaking_lifetime_s: 1\n"
      "       wake_lifetime_s: 2 landing_lifetime_s: 4 }\n"
      "obstacles { rock { x_m: 2 z_m: 3 radius_m: 0.5 height_m: 0.25 } }\n"
      "obstacles { breakwater { x_m: -1 z_m: -2 length_m: 3 width_m: 0.5 heading_deg: 45 height_m: 0.75 } }\n"
      "beaches { side: SIDE_MINUS_Z width_m: 2 shore_depth_m: 0.5 }\n"
      "boats { capacity_count: 3 boats { x_m: -2 z_m: 2 heading_deg: 90 length_m: 1.5 beam_m: 0.5 height_m: 0.4\n"
      "        density_ratio: 0.5 max_speed_mps: 3 throttle_ratio: 0.25 rudder_ratio: -0.5 } }\n"
      "storm { level_ratio: 0.5 drops_per_m2_s: 0.25 drop_depth_m: 0.125 wave_height_m: 0.2 wind_direction_deg: 30 "
      "wind_speed_mps: 12.5 fetch_m: 500 }\n"
      "stream { frame_rate_hz: 20 surface_quantum_m: 0.002 }\n"
      "events { at_s: 2 every_s: 5 effect { breaking_wave { side: SIDE_MINUS_Z amplitude_m: 0.2 length_m: 1\n"
      "         duration_s: 0.4 shape: WAVE_SHAPE_SWELL } } }\n"
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
  EXPECT_EQ(out.wave->boundary_minus_x, core::WaveBoundary::kReflect);
  EXPECT_EQ(out.wave->boundary_plus_x, core::WaveBoundary::kAbsorb);
  EXPECT_EQ(out.wave->boundary_minus_z, core::WaveBoundary::kAbsorb);
  EXPECT_EQ(out.wave->boundary_plus_z, core::WaveBoundary::kReflect);
  EXPECT_EQ(out.wave->sponge_width_m, 1.5);
  EXPECT_EQ(out.wave->steepening_ratio, 0.5);
  EXPECT_EQ(out.wave->fixed_substeps_count, 7u);
  EXPECT_EQ(out.wave->absorption, core::Absorption::kSponge);
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
  EXPECT_EQ(out.particles->kernel_set, core::KernelSet::kMuller);
  EXPECT_EQ(out.particles->solver, core::PressureSolver::kPositionBased);
  EXPECT_EQ(out.particles->equation_of_state, core::EquationOfState::kTait);
  EXPECT_EQ(out.particles->pressure_force, core::PressureForce::kMean);
  EXPECT_EQ(out.particles->iterations_count, 7u);
  EXPECT_TRUE(out.particles->cohesion);
  EXPECT_EQ(out.particles->fill_x_ratio, 0.5);
  EXPECT_EQ(out.particles->fill_z_ratio, 0.75);
  EXPECT_EQ(out.particles->box_width_m, 2.0);
  EXPECT_EQ(out.particles->settle_s, 3.0);
  EXPECT_TRUE(out.particles->periodic_y);
  EXPECT_EQ(out.particles->fill_density_ratio, 1.1);
  EXPECT_EQ(out.coupling->mode, core::CouplingMode::kTwoWay);
  EXPECT_EQ(out.coupling->patch_follow, core::PatchFollow::kBoat);
  EXPECT_EQ(out.coupling->emission_ratio, 2.0);
  EXPECT_EQ(out.coupling->droplet_spacing_m, 0.2);
  EXPECT_EQ(out.coupling->lattice_count, 3u);
  EXPECT_EQ(out.coupling->downforce_per_m_s2, 2.0);
  EXPECT_EQ(out.foam->density_deficit_ratio, 0.2);
  EXPECT_EQ(out.foam->lifetime_s, 3.0);
  EXPECT_EQ(out.foam->neighbours_count, 4u);
  EXPECT_TRUE(out.foam->surface);
  EXPECT_EQ(out.foam->breaking_lifetime_s, 1.0);
  EXPECT_EQ(out.foam->wake_lifetime_s, 2.0);
  EXPECT_EQ(out.foam->landing_lifetime_s, 4.0);
  const auto rock = std::get<core::Rock>(out.obstacles.at(0));
  EXPECT_EQ(rock.x_m, 2.0);
  EXPECT_EQ(rock.z_m, 3.0);
  EXPECT_EQ(rock.radius_m, 0.5);
  EXPECT_EQ(rock.height_m, 0.25);
  const auto wall = std::get<core::Breakwater>(out.obstacles.at(1));
  EXPECT_EQ(wall.x_m, -1.0);
  EXPECT_EQ(wall.z_m, -2.0);
  EXPECT_EQ(wall.length_m, 3.0);
  EXPECT_EQ(wall.width_m, 0.5);
  EXPECT_EQ(wall.heading_deg, 45.0);
  EXPECT_EQ(wall.height_m, 0.75);
  EXPECT_EQ(out.beaches.at(0).side, core::Side::kMinusZ);
  EXPECT_EQ(out.beaches[0].width_m, 2.0);
  EXPECT_EQ(out.beaches[0].shore_depth_m, 0.5);
  EXPECT_EQ(out.boats->capacity_count, 3u);
  const core::Boat& boat = out.boats->boats.at(0);
  EXPECT_EQ(boat.x_m, -2.0);
  EXPECT_EQ(boat.z_m, 2.0);
  EXPECT_EQ(boat.heading_deg, 90.0);
  EXPECT_EQ(boat.length_m, 1.5);
  EXPECT_EQ(boat.beam_m, 0.5);
  EXPECT_EQ(boat.height_m, 0.4);
  EXPECT_EQ(boat.density_ratio, 0.5);
  EXPECT_EQ(boat.max_speed_mps, 3.0);
  EXPECT_EQ(boat.throttle_ratio, 0.25);
  EXPECT_EQ(boat.rudder_ratio, -0.5);
  EXPECT_EQ(out.storm->level_ratio, 0.5);
  EXPECT_EQ(out.storm->drops_per_m2_s, 0.25);
  EXPECT_EQ(out.storm->drop_depth_m, 0.125);
  EXPECT_EQ(out.storm->wave_height_m, 0.2);
  EXPECT_EQ(out.storm->wind_direction_deg, 30.0);
  EXPECT_EQ(out.storm->wind_speed_mps, 12.5);
  EXPECT_EQ(out.storm->fetch_m, 500.0);
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
  EXPECT_EQ(wave.shape, core::WaveShape::kSwell);
  const auto splash = std::get<core::Splash>(out.events[1].effect);
  EXPECT_EQ(splash.x_m, 1.0);
  EXPECT_EQ(splash.z_m, -1.0);
  EXPECT_EQ(splash.radius_m, 0.5);
  EXPECT_EQ(splash.depth_m, 0.25);
  EXPECT_EQ(splash.duration_s, 0.1);
}

}  // namespace
}  // namespace spindrift::scene
