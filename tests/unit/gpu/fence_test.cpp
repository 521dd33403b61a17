// Fences, fences that a test holds back, and the loss of the device.
#include <chrono>
#include <numeric>

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
  EXPECT_EQ(fence.wait(kLimit), FenceState::kPassed);
  EXPECT_EQ(fence.poll(), FenceState::kPassed) << "an answer is final";
  Fence moved = std::move(fence);
  EXPECT_EQ(moved.poll(), FenceState::kPassed);
  EXPECT_EQ(Fence().poll(), FenceState::kPassed) << "there is nothing to wait for";
}

TEST_F(FenceTest, IsHeldForTheNumberOfPollsThatATestAsksFor) {
  ctx->holdFences(3);
  Fence fence = Fence::insert(*ctx);
  ctx->finish();
  for (int poll = 0; poll < 3; ++poll) EXPECT_EQ(fence.poll(), FenceState::kPending) << poll;
  EXPECT_EQ(fence.wait(kLimit), FenceState::kPassed);
  Fence waited = Fence::insert(*ctx);
  EXPECT_EQ(waited.wait(kLimit), FenceState::kPassed) << "a wait does not care";
  ctx->holdFences(0);
  Fence prompt = Fence::insert(*ctx);
  EXPECT_EQ(prompt.wait(kLimit), FenceState::kPassed);
}

TEST_F(FenceTest, HeldFencesDelayFramesByPollsWithoutReorderingThem) {
  ctx->holdFences(2);
  auto ring = ReadbackRing::create(*ctx, "frames", 4, 4);
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
    most_in_flight = std::max(most_in_flight, (*ring)->usedCount());
    for (const auto& lease : (*ring)->poll()) tags.push_back(lease->tag());
  }
  for (const auto& lease : (*ring)->wait(kLimit)) tags.push_back(lease->tag());
  std::vector<std::uint64_t> expected(20);
  std::iota(expected.begin(), expected.end(), 1u);
  EXPECT_EQ(tags, expected);
  EXPECT_GE(most_in_flight, 3u) << "a frame is handed out in the third poll at the earliest";
}

TEST_F(DeviceLossTest, IsNotReportedByAHealthyDevice) {
  EXPECT_FALSE(ctx->isLost());
  EXPECT_FALSE(ctx->wasLost());
  EXPECT_TRUE(ctx->device().tells_of_resets) << "llvmpipe and zink accept the reset notification";
}

TEST_F(DeviceLossTest, StaysReportedAndEndsFences) {
  Fence before = Fence::insert(*ctx);
  ctx->holdFences(1000);
  Fence held = Fence::insert(*ctx);
  ctx->simulateLoss();
  EXPECT_TRUE(ctx->isLost());
  EXPECT_TRUE(ctx->wasLost());
  EXPECT_EQ(before.poll(), FenceState::kLost) << "on a lost device fences look as if they were passed";
  EXPECT_EQ(held.poll(), FenceState::kLost);
  EXPECT_EQ(Fence::insert(*ctx).wait(kLimit), FenceState::kLost);
  EXPECT_TRUE(ctx->isLost());
}

TEST_F(DeviceLossTest, FreesTheSlotsInFlightInsteadOfHandingOutWhatTheyHold) {
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

TEST_F(DeviceLossTest, DownloadsGiveZerosAndObjectsCanStillBeMadeAndDropped) {
  auto buffer = Buffer::create(*ctx, "before", 64);
  auto program = Program::create(*ctx, "check/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(buffer && program);
  buffer->clear(0x55555555);
  ctx->simulateLoss();
  EXPECT_THAT(buffer->downloadVector<std::uint32_t>(16), Each(0u));
  buffer->upload(std::vector<std::uint32_t>(16, 1));
  (void)Buffer::create(*ctx, "after", 64);
  (void)ReadbackRing::create(*ctx, "after", 64, 1);
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
