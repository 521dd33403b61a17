// Floaters: contacts, hands, slots, and what they do to the water. One long file, because all tests share its
// basin and its reading of the state.
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/study/floater_pose.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kGravity_mps2 = 9.81;
constexpr double kTick_s = 1.0 / 60.0;

/// 8 m of water with the wave only; tests add what they need.
core::Scene floaterScene(std::vector<core::Floater> floaters = {}) {
  core::Scene scene;
  scene.name = "floaters";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 8.0;
  scene.wave->depth_m = 2.0;
  scene.wave->damping_per_s = 0.5;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.floaters.emplace();
  scene.floaters->floaters = std::move(floaters);
  return scene;
}

using study::FloaterPose;

class FloatersOnDevice : public OnDevice {
 protected:
  static std::vector<FloaterPose> poses(WaterSim& sim) { return study::floaterPoses(sim.copyState()); }
  static FloaterPose pose(WaterSim& sim) { return poses(sim).at(0); }
  static void run(WaterSim& sim, double duration_s) {
    for (int i = 0; i < duration_s / kTick_s; ++i) sim.step();
  }
  static double meanSpeed_mps(WaterSim& sim) {
    double sum = 0.0;
    const auto all = poses(sim);
    for (const FloaterPose& p : all) sum += p.speed_mps();
    return sum / static_cast<double>(all.size());
  }
};

TEST_F(FloatersOnDevice, PressADentOfTheirOwnVolumeIntoTheWater) {
  WaterSim& sim = make(floaterScene({core::Floater{.y_m = 0.0, .size_m = 1.2, .density_ratio = 0.5}}));
  run(sim, 20);
  const auto eta = sim.copyState().elevation_m;
  const double level_m = eta[3 + 64 * 3];
  double dent_m3 = 0;
  for (const double e : eta) dent_m3 += (level_m - e) * std::pow(8.0 / 64, 2);
  EXPECT_NEAR(dent_m3, 0.5 * std::pow(1.2, 3), 0.03 * 0.5 * std::pow(1.2, 3));
}

TEST_F(FloatersOnDevice, FallFreelyThroughTheAir) {
  WaterSim& sim =
      make(floaterScene({core::Floater{.y_m = 3.0, .size_m = 0.4, .velocity_x_mps = 2.0, .velocity_y_mps = 4.0}}));
  run(sim, 0.5);
  const FloaterPose p = pose(sim);
  EXPECT_NEAR(p.x_m, 1.0, 0.05);
  EXPECT_NEAR(p.middle_m(), 3.0 + 4.0 * 0.5 - kGravity_mps2 / 2 * 0.25, 0.1);
}

TEST_F(FloatersOnDevice, AFloatingHeapComesApartAndCalmsDown) {
  core::Scene scene = floaterScene();
  scene.floaters->capacity_count = 128;
  for (int i = 0; i < 100; ++i) {
    const int layer = i / 25;
    scene.floaters->floaters.push_back({.kind = static_cast<core::FloaterKind>(i % 7),
                                        .x_m = 0.45 * (i % 5 - 2) + 0.03 * layer,
                                        .y_m = 0.2 + 0.45 * layer,
                                        .z_m = 0.45 * (i / 5 % 5 - 2),
                                        .heading_deg = 7.0 * (i % 7),
                                        .size_m = 0.4});
  }
  WaterSim& sim = make(scene);
  run(sim, 2);
  const double early_mps = meanSpeed_mps(sim);
  run(sim, 13);
  EXPECT_LT(meanSpeed_mps(sim), 0.3 * early_mps);
  EXPECT_LT(meanSpeed_mps(sim), 0.15);
  for (const FloaterPose& p : poses(sim)) EXPECT_GT(p.y_m, -1.0);
}

