// A device that is slower than the host: ticks in flight are bounded, health arrives, and no wait is endless.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

/// A large lag: more fences than a hundred ticks insert.
constexpr std::uint64_t kFarBehind = 1000;

class DeviceLag : public OnDevice {
 protected:
  void TearDown() override {
    if (ctx_) ctx_->fenceDelay().set(0);
    OnDevice::TearDown();
  }
};

TEST_F(DeviceLag, HealthOfEveryTickArrivesAtMostThreeTicksLate) {
  WaterSim& sim = make(smallScene());
  ctx_->fenceDelay().set(kFarBehind);
  std::uint64_t last = 0;
  for (int i = 0; i < 120; ++i) {
    sim.step();
    const std::uint64_t known = sim.health().tick;
    ASSERT_LE(sim.tick() - known, WaterSim::kMaxTicksInFlight + 1) << "after tick " << sim.tick();
    if (last > 0) {
      ASSERT_EQ(known, last + 1) << "no tick is left out";
    }
    last = known;
  }
  EXPECT_FALSE(sim.deviceError());
}

TEST_F(DeviceLag, TheWatchdogStillActs) {
  WaterSim& sim = make(smallScene());
  for (int i = 0; i < 130; ++i) sim.step();
  ctx_->fenceDelay().set(kFarBehind);
  StateCopy broken = sim.copyState();
  broken.velocity[5] = std::numeric_limits<float>::quiet_NaN();
  sim.setState(broken);
  for (int i = 0; i < 6; ++i) sim.step();
  EXPECT_EQ(sim.recoveredCount(), 1u);
}

TEST_F(DeviceLag, ADeviceThatHangsIsAnErrorAndNoEndlessWait) {
  WaterSim& sim = make(smallScene());
  sim.step();
  ctx_->fenceDelay().set(gpu::FenceDelay::kForever);
  for (int i = 0; i < 20; ++i) sim.step();
  ASSERT_TRUE(sim.deviceError());
  EXPECT_THAT(sim.deviceError()->message, HasSubstr("has not finished tick"));
  EXPECT_THAT(sim.deviceError()->message, HasSubstr("10 s"));
  const std::uint64_t stood_at = sim.tick();
  EXPECT_LE(stood_at, 1 + WaterSim::kMaxTicksInFlight) << "no tick is submitted to a device that hangs";
  ctx_->fenceDelay().set(0);
  sim.step();
  EXPECT_EQ(sim.tick(), stood_at) << "a simulation that lost its device is over";
}

TEST_F(DeviceLag, ACheckpointIsConfirmedAlthoughTheNextOneIsDueBefore) {
  core::Scene scene = smallScene();
  scene.tick_rate_hz = 2;  // a checkpoint every other tick, health up to four ticks late
  scene.allow_unstable = true;
  WaterSim& sim = make(scene);
  ctx_->fenceDelay().set(kFarBehind);
  for (int i = 0; i < 24; ++i) sim.step();
  ASSERT_EQ(sim.recoveredCount(), 0u);
  // Copied here and not earlier: a copy waits, which lets a slow device catch up.
  StateCopy broken = sim.copyState();
  broken.velocity[5] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.0, 0.3, 0.1}));
  for (int i = 0; i < 12; ++i) sim.step();
  ASSERT_EQ(sim.recoveredCount(), 0u);
  sim.setState(broken);
  for (int i = 0; sim.recoveredCount() == 0 && i < 10; ++i) sim.step();
  ASSERT_EQ(sim.recoveredCount(), 1u);
  // Restored to a checkpoint after the splash, where the water moves; before the splash the surface is level.
  EXPECT_THAT(sim.copyState().elevation_m, ::testing::Contains(::testing::Ne(0.0)));
}

TEST_F(DeviceLag, LostFramesAreNotInFlight) {
  core::Scene scene = smallScene();
  WaterSim& sim = make(scene);
  ctx_->fenceDelay().set(kFarBehind);
  EXPECT_EQ(sim.framesInFlight(), 0u);
  for (int i = 0; i < 2; ++i) {
    sim.step();
    ASSERT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true, .particles = true})));
  }
  EXPECT_TRUE(sim.takeFrames().empty());
  EXPECT_EQ(sim.framesInFlight(), 2u);
  scene.particles->count = 900;
  ASSERT_TRUE(sim.setScene(scene));
  EXPECT_EQ(sim.framesInFlight(), 0u) << "another number of particles discards the frames of the old one";
  ctx_->fenceDelay().set(0);
  sim.step();
  ASSERT_TRUE(sim.requestFrame(FrameRequest::full({.particles = true})));
  ctx_->finish();
  EXPECT_EQ(sim.takeFrames().size(), 1u);
  EXPECT_EQ(sim.framesInFlight(), 0u);
}

}  // namespace
}  // namespace spindrift::sim
