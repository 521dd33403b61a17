// Particles at one position or without a finite position: a step stays bounded, and the watchdog is informed.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <shared/bindings.h>
#include <shared/grid.h>

#include "neighbor_grid.h"
#include "shader_defines.h"
#include "sim_fixture.h"
#include "solvers.h"

namespace spindrift::sim {
namespace {

/// After this many ticks the health of the first one has arrived, also on an asynchronous device.
constexpr int kHealthArrives_ticks = WaterSim::kMaxTicksInFlight + 2;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

core::Scene boxScene(core::PressureSolver solver, std::uint32_t count) {
  core::Scene scene = smallScene(count);
  scene.wave.reset();
  scene.coupling.reset();
  scene.foam.reset();
  scene.particles->box_side_m = 4.0;
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  scene.particles->solver = solver;
  return scene;
}

class PileUp : public OnDevice {
 protected:
  struct Looked {
    std::uint32_t crowded = 0;     ///< particles whose candidates were cut
    std::uint32_t candidates = 0;  ///< that all passes of one substep looked at
    std::uint32_t count = 0;       ///< particles
  };

  /// One substep with every particle in the same cell; shaders count the candidates that they visit.
  Looked lookAround(core::PressureSolver solver, std::uint32_t count, std::uint32_t candidates_max_count) {
    const core::Scene scene = boxScene(solver, count);
    auto derived = derive(scene);
    derived->uniforms.candidates_max_count = candidates_max_count;
    gpu::Defines defines = shaderDefines(scene);
    defines.emplace_back("COUNT_CANDIDATES", "1");
    auto uniforms = gpu::Buffer::create(*ctx_, "uniforms", sizeof(shared::SimUniforms));
    uniforms->uploadValue(derived->uniforms);
    uniforms->bindUniform(SIM_UNIFORMS);
    Creation create(*ctx_, defines);
    ParticleBuffers particles(create, derived->particles->count, false, false);
    NeighborGrid grid(create, *derived->particles);
    std::vector<float> position;
    for (std::uint32_t i = 0; i < derived->particles->count; ++i)
      position.insert(position.end(), {0.3f, 0.2f, 0.3f, static_cast<float>(i)});
    particles.position.upload(position);
    const Population all(derived->particles->count, nullptr);
    grid.build(particles, all);
    if (solver == core::PressureSolver::kPositionBased) {
      PositionBased passes(create);
      passes.project(particles, all, 1);
      passes.finish(particles, all);
    } else {
      Sph passes(create);
      passes.density(particles, all);
      passes.forces(particles, all);
    }
    ctx_->barrier(gpu::Barrier::kBufferUpdate);
    const auto words = grid.crowded().downloadVector<std::uint32_t>(2);
    return {words[0], words[1], derived->particles->count};
  }
};

TEST_F(PileUp, APassVisitsABoundedNumberOfCandidatesPerParticle) {
  constexpr std::uint32_t kUnbounded = 1u << 30;
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    const std::uint32_t passes = solver == core::PressureSolver::kPositionBased ? 3 : 2;
    const Looked all = lookAround(solver, 1500, kUnbounded);
    EXPECT_EQ(all.candidates, passes * all.count * all.count) << "without a bound the cost is the square";
    EXPECT_EQ(all.crowded, 0u);
    const Looked bounded = lookAround(solver, 1500, 100);
    EXPECT_EQ(bounded.candidates, passes * bounded.count * 100);
    EXPECT_EQ(bounded.crowded, bounded.count) << "and each cut particle is counted once";
  }
}

TEST_F(PileUp, TheBoundIsFarAboveTheCandidatesOfWaterAtRest) {
  core::Scene scene = boxScene(core::PressureSolver::kWeaklyCompressible, 700);
  EXPECT_EQ(derive(scene)->uniforms.candidates_max_count, 1024u);
  scene.particles->support_ratio = 3.0;
  EXPECT_GE(derive(scene)->uniforms.candidates_max_count, 32 * 3 * 27u);
}

TEST_F(PileUp, IsReportedInHealthAndTheRoomContinues) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    WaterSim& sim = make(boxScene(solver, 3000));
    for (int i = 0; i < 5; ++i) sim.step();
    ASSERT_EQ(sim.crowdedCount(), 0u) << "water at rest";
    StateCopy state = sim.copyState();
    for (std::size_t i = 0; i < state.position.size(); i += 4) {
      state.position[i] = 0.3f;
      state.position[i + 1] = 0.2f;
      state.position[i + 2] = 0.3f;
    }
    sim.setState(state);
    for (int i = 0; i < kHealthArrives_ticks; ++i) sim.step();
    EXPECT_GE(sim.crowdedCount(), sim.particleCount());
    EXPECT_FALSE(sim.deviceError());
  }
}

TEST_F(PileUp, APositionThatIsNotFiniteIsInNoCellAndCounted) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    core::Scene scene = boxScene(solver, 700);
    WaterSim& sim = make(scene);
    StateCopy state = sim.copyState();
    state.position[4 * 350] = kNan;
    state.position[4 * 351 + 1] = std::numeric_limits<float>::infinity();
    sim.setState(state);
    for (int i = 0; i < kHealthArrives_ticks; ++i) sim.step();
    EXPECT_EQ(sim.nonfiniteCount(), 2u);
    EXPECT_EQ(sim.recoveredCount(), 1u) << "the watchdog acted on the first health that had them";
  }
}

TEST_F(PileUp, AStepStaysBoundedWhenNoPositionIsFinite) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    WaterSim& sim = make(boxScene(solver, 3000));
    StateCopy state = sim.copyState();
    for (std::size_t i = 0; i < state.position.size(); i += 4) state.position[i] = kNan;
    sim.setState(state);
    for (int i = 0; i < kHealthArrives_ticks; ++i) sim.step();
    EXPECT_EQ(sim.nonfiniteCount(), sim.particleCount());
    EXPECT_EQ(sim.crowdedCount(), 0u) << "no cell holds them";
    for (const float x : sim.copyState().position) ASSERT_TRUE(std::isfinite(x));
  }
}

TEST_F(PileUp, APoolKeepsItsLedgerThroughAPositionThatIsNotFinite) {
  core::Scene scene = smallScene(600);
  scene.wave->resolution_count = 64;
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = 0.15;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0, 0, 1.5, 1.2, 0.2}));
  for (int i = 0; i < 400 && sim.copyState().position.size() < 40; ++i) sim.step();
  StateCopy state = sim.copyState();
  ASSERT_GE(state.position.size(), 40u);
  state.position[5] = kNan;
  sim.setState(state);
  for (int i = 0; i < kHealthArrives_ticks; ++i) {
    sim.step();
    ASSERT_EQ(sim.health().volume_error_units, 0) << "tick " << sim.health().tick;
  }
  EXPECT_GE(sim.nonfiniteCount(), 1u);
  EXPECT_GE(sim.recoveredCount(), 1u);
}

}  // namespace
}  // namespace spindrift::sim
