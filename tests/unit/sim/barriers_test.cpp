// Runs every pass on the particles and the surface; at the end of a test the barrier checker reports missing barriers
// (sim_fixture.h).
#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class Barriers : public OnDevice, public ::testing::WithParamInterface<core::PressureSolver> {
 protected:
  /// Two checkpoints, a frame of all layers every other tick, commands in between.
  void run(core::Scene scene) {
    scene.particles->solver = GetParam();
    WaterSim& sim = make(scene);
    ASSERT_TRUE(ctx_->checks().barriers) << "tests/shared/gpu_checks.cpp turns the checker on";
    for (int tick = 0; tick < 130; ++tick) {
      if (tick % 20 == 1) {
        ASSERT_TRUE(sim.start(core::Splash{0.2, -0.3, 0.6, 0.2, 0.1}));
      }
      if (tick == 33) {
        ASSERT_TRUE(sim.setScene(scene));
      }
      if (tick == 70) sim.reset();
      sim.step();
      if (tick % 2 == 0) {
        (void)sim.requestFrame(FrameRequest::allLayers());
      }
      (void)sim.takeFrames();
    }
  }
};

TEST_P(Barriers, HoldForParticlesAlone) {
  core::Scene scene = smallScene();
  scene.wave.reset();
  scene.coupling.reset();
  run(scene);
}

TEST_P(Barriers, HoldForParticlesOnAWaveWithBoats) {
  core::Scene scene = smallScene();
  scene.boats.emplace().boats.emplace_back();
  run(scene);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Barriers,
                         testing::Values(core::PressureSolver::kWeaklyCompressible,
                                         core::PressureSolver::kPositionBased),
                         [](const auto& run) {
                           return run.param == core::PressureSolver::kPositionBased ? "PositionBased"
                                                                                    : "WeaklyCompressible";
                         });

}  // namespace
}  // namespace spindrift::sim