TEST_F(FloatersOnDevice, KeepTheVolumeOfTheWaterToTheUnit) {
  core::Scene scene = floaterScene();
  scene.floaters->capacity_count = 64;
  WaterSim& sim = make(scene);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(sim.spawnFloater(core::Floater{.kind = static_cast<core::FloaterKind>(i % 8),
                                               .x_m = 0.5 * (i % 10 - 5),
                                               .y_m = 1.0,
                                               .z_m = 0.7 * (i % 7 - 3),
                                               .size_m = 0.5,
                                               .velocity_x_mps = 5.0 - i % 11,
                                               .velocity_y_mps = 3.0}));
    run(sim, 0.1);
  }
  const auto eta = sim.copyState().elevation_m;
  EXPECT_EQ(std::accumulate(eta.begin(), eta.end(), 0.0), 0.0);
  EXPECT_EQ(sim.recoveredCount(), 0u);
  run(sim, 4);  // a stone that has just fallen on something presses it into the bed for a moment
  for (const FloaterPose& p : poses(sim)) {
    EXPECT_LT(std::abs(p.x_m), 4.0);
    EXPECT_LT(std::abs(p.z_m), 4.0);
    EXPECT_GT(p.y_m, -2.0);
  }
}

TEST_F(FloatersOnDevice, KeepTheirMomentumInACollision) {
  core::Scene scene = floaterScene(
      {core::Floater{.kind = core::FloaterKind::kBall,
                     .x_m = -1,
                     .y_m = 5,
                     .size_m = 0.5,
                     .density_ratio = 0.3,
                     .velocity_x_mps = 3},
       core::Floater{
           .kind = core::FloaterKind::kBarrel, .x_m = 1, .y_m = 5.1, .z_m = 0.1, .heading_deg = 30, .size_m = 0.6}});
  scene.gravity_mps2 = 0.0;
  WaterSim& sim = make(scene);
  const double ball = 0.3 * std::numbers::pi / 6 * 0.125;
  const double barrel = 0.5 * std::numbers::pi * 0.198 * 0.198 * 0.6;
  run(sim, 1.5);
  const auto after = poses(sim);
  EXPECT_GT(after[1].velocity_x_mps, 0.3);
  EXPECT_NEAR(ball * after[0].velocity_x_mps + barrel * after[1].velocity_x_mps, ball * 3.0, 0.002 * ball);
  EXPECT_NEAR(ball * after[0].velocity_y_mps + barrel * after[1].velocity_y_mps, 0.0, 0.002 * ball);
  EXPECT_NEAR(ball * after[0].velocity_z_mps + barrel * after[1].velocity_z_mps, 0.0, 0.002 * ball);
}

TEST_F(FloatersOnDevice, PushABoatAndAreStoppedByIt) {
  core::Scene scene = floaterScene(
      {core::Floater{.kind = core::FloaterKind::kRaft, .x_m = -2.5, .y_m = 0.0, .size_m = 1.5, .velocity_x_mps = 6.0}});
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{.x_m = 0.5, .heading_deg = 90, .length_m = 2.0, .beam_m = 0.8, .height_m = 0.5}};
  WaterSim& sim = make(scene);
  run(sim, 1.5);
  const auto boat = sim.copyState().boats;
  EXPECT_GT(boat[0], 0.55f) << "the boat was pushed";
  EXPECT_LT(pose(sim).x_m + 0.75, boat[0] - 0.3) << "the raft is beside the boat";
}

TEST_F(FloatersOnDevice, AreNotPassedByABoatThatIsLowerThanThey) {
  core::Scene scene = floaterScene({core::Floater{.x_m = 1.5, .y_m = 0.1, .size_m = 1.2}});
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{
      .x_m = -2.0, .length_m = 2.0, .beam_m = 0.6, .height_m = 0.4, .max_speed_mps = 3.0, .throttle_ratio = 1.0}};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 240; ++i) {
    sim.step();
    const auto boat = sim.copyState().boats;
    const FloaterPose crate = pose(sim);
    EXPECT_GT(std::hypot(crate.x_m - boat[0], crate.z_m - boat[2]), 0.55) << "tick " << i;
    EXPECT_LT(crate.speed_mps(), 4.0);
    if (HasFailure()) break;
  }
  EXPECT_GT(pose(sim).x_m, 1.6) << "the crate was pushed";
}

