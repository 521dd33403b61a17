// The simulation of a room: frames, commands, the watchdog, reproducibility, and that absent parts cost nothing.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

class Water : public OnDevice {
 protected:
  core::FrameView frame(WaterSim& sim) {
    EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true, .particles = true})));
    ctx_->finish();
    auto frames = sim.takeFrames();
    EXPECT_EQ(frames.size(), 1u);
    return frames.empty() ? core::FrameView{} : std::move(frames.front());
  }
};

TEST_F(Water, RepeatsBitForBitWithTheSameSeedAndCommands) {
  const auto hash = [&](std::uint64_t seed) {
    core::Scene scene = smallScene();
    scene.seed = seed;
    WaterSim& sim = make(scene);
    for (int i = 0; i < 40; ++i) {
      if (i == 5) {
        EXPECT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.0, 0.5, 0.1}));
      }
      sim.step();
    }
    return sim.stateHash();
  };
  const auto first = hash(1);
  EXPECT_EQ(first, hash(1));
  EXPECT_NE(first, hash(2));
}

TEST_F(Water, AbsentPartsCostNoBufferProgramOrDispatch) {
  struct Cost {
    std::uint64_t buffers, bytes, programs, dispatches;
  };
  const auto cost = [&](const core::Scene& scene) {
    sim_.reset();
    const gpu::Ledger before = ctx_->ledger();
    WaterSim& sim = make(scene);
    const std::uint64_t started = ctx_->ledger().dispatch_count;
    sim.step();
    const gpu::Ledger& now = ctx_->ledger();
    return Cost{now.buffer_count - before.buffer_count, now.buffer_bytes - before.buffer_bytes,
                now.program_count - before.program_count, now.dispatch_count - started};
  };
  core::Scene full = smallScene();
  full.fixed_substeps_count = 2;
  core::Scene wave_only = full;
  wave_only.particles.reset();
  wave_only.coupling.reset();
  wave_only.foam.reset();
  core::Scene particles_only = full;
  particles_only.wave.reset();
  particles_only.coupling.reset();

  const Cost all = cost(full);
  const Cost wave = cost(wave_only);
  const Cost particles = cost(particles_only);
  // A wave alone has programs for splash, three for crests, momentum, two passes that limit outflow, continuity, its
  // diagnostics and packing. A tick has one wave step with four dispatches, two of which have no groups in calm water,
  // and one dispatch for the health.
  EXPECT_EQ(wave.programs, 10u);
  EXPECT_EQ(wave.dispatches, 5u);
  // Particles alone: 5 programs of the grid, 3 of sph, effects on particles, their diagnostics and packing; 2 x 8
  // dispatches per tick, and one for the health.
  EXPECT_EQ(particles.programs, 11u);
  EXPECT_EQ(particles.dispatches, 17u);
  // Together: the sum, and the sampling of the surface once per tick; the effects act on the wave.
  EXPECT_EQ(all.programs, wave.programs + particles.programs - 1 + 1);
  EXPECT_EQ(all.dispatches, wave.dispatches + particles.dispatches + 1);
  EXPECT_LT(wave.bytes, all.bytes);
  EXPECT_LT(particles.bytes, all.bytes);
  // derive() predicts the allocations: fields, two checkpoints of the state, and frames.
  sim_.reset();
  EXPECT_EQ(derive(wave_only)->device_bytes, sizeof(shared::SimUniforms) + 32 * 32 * (24 + 2 * 12 + 5 * 2));

  // Two-way: a pool and its plan, breaking, emission; in calm water the particle passes
  // have no groups.
  core::Scene two_way = full;
  two_way.coupling->mode = core::CouplingMode::kTwoWay;
  two_way.coupling->droplet_spacing_m = 0.25;
  const Cost both = cost(two_way);
  EXPECT_EQ(both.programs, all.programs + 3) << "breaking, plan, emit";
  EXPECT_EQ(both.dispatches, all.dispatches + 1 + 2 + 1) << "breaking, 2 plans, emission";

  core::Scene boats = wave_only;
  boats.boats.emplace();
  const Cost empty_harbor = cost(boats);
  EXPECT_EQ(empty_harbor.programs, wave.programs + 5) << "surface sampling, drift, kick, press, packing";
  EXPECT_EQ(empty_harbor.dispatches, wave.dispatches + 1) << "no boat, no pass over boats";
  boats.boats->boats = {core::Boat{}};
  EXPECT_EQ(cost(boats).dispatches, empty_harbor.dispatches + 3) << "drift, press, kick";
}

