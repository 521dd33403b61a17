// Boats: floating, driving, collisions, wakes.
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/boats.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

/// 20 m of water with the wave only; tests add what they need.
core::Scene boatScene() {
  core::Scene scene;
  scene.name = "boats";
  scene.wave.emplace();
  scene.wave->resolution_count = 128;
  scene.wave->side_m = 20.0;
  scene.wave->depth_m = 1.5;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.boats.emplace();
  return scene;
}

struct BoatPose {
  double x_m, y_m, z_m, heading, pitch, roll, age_s, forward_mps, yaw_rate;
};

class BoatsOnDevice : public OnDevice {
 protected:
  BoatPose pose(WaterSim& sim, std::size_t place = 0) {
    const auto s = sim.copyState().boats;
    const std::size_t at = place * BOAT_TEXELS * 4;
    return {s[at], s[at + 1], s[at + 2], s[at + 3], s[at + 4], s[at + 5], s[at + 6], s[at + 8], s[at + 11]};
  }
};

TEST_F(BoatsOnDevice, FloatsAtTheDraughtOfItsDensity) {
  for (const double density : {0.2, 0.5, 0.8}) {
    core::Scene scene = boatScene();
    scene.wave->damping_per_s = 1.0;
    scene.boats->boats = {core::Boat{.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = density}};
    WaterSim& sim = make(scene);
    for (int i = 0; i < 700; ++i) sim.step();
    const BoatPose b = pose(sim);
    const double keel_m = b.y_m - 0.4;
    // The walls keep the displaced water, so the level away from the hull is a little higher.
    const double level_m = sim.copyState().elevation_m[5 + 128 * 5];
    EXPECT_NEAR(level_m - keel_m, density * 0.8, 0.03 * density * 0.8) << "density " << density;
    EXPECT_NEAR(b.pitch, 0.0, 1e-3);
    EXPECT_NEAR(b.roll, 0.0, 1e-3);
  }
}

TEST_F(BoatsOnDevice, PressesADentOfItsOwnVolumeIntoTheWater) {
  core::Scene scene = boatScene();
  scene.wave->damping_per_s = 1.0;
  scene.boats->boats = {core::Boat{.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = 0.5}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 1500; ++i) sim.step();
  const auto eta = sim.copyState().elevation_m;
  const double level_m = eta[5 + 128 * 5];
  double dent_m3 = 0;
  for (const double e : eta) dent_m3 += (level_m - e) * std::pow(20.0 / 128, 2);
  EXPECT_NEAR(dent_m3, 3.0 * 1.2 * 0.4, 0.03 * 3.0 * 1.2 * 0.4);
}

TEST_F(BoatsOnDevice, ReachesItsFullSpeedAndTurnsWithItsRudder) {
  core::Scene scene = boatScene();
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  scene.wave->damping_per_s = 0.5;
  scene.boats->boats = {core::Boat{.max_speed_mps = 2.0, .throttle_ratio = 1.0}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 600; ++i) sim.step();
  const BoatPose straight = pose(sim);
  EXPECT_NEAR(straight.forward_mps, 2.0, 0.2);
  EXPECT_NEAR(straight.heading, 0.0, 0.02);
  EXPECT_NEAR(straight.z_m, 0.0, 0.2);
  ASSERT_TRUE(sim.controlBoat(1, 1.0, 1.0));
  double turned = 0;
  double before = straight.heading;
  for (int i = 0; i < 300; ++i) {
    sim.step();
    const double now = pose(sim).heading;
    turned += std::remainder(now - before, 2 * std::numbers::pi);
    before = now;
  }
  EXPECT_GT(turned, 1.0) << "positive rudder turns from +x toward +z";
}

