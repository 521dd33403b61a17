// States do not depend on the tuning profile: each value of each field, against the profile of a CPU.
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/sim/water_sim.h>

#include "small_scene.h"
#include "test_device.h"

namespace spindrift::sim {
namespace {

constexpr std::size_t kMostValues = 5;

/// Particles of a fixed number on a wave; breakers that become particles on waves that disperse. Sides and numbers fill
/// no whole group.
std::vector<core::Scene> tunedScenes() {
  core::Scene carried = smallScene(700);
  carried.wave->resolution_count = 37;
  core::Scene breaking = smallScene(900);
  breaking.wave->resolution_count = 80;
  breaking.wave->side_m = 12.0;
  breaking.wave->depth_m = 1.0;
  breaking.wave->dispersion = core::Dispersion::kAiry;
  breaking.coupling->mode = core::CouplingMode::kTwoWay;
  breaking.coupling->droplet_spacing_m = 0.12;
  breaking.coupling->emission_ratio = 2.0;
  breaking.foam->surface = true;
  return {carried, breaking};
}

std::vector<std::uint64_t> hashesWith(const gpu::TuningProfile& profile) {
  gpu::DeviceChoice choice = *gpu::testDevice();
  choice.tuning = profile;
  const auto ctx = gpu::Context::create(choice);
  if (!ctx) return {};
  std::vector<std::uint64_t> out;
  for (const core::Scene& scene : tunedScenes()) {
    auto sim = WaterSim::create(**ctx, scene);
    if (!sim) throw std::runtime_error(sim.error().message);
    EXPECT_TRUE((*sim)->start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
    for (int tick = 0; tick < 40; ++tick) {
      (*sim)->step();
      if (tick == 0) (*ctx)->finish();  // on some drivers the first tick compiles, for longer than a device may hang
    }
    EXPECT_FALSE((*sim)->deviceError()) << (*sim)->deviceError()->message;
    if (scene.coupling->mode == core::CouplingMode::kTwoWay) {
      EXPECT_GT((*sim)->health().emitted_count, 0u) << "no particle tells groups apart";
    }
    out.push_back((*sim)->stateHash());
  }
  EXPECT_EQ((*ctx)->debugErrorCount(), 0u);
  return out;
}

/// The argument counts the values of every field: one profile compiles all programs anew, which takes seconds.
class Tuning : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Tuning, LeavesStatesAsTheyAre) {
  static const std::vector<std::uint64_t> expected = hashesWith({});
  if (expected.empty()) GTEST_SKIP() << "no device";
  gpu::TuningProfile profile;
  for (const gpu::TuningField& field : gpu::tuningFields()) {
    ASSERT_LE(field.allowed.size(), kMostValues) << field.name;
    profile.*field.value = field.allowed[GetParam() % field.allowed.size()];
  }
  EXPECT_EQ(hashesWith(profile), expected);
}

INSTANTIATE_TEST_SUITE_P(EachValue, Tuning, ::testing::Range(std::size_t{0}, kMostValues));

}  // namespace
}  // namespace spindrift::sim
