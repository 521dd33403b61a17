#include <gtest/gtest.h>

#include <spindrift/water/tick_cost.h>

namespace spindrift::water {
namespace {

TEST(TickCost, GrowsWithTheMoreExpensivePart) {
  TickCost cost;
  cost.restart(10.0, {.particle_step_count = 1000, .wave_step_count = 500});
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 3000, .wave_step_count = 500}), 30.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 1000, .wave_step_count = 2000}), 40.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 1, .wave_step_count = 1}), 10.0);
}

TEST(TickCost, CountsAChangeThatNoTickHasMeasuredYet) {
  TickCost cost;
  cost.restart(10.0, {.particle_step_count = 1000});
  cost.workChanged({.particle_step_count = 3000});
  EXPECT_DOUBLE_EQ(cost.tick_ms(), 30.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 9000}), 90.0);
  cost.note(20.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 9000}), 87.0);
}

TEST(TickCost, PredictsNoMoreThanWasMeasuredWithMoreWork) {
  TickCost cost;
  cost.restart(20.0, {.particle_step_count = 4000, .wave_step_count = 500});
  cost.workChanged({.particle_step_count = 100, .wave_step_count = 500});
  EXPECT_DOUBLE_EQ(cost.tick_ms(), 20.0);  // all of it may be the wave's
  for (int k = 0; k < 100; ++k) cost.note(10.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms({.particle_step_count = 4000, .wave_step_count = 500}), 20.0);
  EXPECT_NEAR(cost.predict_ms({.particle_step_count = 8000, .wave_step_count = 500}), 800.0, 0.1);
}

TEST(TickCost, FollowsTheMeasuredTicks) {
  TickCost cost;
  cost.restart(10.0, {});
  for (int k = 0; k < 100; ++k) cost.note(50.0);
  EXPECT_NEAR(cost.tick_ms(), 50.0, 0.1);
}

TEST(TickCost, CountsTheStepsOfAScene) {
  core::Scene scene;
  scene.particles.emplace();
  scene.particles->solver = core::PressureSolver::kPositionBased;
  scene.particles->iterations_count = 4;
  sim::Derived derived;
  derived.substeps_count = 3;
  derived.particles.emplace();
  derived.particles->count = 100;
  EXPECT_EQ(workOf(scene, derived).particle_step_count, 5 * 3 * 100);
  EXPECT_EQ(workOf(scene, derived).wave_step_count, 0.0);
}

}  // namespace
}  // namespace spindrift::water