TEST_F(BoatsOnDevice, StaysOutOfRocksOtherBoatsAndWalls) {
  core::Scene scene = boatScene();
  scene.obstacles = {core::Rock{4.0, 0.0, 1.5, 0.8}, core::Breakwater{-4.0, 5.0, 6.0, 1.0, 30.0, 0.8}};
  scene.boats->boats = {
      core::Boat{.x_m = -2.0, .z_m = 0.2, .throttle_ratio = 1.0},
      core::Boat{.x_m = 0.0, .z_m = -4.0, .heading_deg = 90.0, .throttle_ratio = 1.0},
      core::Boat{.x_m = -7.0, .z_m = -7.0, .heading_deg = -135.0, .throttle_ratio = 1.0, .rudder_ratio = 0.2},
      core::Boat{.x_m = -3.0, .z_m = 8.0, .heading_deg = -90.0, .throttle_ratio = 0.8}};
  WaterSim& sim = make(scene);
  double deepest_m = 0;
  for (int i = 0; i < 900; ++i) {
    sim.step();
    if (i % 10) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const BoatPose b = pose(sim, k);
      ASSERT_TRUE(std::isfinite(b.x_m + b.y_m + b.z_m + b.heading));
      ASSERT_LE(std::abs(b.x_m), 10.0);
      ASSERT_LE(std::abs(b.z_m), 10.0);
      deepest_m = std::max(deepest_m, 1.5 - std::hypot(b.x_m - 4.0, b.z_m));
      for (std::size_t j = 0; j < k; ++j) {
        const BoatPose o = pose(sim, j);
        deepest_m = std::max(deepest_m, 0.9 - std::hypot(b.x_m - o.x_m, b.z_m - o.z_m));
      }
    }
  }
  EXPECT_LE(deepest_m, 0.25) << "centres of hulls never come closer than a beam, or into the rock";
}

TEST_F(BoatsOnDevice, AreAddedAndRemoved) {
  core::Scene scene = boatScene();
  scene.boats->capacity_count = 2;
  scene.boats->boats = {core::Boat{}};
  WaterSim& sim = make(scene);
  EXPECT_EQ(sim.boatCount(), 1u);
  const auto second = sim.spawnBoat(core::Boat{.x_m = 4.0});
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, 2u);
  const auto third = sim.spawnBoat(core::Boat{.x_m = -4.0});
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, core::ErrorCode::kUnavailable);
  ASSERT_TRUE(sim.removeBoat(1));
  EXPECT_FALSE(sim.removeBoat(1));
  const auto unknown = sim.controlBoat(9, 1, 0);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("9 is not on the water"));
  for (int i = 0; i < 10; ++i) sim.step();
  ASSERT_TRUE(sim.requestFrame({.bodies = true}));
  ctx_->finish();
  const auto frames = sim.takeFrames();
  ASSERT_TRUE(frames.at(0).bodies);
  ASSERT_EQ(frames[0].bodies->count, 1u);
  EXPECT_EQ(frames[0].bodies->words[0], 2u) << "its id";
  EXPECT_NEAR(static_cast<std::int32_t>(frames[0].bodies->words[1]) / 1000.0, 4.0, 0.1);
  sim.reset();
  EXPECT_EQ(sim.boats().front().boat_id, 1u);
}

TEST_F(BoatsOnDevice, LeavesAWakeOfFoamThatFades) {
  core::Scene scene = boatScene();
  scene.foam.emplace();
  scene.foam->surface = true;
  scene.foam->wake_lifetime_s = 1.0;
  scene.boats->boats = {core::Boat{.x_m = -6.0, .max_speed_mps = 2.5, .throttle_ratio = 1.0}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 150; ++i) sim.step();
  const auto white = [&] {
    EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.foam = true})));
    ctx_->finish();
    const auto frames = sim.takeFrames();
    double sum = 0;
    for (const std::uint32_t word : frames.at(0).at(core::Level::kFull).foam->words) {
      for (int byte = 0; byte < 4; ++byte) sum += word >> (8 * byte) & 0xffu;
    }
    return sum;
  };
  const double fresh = white();
  EXPECT_GT(fresh, 2000.0);
  ASSERT_TRUE(sim.removeBoat(1));
  for (int i = 0; i < 240; ++i) sim.step();
  EXPECT_LT(white(), 0.2 * fresh);
}

