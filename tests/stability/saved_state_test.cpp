// A simulation that continues from a saved state runs bit for bit like the one that it was saved from, in every shipped
// scene, in the middle of random effects, boats and changes of parameters.
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "random_crowd.h"

namespace spindrift {
namespace {

constexpr int kTicksBefore = 24;
constexpr int kTicksAfter = 16;

/// As a room does it after a restart.
std::unique_ptr<sim::WaterSim> resumed(gpu::Context& ctx, const v1::Scene& start, const v1::Scene& now,
                                       const sim::SavedState& saved) {
  auto water = sim::WaterSim::create(ctx, scene::toCore(start));
  if (!water) return ADD_FAILURE() << water.error().message, nullptr;
  if (auto set = (*water)->setScene(scene::toCore(now)); !set) return ADD_FAILURE() << set.error().message, nullptr;
  if (auto done = (*water)->restore(saved); !done) return ADD_FAILURE() << done.error().message, nullptr;
  return *std::move(water);
}

class SavedState : public Endurance, public ::testing::WithParamInterface<std::string> {
 protected:
  void comparesAfter(Crowd::Sends sends) {
    v1::Scene start = shipped(GetParam());
    if (start.has_storm()) start.mutable_storm()->set_level_ratio(1.0);
    auto made = sim::WaterSim::create(*ctx_, scene::toCore(start));
    ASSERT_TRUE(made) << made.error().message;
    auto water = *std::move(made);
    Crowd crowd(start, sends);
    for (int tick = 0; tick < kTicksBefore; ++tick) {
      for (int k = 0; k < 3; ++k) crowd.send(*water);
      water->step();
    }
    ASSERT_EQ(water->recoveredCount(), 0u) << "when the watchdog acts depends on the machine";
    const sim::SavedState saved = water->savedState();
    const std::uint64_t then = water->stateHash();
    Crowd same = crowd;

    auto other = resumed(*ctx_, start, crowd.scene(), saved);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->stateHash(), then);
    EXPECT_EQ(other->time_s(), static_cast<double>(saved.run_tick) * other->derived().tick_s);
    for (int tick = 0; tick < kTicksAfter; ++tick) {
      same.send(*other);
      other->step();
    }
    for (int tick = 0; tick < kTicksAfter; ++tick) {
      crowd.send(*water);
      water->step();
    }
    EXPECT_EQ(water->stateHash(), other->stateHash()) << kTicksAfter << " ticks later";
    EXPECT_EQ(water->boats().size(), other->boats().size());
  }
};

TEST_P(SavedState, ResumesBitForBitWithEffectsAndBoats) {
  comparesAfter(Crowd::Sends::kEffectsAndBoats);
}

/// The scenes in which values of parameters make ticks last for seconds.
INSTANTIATE_TEST_SUITE_P(Scenes, SavedState,
                         testing::Values("boat_wake_particles", "dam_break", "pool", "splash_particles", "thesis"),
                         [](const auto& scene) { return scene.param; });

/// The other scenes, with effects and boats as well.
class SavedStateOfChangedScene : public SavedState {};

TEST_P(SavedStateOfChangedScene, GoesOnBitForBit) {
  comparesAfter(Crowd::Sends::kEverything);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SavedStateOfChangedScene,
                         testing::Values("beach", "boat_wake", "flume", "harbor", "kelvin", "open_water", "rain_rings",
                                         "splash", "wave_only"),
                         [](const auto& scene) { return scene.param; });

class SavedStateOfOtherCount : public SavedState {};

TEST_P(SavedStateOfOtherCount, GoesOnBitForBit) {
  const v1::Scene start = shipped(GetParam());
  auto water = sim::WaterSim::create(*ctx_, scene::toCore(start));
  ASSERT_TRUE(water) << water.error().message;
  (*water)->step();
  v1::Scene now = start;
  now.mutable_particles()->set_count(start.particles().count() * 3 / 4);
  const auto changed = (*water)->setScene(scene::toCore(now));
  ASSERT_TRUE(changed) << changed.error().message;
  for (int tick = 0; tick < 3; ++tick) (*water)->step();
  auto other = resumed(*ctx_, start, now, (*water)->savedState());
  ASSERT_TRUE(other);
  for (int tick = 0; tick < 3; ++tick) {
    (*water)->step();
    other->step();
  }
  EXPECT_EQ((*water)->stateHash(), other->stateHash());
}

INSTANTIATE_TEST_SUITE_P(Scenes, SavedStateOfOtherCount,
                         testing::Values("boat_wake_particles", "dam_break", "splash_particles"),
                         [](const auto& scene) { return scene.param; });

using SavedStateFromElsewhere = Endurance;

TEST_F(SavedStateFromElsewhere, IsRefusedWithTheReason) {
  const v1::Scene start = shipped("beach");
  auto water = sim::WaterSim::create(*ctx_, scene::toCore(start));
  ASSERT_TRUE(water) << water.error().message;
  (*water)->step();
  const std::uint64_t before = (*water)->stateHash();
  const auto refusal = [&](const sim::SavedState& saved) {
    const auto done = (*water)->restore(saved);
    EXPECT_EQ((*water)->stateHash(), before) << "nothing has changed";
    return done ? std::string() : done.error().message;
  };
  sim::SavedState saved = (*water)->savedState();
  saved.buffers[0].words.pop_back();
  EXPECT_THAT(refusal(saved), testing::HasSubstr("buffer elevation has 16199 words, here it has 16200"));
  saved = (*water)->savedState();
  saved.buffers.pop_back();
  EXPECT_THAT(refusal(saved), testing::HasSubstr("buffers"));
  saved = (*water)->savedState();
  saved.layout.back() += 1;
  EXPECT_THAT(refusal(saved), testing::HasSubstr("sizes or steps"));
}

}  // namespace
}  // namespace spindrift
