// Fences, fences that a test holds back, and the loss of the device.
#include <chrono>
#include <numeric>
#include <utility>

#include <gmock/gmock.h>

#include <spindrift/gpu/fence.h>
#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

using testing::Each;
using FenceTest = GpuTest;
using DeviceLossTest = GpuTest;

constexpr std::chrono::seconds kLimit{60};

TEST_F(FenceTest, IsPassedOnceTheWorkBeforeItIsDone) {
  auto buffer = Buffer::create(*ctx, "work", 1 << 20);
  ASSERT_TRUE(buffer);
  buffer->clear(7);
  Fence fence = Fence::insert(*ctx);
  EXPECT_EQ(fence.wait(kLimit), Fence::Status::kPassed);
  EXPECT_EQ(fence.poll(), Fence::Status::kPassed) << "an answer is final";
  Fence moved = std::move(fence);
  EXPECT_EQ(moved.poll(), Fence::Status::kPassed);
  EXPECT_EQ(Fence().poll(), Fence::Status::kPassed) << "there is nothing to wait for";
}

TEST_F(FenceTest, WaitLetsASlowDeviceCatchUp) {
  ctx->fenceDelay().set(3);
  std::vector<Fence> fences;
  for (int i = 0; i < 5; ++i) fences.push_back(Fence::insert(*ctx));
  ctx->finish();
  EXPECT_EQ(fences[1].wait(kLimit), Fence::Status::kPassed);
  EXPECT_EQ(fences[0].poll(), Fence::Status::kPassed);
  EXPECT_EQ(fences[2].poll(), Fence::Status::kPending);
  EXPECT_EQ(fences[3].wait(kLimit), Fence::Status::kPassed);
  EXPECT_EQ(fences[4].poll(), Fence::Status::kPending);
  ctx->fenceDelay().set(FenceDelay::kForever);
  EXPECT_EQ(fences[4].wait(kLimit), Fence::Status::kPending) << "a device that hangs; the wait is not sat out";
  ctx->fenceDelay().set(0);
  EXPECT_EQ(fences[4].wait(kLimit), Fence::Status::kPassed);
}

TEST_F(FenceTest, ASlowDeviceDelaysFramesWithoutReorderingThem) {
  ctx->fenceDelay().set(2);
  constexpr std::size_t kSlotCount = 4;
  auto ring = ReadbackRing::create(*ctx, "frames", 4, kSlotCount);
  auto source = Buffer::create(*ctx, "source", 4);
  ASSERT_TRUE(ring && source);
  std::vector<std::uint64_t> tags;
  std::size_t most_in_flight = 0;
  for (std::uint64_t tick = 1; tick <= 20; ++tick) {
    auto slot = (*ring)->begin();
    ASSERT_TRUE(slot) << tick;
    ASSERT_TRUE(slot->copyFrom(*source, 0, 4, 0));
    slot->submit(tick);
    ctx->finish();
    for (const auto& lease : (*ring)->poll()) tags.push_back(lease->tag());
    most_in_flight = std::max(most_in_flight, (*ring)->usedCount());
    if ((*ring)->usedCount() == kSlotCount) {  // an asynchronous driver may report completion later
      for (const auto& lease : (*ring)->wait(std::chrono::minutes(1))) tags.push_back(lease->tag());
    }
  }
  for (const auto& lease : (*ring)->wait(std::chrono::minutes(1))) tags.push_back(lease->tag());
  std::vector<std::uint64_t> expected(20);
  std::iota(expected.begin(), expected.end(), 1u);
  EXPECT_EQ(tags, expected);
  EXPECT_GE(most_in_flight, 2u);
}

TEST_F(DeviceLossTest, IsNotReportedByAHealthyDevice) {
  EXPECT_FALSE(ctx->isLost());
  EXPECT_FALSE(ctx->wasLost());
  EXPECT_TRUE(ctx->device().tells_of_resets) << "llvmpipe and zink accept the reset notification";
}

TEST_F(DeviceLossTest, StaysReportedAndEndsFences) {
  Fence before = Fence::insert(*ctx);
  ctx->fenceDelay().set(FenceDelay::kForever);
  Fence held = Fence::insert(*ctx);
  ctx->simulateLoss();
  EXPECT_TRUE(ctx->isLost());
  EXPECT_TRUE(ctx->wasLost());
  EXPECT_EQ(before.poll(), Fence::Status::kFailed) << "on a lost device fences look as if they were passed";
  EXPECT_EQ(held.poll(), Fence::Status::kFailed);
  EXPECT_EQ(Fence::insert(*ctx).wait(kLimit), Fence::Status::kFailed);
  EXPECT_TRUE(ctx->isLost());
}