TEST_F(Water, SteppingAllocatesNothing) {
  WaterSim& sim = make(smallScene());
  sim.step();
  const gpu::Ledger before = ctx_->ledger();
  for (int i = 0; i < 80; ++i) {
    sim.step();
    (void)sim.requestFrame(FrameRequest::full({.surface = true, .particles = true}));
    (void)sim.takeFrames();
  }
  EXPECT_EQ(ctx_->ledger().buffers_made_count, before.buffers_made_count);
  EXPECT_EQ(ctx_->ledger().programs_made_count, before.programs_made_count);
}

TEST_F(Water, FramesHoldTheStateToHalfAQuantum) {
  WaterSim& sim = make(smallScene());
  ASSERT_TRUE(sim.start(core::Splash{0, 0, 1.0, 0.5, 0.05}));
  for (int i = 0; i < 20; ++i) sim.step();
  const StateCopy state = sim.copyState();
  const core::FrameView view = frame(sim);
  const auto& [surface, particles, foam] = view.at(core::Level::kFull);
  ASSERT_TRUE(surface && particles);
  EXPECT_EQ(view.tick, 20u);
  const auto n = surface->count.x;
  ASSERT_EQ(surface->words.size(), n * n / 2);
  for (std::size_t i = 0; i < std::size_t{n} * n; ++i) {
    const auto value = static_cast<std::int16_t>(surface->words[i / 2] >> (16 * (i % 2)));
    ASSERT_NEAR(value * surface->quantum_m, state.elevation_m[i], 0.5 * surface->quantum_m * 1.001);
  }
  const core::ParticleView& p = *particles;
  ASSERT_EQ(p.words.size(), 3u * p.count);
  for (std::size_t i = 0; i < p.count; ++i) {
    const std::uint32_t* w = &p.words[3 * i];
    const std::uint32_t q[3] = {w[0] & 0xffff, w[1] & 0xffff, w[0] >> 16};
    for (int axis = 0; axis < 3; ++axis) {
      const double side = p.max_m[axis] - p.min_m[axis];
      ASSERT_NEAR(p.min_m[axis] + q[axis] / 65535.0 * side, state.position[4 * i + axis], 0.51 * side / 65535);
    }
    const int v[3] = {static_cast<std::int8_t>(w[1] >> 16), static_cast<std::int8_t>(w[1] >> 24),
                      static_cast<std::int8_t>(w[2])};
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(v[axis] / 127.0 * p.max_speed_mps, state.velocity[4 * i + axis], 0.51 * p.max_speed_mps / 127);
    ASSERT_NEAR((w[2] >> 16 & 0xff) / 255.0, state.velocity[4 * i + 3], 0.51 / 255);
    ASSERT_EQ(w[2] >> 24, 0u);
  }
}

TEST_F(Water, DropsFramesWhileAllSlotsAreRead) {
  WaterSim& sim = make(smallScene());
  std::vector<core::FrameView> held;
  for (int i = 0; i < 4; ++i) held.push_back(frame(sim));
  EXPECT_FALSE(sim.requestFrame(FrameRequest::full({.surface = true})));
  held.clear();
  EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true})));
}

TEST_F(Water, ASplashEmitsParticlesAndMakesFoam) {
  core::Scene scene = smallScene(2000);
  scene.wave->resolution_count = 64;
  WaterSim& sim = make(scene);
  for (int i = 0; i < 30; ++i) sim.step();
  const auto highest = [](const StateCopy& state) {
    float y = -1e9f;
    for (std::size_t i = 1; i < state.position.size(); i += 4) y = std::max(y, state.position[i]);
    return y;
  };
  const auto foam = [](const StateCopy& state) {
    double sum = 0;
    for (std::size_t i = 3; i < state.velocity.size(); i += 4) sum += state.velocity[i];
    return sum;
  };
  const StateCopy calm = sim.copyState();
  ASSERT_TRUE(sim.start(core::Splash{0, 0, 1.2, 1.0, 0.2}));
  float top = -1e9f;
  double white = 0;
  for (int i = 0; i < 90; ++i) {
    sim.step();
    if (i % 10 == 9) {
      const StateCopy state = sim.copyState();
      top = std::max(top, highest(state));
      white = std::max(white, foam(state));
    }
  }
  EXPECT_GT(top, highest(calm) + 0.2f);
  EXPECT_GT(white, foam(calm) + 10.0);
  EXPECT_EQ(sim.nonfiniteCount(), 0u);
  EXPECT_EQ(sim.escapedCount(), 0u);
}

