#include <chrono>
#include <numeric>
#include <thread>

#include <gmock/gmock.h>

#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

using Lease = std::shared_ptr<const ReadbackRing::Slot>;

class ReadbackRingTest : public GpuTest {
 protected:
  /// Copies `size_bytes` of `source` into a slot and submits it.
  void send(ReadbackRing& ring, const Buffer& source, std::size_t size_bytes, std::uint64_t tag) {
    auto slot = ring.begin();
    ASSERT_TRUE(slot);
    ASSERT_TRUE(slot->copyFrom(source, 0, size_bytes, 0));
    slot->submit(tag);
  }
};

std::vector<std::uint32_t> numbers(std::size_t count, std::uint32_t first) {
  std::vector<std::uint32_t> out(count);
  std::iota(out.begin(), out.end(), first);
  return out;
}

TEST_F(ReadbackRingTest, ReturnsCopiesInOrderOfSubmission) {
  auto ring = ReadbackRing::create(*ctx, "frames", 4 * 37 + 3, 3);
  auto source = Buffer::create(*ctx, "source", 4 * 37);
  ASSERT_TRUE(ring && source);
  for (std::uint32_t tag = 1; tag <= 3; ++tag) {
    source->upload(numbers(37, 100 * tag));
    send(**ring, *source, 4 * 37, tag);
  }
  const auto leases = (*ring)->wait(std::chrono::minutes(1));
  ASSERT_EQ(leases.size(), 3u);
  for (std::uint32_t tag = 1; tag <= 3; ++tag) {
    const Lease& lease = leases[tag - 1];
    EXPECT_EQ(lease->tag(), tag);
    EXPECT_EQ(lease->bytes().size(), 4u * 37u);
    EXPECT_EQ(std::vector(lease->words().begin(), lease->words().end()), numbers(37, 100 * tag));
  }
}

TEST_F(ReadbackRingTest, GathersSeveralCopiesAndSeesShaderWrites) {
  constexpr std::uint32_t kCount = 77;
  auto ring = ReadbackRing::create(*ctx, "frames", 4096, 1);
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "24"}});
  auto values = Buffer::create(*ctx, "values", 4 * kCount, BufferUse::kDeviceOnly);
  auto counts = Buffer::create(*ctx, "counts", 8);
  ASSERT_TRUE(ring && program && values && counts);
  values->bindStorage(0);
  counts->bindStorage(1);
  program->setUniform("item_count", kCount);
  program->setUniform("offset", 9);
  ASSERT_TRUE(program->dispatch(kCount));
  {
    auto slot = (*ring)->begin();
    ASSERT_TRUE(slot);
    ASSERT_TRUE(slot->copyFrom(*values, 4, 4 * (kCount - 1), 8));
    ASSERT_TRUE(slot->copyFrom(*counts, 0, 8, 0));
    slot->submit(5);
  }
  const auto leases = (*ring)->wait(std::chrono::minutes(1));
  ASSERT_EQ(leases.size(), 1u);
  const auto words = leases[0]->words();
  ASSERT_EQ(words.size(), kCount + 1);
  EXPECT_EQ(words[0], kCount);
  EXPECT_EQ(words[1], 96 - kCount);
  EXPECT_EQ(std::vector(words.begin() + 2, words.end()), numbers(kCount - 1, 10));
}

TEST_F(ReadbackRingTest, RefusesWhenEverySlotIsInUse) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 2);
  auto source = Buffer::create(*ctx, "source", 64);
  ASSERT_TRUE(ring && source);
  send(**ring, *source, 64, 1);
  send(**ring, *source, 64, 2);
  EXPECT_FALSE((*ring)->begin());
  auto leases = (*ring)->wait(std::chrono::minutes(1));
  ASSERT_EQ(leases.size(), 2u);
  EXPECT_FALSE((*ring)->begin()) << "slots that are being read are not free";
  EXPECT_EQ((*ring)->refusedCount(), 2u);
  EXPECT_EQ((*ring)->usedCount(), 2u);
  leases.pop_back();
  EXPECT_EQ((*ring)->usedCount(), 1u);
  EXPECT_TRUE((*ring)->begin());
}