TEST_F(DeviceLossTest, FreesTheSlotsInFlightWithoutReturningThem) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 2);
  auto source = Buffer::create(*ctx, "source", 64);
  ASSERT_TRUE(ring && source);
  for (std::uint64_t tag = 1; tag <= 2; ++tag) {
    auto slot = (*ring)->begin();
    ASSERT_TRUE(slot);
    ASSERT_TRUE(slot->copyFrom(*source, 0, 64, 0));
    slot->submit(tag);
  }
  ctx->simulateLoss();
  EXPECT_TRUE((*ring)->poll().empty());
  EXPECT_EQ((*ring)->lostCount(), 2u);
  EXPECT_EQ((*ring)->usedCount(), 0u);
}

TEST_F(DeviceLossTest, DownloadsGiveZeros) {
  auto buffer = Buffer::create(*ctx, "before", 64);
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(buffer && program);
  buffer->clear(0x55555555);
  ctx->simulateLoss();
  EXPECT_THAT(buffer->downloadVector<std::uint32_t>(16), Each(0u));
  buffer->upload(std::vector<std::uint32_t>(16, 1));
  (void)Buffer::create(*ctx, "after", 64);
  (void)ReadbackRing::create(*ctx, "after", 64, 1);
}

/// Replaces an OpenGL function to imitate a driver; restores it at the end.
template <typename Function>
class Replaced {
 public:
  Replaced(Function& function, Function by) : function_(function), before_(std::exchange(function, by)) {}
  ~Replaced() { function_ = before_; }
  Replaced(const Replaced&) = delete;
  Replaced& operator=(const Replaced&) = delete;

 private:
  Function& function_;
  Function before_;
};

TEST_F(DeviceLossTest, AResetThatTheDriverReportsIsALoss) {
  const Replaced reset(
      glad_glGetGraphicsResetStatus, +[]() -> GLenum { return GL_GUILTY_CONTEXT_RESET; });
  EXPECT_FALSE(ctx->wasLost());
  EXPECT_TRUE(ctx->isLost());
  EXPECT_TRUE(ctx->wasLost());
}

TEST_F(DeviceLossTest, AWaitForAFenceEndsWithTheResetOfTheDevice) {
  static int asked = 0;
  asked = 0;
  // A hang: no fence is passed, and after some waits the driver resets the device.
  const Replaced hang(
      glad_glClientWaitSync, +[](GLsync, GLbitfield, GLuint64) -> GLenum { return GL_TIMEOUT_EXPIRED; });
  const Replaced reset(
      glad_glGetGraphicsResetStatus,
      +[]() -> GLenum { return ++asked > 5 ? GLenum{GL_INNOCENT_CONTEXT_RESET} : GLenum{GL_NO_ERROR}; });
  Fence fence = Fence::insert(*ctx);
  EXPECT_EQ(fence.wait(std::chrono::hours(24)), Fence::Status::kFailed);
  EXPECT_EQ(asked, 6);
}

TEST_F(DeviceLossTest, WaitForAFenceEndsWithItsLimit) {
  static int slices = 0;
  slices = 0;
  const Replaced hang(
      glad_glClientWaitSync, +[](GLsync, GLbitfield, GLuint64) -> GLenum { return ++slices, GL_TIMEOUT_EXPIRED; });
  Fence fence = Fence::insert(*ctx);
  EXPECT_EQ(fence.wait(std::chrono::seconds(3)), Fence::Status::kPending);
  EXPECT_EQ(slices, 30) << "of 100 ms each, that a reset is noticed";
}

TEST_F(DeviceLossTest, AnErrorThatNeverEndsDoesNotHang) {
  constexpr GLenum kContextLost = 0x0507;
  const Replaced endless(
      glad_glGetError, +[]() -> GLenum { return kContextLost; });
  const auto buffer = Buffer::create(*ctx, "after the loss", 64);
  ASSERT_FALSE(buffer);
  EXPECT_THAT(buffer.error().message, testing::HasSubstr("OpenGL error 1287"));
  (void)ReadbackRing::create(*ctx, "after the loss", 64, 1);
}

TEST_F(DeviceLossTest, ANewContextWorksBesideALostOne) {
  ctx->simulateLoss();
  auto fresh = Context::create(*testDevice());
  ASSERT_TRUE(fresh) << fresh.error().message;
  EXPECT_FALSE((*fresh)->isLost());
  auto buffer = Buffer::create(**fresh, "fresh", 4);
  ASSERT_TRUE(buffer);
  buffer->uploadValue(std::uint32_t{17});
  EXPECT_EQ(buffer->downloadVector<std::uint32_t>(1)[0], 17u);
}

}  // namespace
}  // namespace spindrift::gpu