TEST_F(Water, StartsInBalance) {
  core::Scene scene = smallScene(1500);
  scene.particles->jitter_ratio = 0.0;
  WaterSim& sim = make(scene);
  sim.step();
  const StateCopy after = sim.copyState();
  for (const float v : after.velocity) ASSERT_LE(std::abs(v), 0.01 * scene.gravity_mps2 * sim.derived().tick_s);
}

TEST_F(Water, StillWaterStaysStill) {
  core::Scene scene = smallScene(1500);
  WaterSim& sim = make(scene);
  double worst = 0;
  for (int i = 0; i < 900; ++i) {
    sim.step();
    worst = std::max(worst, sim.health().kinetic_energy_j);
  }
  const double mass = sim.derived().particles->mass_kg * sim.derived().particles->count;
  // The starting lattice buckles into a looser order: never faster than 0.3 m/s on average, and calm again after 15 s.
  EXPECT_LE(worst, 0.5 * mass * 0.3 * 0.3);
  EXPECT_LE(sim.health().kinetic_energy_j, 0.5 * mass * 0.05 * 0.05);
  EXPECT_EQ(sim.health().max_elevation_m, 0.0);
}

TEST_F(Water, GoesBackToTheLastGoodCheckpointWhenAValueIsNotFinite) {
  WaterSim& sim = make(smallScene());
  for (int i = 0; i < 130; ++i) sim.step();
  ASSERT_EQ(sim.recoveredCount(), 0u);
  StateCopy broken = sim.copyState();
  broken.velocity[5] = std::numeric_limits<float>::quiet_NaN();
  broken.flow_m2ps[3] = std::numeric_limits<float>::infinity();
  sim.setState(broken);
  sim.step();
  const core::FrameView at_once = frame(sim);  // integers, so no client receives the NaN
  ASSERT_TRUE(at_once.at(core::Level::kFull).surface);
  for (int i = 0; i < 60; ++i) sim.step();
  EXPECT_GE(sim.recoveredCount(), 1u);
  EXPECT_GE(sim.nonfiniteCount(), 1u);
  const StateCopy healed = sim.copyState();
  for (const auto* part : {&healed.position, &healed.velocity, &healed.flow_m2ps}) {
    for (const float value : *part) ASSERT_TRUE(std::isfinite(value));
  }
  const auto recovered = sim.recoveredCount();
  for (int i = 0; i < 400; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), recovered) << "and stays healthy";
}

TEST_F(Water, GoesBackToTheStartWhenTheCheckpointFailsToo) {
  core::Scene scene = smallScene();
  scene.wave->damping_per_s = 0.0;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 0.5, 0.2, 0.2}));
  for (int i = 0; i < 130; ++i) sim.step();
  const auto breakDown = [&] {
    const auto before = sim.recoveredCount();
    StateCopy broken = sim.copyState();
    broken.flow_m2ps[3] = std::numeric_limits<float>::infinity();
    sim.setState(broken);
    while (sim.recoveredCount() == before && sim.tick() < 300) sim.step();
    return std::ranges::any_of(sim.copyState().elevation_m, [](double eta_m) { return eta_m != 0.0; });
  };
  EXPECT_TRUE(breakDown()) << "the checkpoint, in which the water moves";
  EXPECT_FALSE(breakDown()) << "it came before a later checkpoint was good";
  for (int i = 0; i < 130; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), 2u);
}

TEST_F(Water, ParametersTakeEffectWithoutARestart) {
  core::Scene scene = smallScene();
  WaterSim& sim = make(scene);
  for (int i = 0; i < 10; ++i) sim.step();
  scene.particles->sound_speed_mps = 100.0;
  ASSERT_TRUE(sim.setScene(scene));
  EXPECT_EQ(sim.tick(), 10u);
  EXPECT_GT(sim.derived().substeps_count, 2u) << "a stiffer water takes smaller steps by itself";
  sim.step();
  scene.particles->layers_count = 5;
  const auto refused = sim.setScene(scene);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("start the room again"));
}