TEST_F(FloatersOnDevice, SeparateWhenTheyBeginAtOnePosition) {
  const core::Floater ball{.kind = core::FloaterKind::kBall, .y_m = 0.2};
  WaterSim& sim = make(floaterScene({ball, ball}));
  run(sim, 4);
  const auto both = poses(sim);
  EXPECT_GT(std::hypot(both[0].x_m - both[1].x_m, both[0].y_m - both[1].y_m, both[0].z_m - both[1].z_m), 0.5);
}

/// Small balls, thrown into every side and corner.
TEST_F(FloatersOnDevice, ThrownAtASideStayInTheBasin) {
  std::vector<core::Floater> thrown;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * std::numbers::pi / 4;
    thrown.push_back({.kind = core::FloaterKind::kBall,
                      .x_m = 2.0 * std::cos(angle),
                      .y_m = 1.0,
                      .z_m = 2.0 * std::sin(angle),
                      .size_m = 0.1,
                      .density_ratio = 0.5,
                      .velocity_x_mps = 17.0 * std::cos(angle),
                      .velocity_z_mps = 17.0 * std::sin(angle)});
  }
  WaterSim& sim = make(floaterScene(thrown));
  double farthest_m = 0;
  for (int tick = 0; tick < 60; ++tick) {
    sim.step();
    for (const FloaterPose& p : poses(sim)) farthest_m = std::max({farthest_m, std::abs(p.x_m), std::abs(p.z_m)});
  }
  EXPECT_LE(farthest_m, 4.0);
  EXPECT_GE(farthest_m, 3.9) << "none reached a side";
}

TEST_F(FloatersOnDevice, FollowAHandTurnAndAreReleased) {
  WaterSim& sim = make(floaterScene({core::Floater{.kind = core::FloaterKind::kPlank, .y_m = 0.0, .size_m = 1.0}}));
  run(sim, 1);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(sim.holdFloater({.floater_id = 1, .x_m = 2.0, .z_m = -1.0, .lift_m = 0.3, .turn_radps = 2.0}));
    sim.step();
  }
  const FloaterPose held = pose(sim);
  EXPECT_NEAR(held.x_m, 2.0, 0.05);
  EXPECT_NEAR(held.z_m, -1.0, 0.05);
  EXPECT_NEAR(held.y_m, 0.3, 0.1);
  EXPECT_NEAR(held.spin_radps, 2.0, 0.3);
  run(sim, 2);  // 0.5 s after the last command nobody holds it
  EXPECT_LT(pose(sim).y_m, 0.1);
  ASSERT_TRUE(sim.holdFloater({.floater_id = 1, .x_m = 0.0, .z_m = 0.0, .lift_m = 1.0}));
  ASSERT_TRUE(sim.holdFloater({.floater_id = 1, .ends = true}));
  run(sim, 0.3);
  EXPECT_LT(pose(sim).y_m, 0.1);
  const auto unknown = sim.holdFloater({.floater_id = 7});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("7"));
}