TEST_F(ReadbackRingTest, KeepsAHeldSlotUntouchedWhileOthersAreReused) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 2);
  auto source = Buffer::create(*ctx, "source", 64);
  ASSERT_TRUE(ring && source);
  source->upload(numbers(16, 1000));
  send(**ring, *source, 64, 0);
  auto held = (*ring)->wait(std::chrono::minutes(1));
  ASSERT_EQ(held.size(), 1u);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    source->upload(numbers(16, i));
    send(**ring, *source, 64, i);
    const auto leases = (*ring)->wait(std::chrono::minutes(1));
    ASSERT_EQ(leases.size(), 1u);
    EXPECT_EQ(leases[0]->words()[0], i);
  }
  EXPECT_EQ(std::vector(held[0]->words().begin(), held[0]->words().end()), numbers(16, 1000));
}

TEST_F(ReadbackRingTest, IsFreedByTheLastReferenceOnAnotherThread) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 1);
  auto source = Buffer::create(*ctx, "source", 64);
  ASSERT_TRUE(ring && source);
  source->upload(numbers(16, 7));
  send(**ring, *source, 64, 1);
  std::uint32_t sum = 0;
  {
    auto leases = (*ring)->wait(std::chrono::minutes(1));
    ASSERT_EQ(leases.size(), 1u);
    std::thread reader([lease = std::move(leases[0]), &sum]() mutable {
      const Lease copy = lease;
      lease.reset();
      for (const std::uint32_t word : copy->words()) sum += word;
    });
    EXPECT_TRUE(leases[0] == nullptr);
    reader.join();
  }
  EXPECT_EQ(sum, 16u * 7u + 120u);
  EXPECT_EQ((*ring)->usedCount(), 0u);
  EXPECT_TRUE((*ring)->begin());
}

TEST_F(ReadbackRingTest, ARecordingThatIsDroppedFreesItsSlot) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 1);
  ASSERT_TRUE(ring);
  {
    const auto slot = (*ring)->begin();
    ASSERT_TRUE(slot);
    EXPECT_EQ((*ring)->usedCount(), 1u);
  }
  EXPECT_EQ((*ring)->usedCount(), 0u);
  EXPECT_TRUE((*ring)->wait(std::chrono::minutes(1)).empty());
}

TEST_F(ReadbackRingTest, RefusesCopiesThatDoNotFit) {
  auto ring = ReadbackRing::create(*ctx, "frames", 64, 1);
  auto source = Buffer::create(*ctx, "source", 100);
  ASSERT_TRUE(ring && source);
  auto slot = (*ring)->begin();
  ASSERT_TRUE(slot);
  EXPECT_FALSE(slot->copyFrom(*source, 0, 65, 0));
  EXPECT_FALSE(slot->copyFrom(*source, 0, 60, 5));
  EXPECT_FALSE(slot->copyFrom(*source, 80, 21, 0));
  EXPECT_FALSE(slot->copyFrom(*source, 101, 0, 0));
  EXPECT_FALSE(slot->copyFrom(*source, static_cast<std::size_t>(-1), 2, 0));
  EXPECT_TRUE(slot->copyFrom(*source, 80, 20, 44));
}

TEST_F(ReadbackRingTest, AViewOutlivesItsRing) {
  auto source = Buffer::create(*ctx, "source", 64);
  ASSERT_TRUE(source);
  source->upload(numbers(16, 3));
  std::vector<Lease> leases;
  {
    auto ring = ReadbackRing::create(*ctx, "frames", 64, 2);
    ASSERT_TRUE(ring);
    send(**ring, *source, 64, 1);
    leases = (*ring)->wait(std::chrono::minutes(1));
    ASSERT_EQ(leases.size(), 1u);
    send(**ring, *source, 64, 2);  // still in flight when the ring is destroyed
  }
  EXPECT_EQ(std::vector(leases[0]->words().begin(), leases[0]->words().end()), numbers(16, 3));
  EXPECT_EQ(ctx->ledger().buffer_count, 2u);
  leases.clear();
  ctx->collectRetired();
  EXPECT_EQ(ctx->ledger().buffer_count, 1u);
  EXPECT_EQ(ctx->ledger().buffer_bytes, 64u);
}

TEST_F(ReadbackRingTest, RefusesAnEmptyRing) {
  for (const auto& [bytes, count] : {std::pair<std::size_t, std::size_t>{0, 3}, {64, 0}}) {
    const auto ring = ReadbackRing::create(*ctx, "empty", bytes, count);
    ASSERT_FALSE(ring);
    EXPECT_EQ(ring.error().code, core::ErrorCode::kInvalidInput);
    EXPECT_THAT(ring.error().message, testing::HasSubstr("\"empty\""));
  }
  EXPECT_EQ(ctx->ledger().buffer_count, 0u);
}

}  // namespace
}  // namespace spindrift::gpu