TEST_F(BoatsOnDevice, HullsPushParticles) {
  core::Scene scene = smallScene(2000);
  scene.boats.emplace();
  scene.boats->boats = {
      core::Boat{.length_m = 2.0, .beam_m = 0.9, .height_m = 0.6, .max_speed_mps = 2.0, .throttle_ratio = 0.5}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 240; ++i) sim.step();
  const BoatPose b = pose(sim);
  const StateCopy state = sim.copyState();
  int inside = 0;
  for (std::size_t k = 0; k < state.position.size(); k += 4) {
    const double dx = std::remainder(state.position[k] - b.x_m, 8.0);
    const double dz = std::remainder(state.position[k + 2] - b.z_m, 8.0);
    const double a = (dx * std::cos(b.heading) + dz * std::sin(b.heading)) / 1.0;
    const double s = (dz * std::cos(b.heading) - dx * std::sin(b.heading)) / 0.45;
    const double y = (state.position[k + 1] - b.y_m) / 0.3;
    if (a * a + s * s + y * y < 0.8 * 0.8) ++inside;
  }
  EXPECT_EQ(inside, 0);
  EXPECT_EQ(sim.escapedCount(), 0u);
}

TEST_F(BoatsOnDevice, ANonFiniteBoatStartsAgainAndChangesNoOther) {
  core::Scene scene = boatScene();
  scene.boats->boats = {core::Boat{.x_m = -3.0}, core::Boat{.x_m = 3.0}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 130; ++i) sim.step();
  StateCopy broken = sim.copyState();
  broken.boats[8] = std::numeric_limits<float>::quiet_NaN();
  sim.setState(broken);
  for (int i = 0; i < 200; ++i) sim.step();
  EXPECT_GE(sim.recoveredCount(), 1u);
  for (const float value : sim.copyState().boats) ASSERT_TRUE(std::isfinite(value));
  EXPECT_NEAR(pose(sim, 0).x_m, -3.0, 0.5) << "back where it came to the water";
  EXPECT_NEAR(pose(sim, 1).x_m, 3.0, 0.5);
  const auto recovered = sim.recoveredCount();
  for (int i = 0; i < 200; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), recovered);
}

TEST_F(BoatsOnDevice, ABoatInTheAirFallsFreelyAndLeavesTheWaterAlone) {
  core::Scene scene = boatScene();
  scene.boats->boats = {core::Boat{}};
  WaterSim& sim = make(scene);
  StateCopy state = sim.copyState();
  state.boats[1] = 10.0f;
  sim.setState(state);
  ASSERT_TRUE(sim.controlBoat(1, 1.0, 1.0));
  for (int i = 0; i < 60; ++i) sim.step();
  const BoatPose flying = pose(sim);
  EXPECT_NEAR(flying.y_m, 10.0 - 0.5 * 9.81, 0.1);
  EXPECT_EQ(flying.forward_mps, 0.0) << "its propeller turns in the air";
  EXPECT_EQ(flying.yaw_rate, 0.0);
  for (const double eta_m : sim.copyState().elevation_m) ASSERT_EQ(eta_m, 0.0);
  ASSERT_TRUE(sim.controlBoat(1, 0.0, 0.0));
  for (int i = 0; i < 900; ++i) sim.step();
  const core::Boat boat;
  EXPECT_NEAR(pose(sim).y_m, 0.5 * boat.height_m - boat.density_ratio * boat.height_m, 0.03) << "and floats again";
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(BoatsOnDevice, PloughThroughParticlesWithoutAWave) {
  core::Scene scene = smallScene(3000);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->box_side_m = 8.0;
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    scene.particles->solver = solver;
    scene.boats.emplace();
    scene.boats->boats = {core::Boat{
        .x_m = -2.0, .length_m = 1.6, .beam_m = 0.7, .height_m = 0.5, .max_speed_mps = 2.0, .throttle_ratio = 1.0}};
    WaterSim& sim = make(scene);
    double fastest_mps = 0;
    for (int i = 0; i < 150; ++i) {
      sim.step();
      fastest_mps = std::max(fastest_mps, sim.health().max_speed_mps);
    }
    const BoatPose b = pose(sim);
    EXPECT_GT(b.x_m, -1.0) << "it drove";
    EXPECT_LT(std::abs(b.x_m), 4.0) << "and stays in the box";
    EXPECT_GT(fastest_mps, 0.4) << "particles give way";
    EXPECT_EQ(sim.escapedCount(), 0u);
    EXPECT_EQ(sim.recoveredCount(), 0u);
  }
}

}  // namespace
}  // namespace spindrift::sim