TEST_F(Water, TakesEveryLiveParameterOfACoupledScene) {
  core::Scene scene = smallScene();
  WaterSim& sim = make(scene);
  sim.step();
  const ParticleLayout before = *sim.derived().particles;
  scene.wave->depth_m = 0.7;
  scene.particles->sound_speed_mps = 9.0;
  scene.gravity_mps2 = 3.7;
  scene.particles->viscosity_pas = 200.0;
  const auto accepted = sim.setScene(scene);
  ASSERT_TRUE(accepted) << accepted.error().message;
  EXPECT_EQ(sim.derived().particles->band_m, before.band_m) << "the running room keeps its floor";
  EXPECT_EQ(sim.derived().particles->cells, before.cells);
  EXPECT_NEAR(sim.derived().wave->speed_mps, std::sqrt(3.7 * 0.7), 1e-9);
  for (int i = 0; i < 60; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(Water, AParameterThatBreaksAFixedStepIsRefusedAndChangesNothing) {
  core::Scene scene = smallScene();
  scene.fixed_substeps_count = 4;
  WaterSim& sim = make(scene);
  scene.particles->sound_speed_mps = 400.0;
  const auto refused = sim.setScene(scene);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("particles.sound_speed_mps"));
  EXPECT_EQ(sim.scene().particles->sound_speed_mps, smallScene().particles->sound_speed_mps);
}

TEST_F(Water, ResetReturnsToTheStartingState) {
  WaterSim& sim = make(smallScene());
  const auto start = sim.stateHash();
  ASSERT_TRUE(sim.start(core::Splash{}));
  for (int i = 0; i < 30; ++i) sim.step();
  EXPECT_NE(sim.stateHash(), start);
  sim.reset();
  EXPECT_EQ(sim.stateHash(), start);
  EXPECT_EQ(sim.time_s(), 0.0);
  EXPECT_EQ(sim.tick(), 30u) << "ticks continue counting";
}

TEST_F(Water, ScenesStartTheirOwnEventsOnTime) {
  core::Scene scene = smallScene();
  scene.events.push_back({.at_s = 0.5, .every_s = 1.0, .effect = core::Splash{0, 0, 1.0, 0.5, 0.1}});
  WaterSim& sim = make(scene);
  for (int i = 0; i < 29; ++i) sim.step();
  EXPECT_EQ(sim.copyState().elevation_m, std::vector<double>(32 * 32, 0.0));
  for (int i = 0; i < 6; ++i) sim.step();
  EXPECT_NE(sim.copyState().elevation_m, std::vector<double>(32 * 32, 0.0));
}

TEST_F(Water, EffectsMoveTheParticlesWhereThereIsNoWave) {
  core::Scene scene = smallScene(3000);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->box_side_m = 4.0;
  scene.particles->layers_count = 6;
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  scene.particles->viscosity_pas = 5.0;
  WaterSim& sim = make(scene);
  const auto highest = [&] {
    const StateCopy state = sim.copyState();
    float y = -1e9f;
    for (std::size_t i = 1; i < state.position.size(); i += 4) y = std::max(y, state.position[i]);
    return y;
  };
  for (int i = 0; i < 60; ++i) sim.step();
  const float calm = highest();
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 0.7, 0.5, 0.1}));
  float thrown = calm;
  for (int i = 0; i < 60; ++i) {
    sim.step();
    thrown = std::max(thrown, highest());
  }
  EXPECT_GT(thrown, calm + 0.15f) << "the rim and the jet of a splash";
  EXPECT_EQ(sim.recoveredCount(), 0u);

  sim.reset();
  ASSERT_TRUE(sim.start(core::BreakingWave{core::Side::kMinusX, 0.2, 0.8, 0.2}));
  for (int i = 0; i < 20; ++i) sim.step();
  double momentum = 0;
  const StateCopy state = sim.copyState();
  for (std::size_t i = 0; i < state.velocity.size(); i += 4) momentum += state.velocity[i];
  EXPECT_GT(momentum / sim.particleCount(), 0.02) << "from -x the water moves toward +x";
}

TEST_F(Water, PeriodicParticlesStayInsideAndUnderTheSpeedLimit) {
  core::Scene scene = smallScene(1200);
  WaterSim& sim = make(scene);
  StateCopy state = sim.copyState();
  for (std::size_t i = 0; i < state.velocity.size(); i += 4) {
    state.velocity[i] = 100.0f;
    state.velocity[i + 2] = -70.0f;
  }
  sim.setState(state);
  for (int i = 0; i < 60; ++i) sim.step();
  const ParticleLayout& l = *sim.derived().particles;
  const StateCopy after = sim.copyState();
  for (std::size_t i = 0; i < after.position.size(); i += 4) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(after.position[i + axis], l.min_m[axis] - 1e-5);
      ASSERT_LE(after.position[i + axis], l.max_m[axis] + 1e-5);
    }
  }
  EXPECT_EQ(sim.escapedCount(), 0u);
  EXPECT_LE(sim.health().max_speed_mps, scene.particles->max_speed_mps * 1.01);
}

}  // namespace
}  // namespace spindrift::sim