TEST_F(FloatersOnDevice, MakeRoomByTheOldestStoneAndNeverByTheScenesOwn) {
  core::Scene scene = floaterScene({core::Floater{.x_m = -3, .y_m = 0.1}});
  scene.floaters->capacity_count = 3;
  WaterSim& sim = make(scene);
  EXPECT_EQ(*sim.spawnFloater({.kind = core::FloaterKind::kBall}), 2u);
  EXPECT_EQ(*sim.spawnFloater({.kind = core::FloaterKind::kStone, .x_m = 2}), 3u);
  EXPECT_EQ(*sim.spawnFloater({.kind = core::FloaterKind::kDuck}), 4u) << "the stone goes";
  const auto gone = sim.removeFloater(3);
  ASSERT_FALSE(gone);
  EXPECT_THAT(gone.error().message, HasSubstr("3 is not in the water"));
  EXPECT_EQ(*sim.spawnFloater({.x_m = -2}), 5u) << "the ball goes";
  EXPECT_FALSE(sim.removeFloater(2));
  EXPECT_TRUE(sim.removeFloater(4));
  EXPECT_EQ(sim.floaterCount(), 2u);
  EXPECT_EQ(*sim.spawnFloater({.kind = core::FloaterKind::kBall}), 6u) << "ids are not used again";
  EXPECT_FALSE(sim.removeFloater(0));
  EXPECT_TRUE(sim.removeFloaters());
  EXPECT_EQ(sim.floaterCount(), 0u);
  run(sim, 0.5);
  sim.reset();
  EXPECT_EQ(sim.floaterCount(), 1u);
}

TEST_F(FloatersOnDevice, AreRejectedWhenAllSlotsAreTheScenesOwn) {
  core::Scene scene = floaterScene({core::Floater{}});
  scene.floaters->capacity_count = 1;
  const auto full = make(scene).spawnFloater({});
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(full.error().message, HasSubstr("limit of 1 objects"));
}

TEST_F(FloatersOnDevice, ASceneWithoutFloatersRejectsThem) {
  core::Scene scene = floaterScene();
  scene.floaters.reset();
  WaterSim& sim = make(scene);
  EXPECT_FALSE(sim.spawnFloater({}));
  EXPECT_FALSE(sim.holdFloater({.floater_id = 1}));
  EXPECT_FALSE(sim.removeFloater(1));
  EXPECT_FALSE(sim.removeFloaters());
  EXPECT_EQ(sim.floaterCount(), 0u);
}

TEST_F(FloatersOnDevice, ContinueFromASavedStateBitForBit) {
  const core::Scene scene = floaterScene({core::Floater{.y_m = 0.4, .heading_deg = 20, .size_m = 0.6},
                                          core::Floater{.kind = core::FloaterKind::kBarrel, .x_m = 0.3, .y_m = 1.2}});
  WaterSim& first = make(scene);
  run(first, 1);
  ASSERT_TRUE(first.spawnFloater({.kind = core::FloaterKind::kStone, .x_m = 1, .y_m = 2}));
  ASSERT_TRUE(first.holdFloater({.floater_id = 1, .x_m = 1.0, .z_m = 1.0, .lift_m = 0.2}));
  run(first, 0.2);
  const SavedState saved = first.savedState();
  run(first, 1);
  const auto second = WaterSim::create(*ctx_, scene);
  ASSERT_TRUE((*second)->restore(saved));
  run(**second, 1);
  EXPECT_EQ(first.stateHash(), (*second)->stateHash());
  EXPECT_EQ(*(*second)->spawnFloater({}), 4u);
}

TEST_F(FloatersOnDevice, AreMendedWhenTheirStateIsNotFinite) {
  WaterSim& sim = make(floaterScene({core::Floater{.x_m = 1.5, .y_m = 0.1}, core::Floater{.x_m = -1.5, .y_m = 0.1}}));
  run(sim, 2);
  StateCopy state = sim.copyState();
  for (int i = 0; i < 12; ++i) state.floaters[static_cast<std::size_t>(i)] = std::numeric_limits<float>::quiet_NaN();
  sim.setState(state);
  run(sim, 1.5);
  for (const FloaterPose& p : poses(sim)) {
    EXPECT_TRUE(std::isfinite(p.x_m) && std::isfinite(p.speed_mps()));
    EXPECT_NEAR(std::abs(p.x_m), 1.5, 0.3);
  }
}

}  // namespace
}  // namespace spindrift::sim
