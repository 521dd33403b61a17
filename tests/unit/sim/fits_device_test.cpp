// What a scene takes of its device: predicted, and refused before anything is made where the device does not have it.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/particle_layout.h>

#include "sim_fixture.h"
#include "small_scene.h"
#include "test_device.h"

namespace spindrift::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FitsDevice : public OnDevice {};

TEST_F(FitsDevice, MemoryIsPredicted) {
  core::Scene one_way = smallScene(4000);
  one_way.wave->resolution_count = 128;
  core::Scene two_way = one_way;
  two_way.coupling->mode = core::CouplingMode::kTwoWay;
  two_way.coupling->droplet_spacing_m = 0.15;
  core::Scene open_sea = one_way;
  open_sea.particles.reset();
  open_sea.coupling.reset();
  open_sea.foam.emplace().surface = true;
  open_sea.wave->boundary_plus_x = core::WaveBoundary::kAbsorb;
  core::Scene dispersive = open_sea;
  dispersive.wave->dispersion = core::Dispersion::kAiry;
  core::Scene nonlinear = open_sea;
  nonlinear.wave->bulk = core::Bulk::kNonlinear;
  for (const auto& [name, scene] :
       {std::pair("one way", one_way), std::pair("two way", two_way), std::pair("open sea", open_sea),
        std::pair("dispersive", dispersive), std::pair("nonlinear", nonlinear)}) {
    SCOPED_TRACE(name);
    sim_.reset();
    ctx_->collectRetired();
    const std::uint64_t before_bytes = ctx_->ledger().buffer_bytes;
    const WaterSim& sim = make(scene);
    const auto taken_bytes = static_cast<double>(ctx_->ledger().buffer_bytes - before_bytes);
    const auto predicted_bytes = static_cast<double>(sim.derived().device_bytes);
    EXPECT_GE(predicted_bytes, 0.9 * taken_bytes);
    EXPECT_LE(predicted_bytes, 1.2 * taken_bytes) << "dispersion takes less over flat ground";
  }
}

TEST_F(FitsDevice, ASceneBeyondTheMemoryIsRefusedBeforeABufferIsMade) {
  auto small = gpu::Context::create(*gpu::testDevice(), gpu::Checks{.memory_mib = 8});
  ASSERT_TRUE(small) << small.error().message;
  core::Scene scene = smallScene();
  EXPECT_TRUE(WaterSim::create(**small, scene));
  const std::uint64_t made_count = (*small)->ledger().buffers_made_count;
  scene.wave->resolution_count = 512;
  const auto refused = WaterSim::create(**small, scene);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("MB are needed, 8 MB of"), HasSubstr("262144 wave cells")));
  EXPECT_EQ((*small)->ledger().buffers_made_count, made_count);
}

TEST_F(FitsDevice, MoreParticlesThanABufferTakesAreRefusedWithTheNumberThatFits) {
  const std::int64_t most = std::min(ctx_->limits().max_ssbo_bytes / 72, ctx_->limits().max_texel_buffer_elements / 9);
  if (most >= kMaxParticleCount) GTEST_SKIP() << "this device takes the largest number of particles";
  core::Scene scene = smallScene(kMaxParticleCount);
  scene.particles->headroom_m = 0.5;
  const std::uint64_t made_count = ctx_->ledger().buffers_made_count;
  const auto refused = WaterSim::create(*ctx_, scene);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("particles.count: "), HasSubstr("use at most " + std::to_string(most))));
  EXPECT_EQ(ctx_->ledger().buffers_made_count, made_count);
}

}  // namespace
}  // namespace spindrift::sim
