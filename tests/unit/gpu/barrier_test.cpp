// The barriers that Buffer issues, and the checker that reports those that callers forget.
#include <functional>

#include <gmock/gmock.h>

#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint32_t kBarrierCount = 256;

/// Layout of the block in shaders/tests/block.glsl.
struct BarrierBlock {
  std::uint32_t item_count = kBarrierCount / 4;
  float gain = 1.0f;
  float rest[14] = {};
};

/// A program that writes "values" and one that compares them, as texels and as storage, under the checker.
class BarrierTest : public GpuTest {
 protected:
  void SetUp() override {
    const auto choice = testDevice();
    ASSERT_TRUE(choice) << choice.error().message;
    auto made = Context::create(*choice, Checks{.barriers = true});
    if (!made) GTEST_SKIP() << made.error().message;
    ctx = std::move(*made);
    take(values, TexelBuffer::create(*ctx, "values", kBarrierCount / 4, TexelFormat::kRGBA32F));
    take(counts, Buffer::create(*ctx, "counts", 8));
    take(differences, Buffer::create(*ctx, "differences", 4));
    take(block, Buffer::create(*ctx, "block", sizeof(BarrierBlock), BufferUse::kUpdatable));
    take(write, Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}}));
    take(compare, Program::create(*ctx, "tests/texel_equals_storage.comp"));
    block.uploadValue(BarrierBlock{});
    write.setUniform("item_count", kBarrierCount);
    ctx->barrier(kAll);
    (void)ctx->takeFaults();
  }
  void TearDown() override {
    values = {};
    counts = {};
    differences = {};
    block = {};
    write = {};
    compare = {};
    GpuTest::TearDown();
  }

  template <typename T>
  static void take(T& target, core::Result<T> made) {
    ASSERT_TRUE(made) << made.error().message;
    target = std::move(*made);
  }

  void runWrite() {
    values.bindStorage(0);
    counts.bindStorage(1);
    ASSERT_TRUE(write.dispatch(kBarrierCount));
  }
  void runCompare() {
    block.bindUniform(0);
    values.bindTexel(3);
    values.bindStorage(0);
    differences.bindStorage(1);
    ASSERT_TRUE(compare.dispatch(64, 1));
  }
  std::uint64_t barriersOf(const std::function<void()>& work) {
    const std::uint64_t before = ctx->ledger().barrier_count;
    work();
    return ctx->ledger().barrier_count - before;
  }

  static constexpr Barrier kAll =
      Barrier::kStorageAndTexel | Barrier::kUniform | Barrier::kIndirect | Barrier::kBufferUpdate;
  TexelBuffer values;
  Buffer counts, differences, block;
  Program write, compare;
};

TEST_F(BarrierTest, MissingBarrierIsReportedWithItsPrograms) {
  runWrite();
  ctx->barrier(Barrier::kStorage);  // no barrier for the texels
  runCompare();
  EXPECT_THAT(ctx->takeFaults(), ElementsAre(AllOf(HasSubstr("tests/texel_equals_storage.comp reads buffer \"values\""),
                                                   HasSubstr("tests/iota.comp"), HasSubstr("Barrier::kTexel"))));
  runWrite();
  ctx->barrier(Barrier::kTexel);  // no barrier for the storage, neither for reads nor for writes
  runCompare();
  EXPECT_THAT(ctx->takeFaults(), testing::Contains(AllOf(HasSubstr("texel_equals_storage.comp reads buffer \"values\""),
                                                         HasSubstr("Barrier::kStorage"))));
}

TEST_F(BarrierTest, PassesWithTheirBarriersAreNoFault) {
  for (int round = 0; round < 3; ++round) {
    runWrite();
    ctx->barrier(Barrier::kStorageAndTexel);
    runCompare();
    ctx->barrier(Barrier::kStorageAndTexel);
  }
  EXPECT_THAT(ctx->takeFaults(), IsEmpty());
}

TEST_F(BarrierTest, StoreToABufferInUseIsAFault) {
  runCompare();
  runWrite();
  EXPECT_THAT(ctx->takeFaults(),
              ElementsAre(AllOf(HasSubstr("tests/iota.comp writes buffer \"values\""), HasSubstr("may still read"))));
}

TEST_F(BarrierTest, ADisjointWriteIsDeclaredInsteadOfSeparated) {
  values.declareDisjointWrites();
  counts.declareDisjointWrites();
  runWrite();
  runWrite();
  EXPECT_THAT(ctx->takeFaults(), IsEmpty());
}

TEST_F(BarrierTest, WrittenGroupCountsNeedACommandBarrier) {
  auto arguments = Buffer::create(*ctx, "arguments", 4 * kBarrierCount);
  ASSERT_TRUE(arguments);
  arguments->bindStorage(0);
  counts.bindStorage(1);
  write.setUniform("offset", 1);
  write.setUniform("item_count", 3u);
  ASSERT_TRUE(write.dispatch(3));  // 1, 2, 3 groups
  ctx->barrier(Barrier::kStorageAndTexel);
  values.bindStorage(0);
  write.dispatchIndirect(*arguments);
  EXPECT_THAT(ctx->takeFaults(), ElementsAre(AllOf(HasSubstr("arguments"), HasSubstr("Barrier::kIndirect"))));
}

TEST_F(BarrierTest, MissingBufferAndLargeBlockAreFaults) {
  differences = {};
  values.bindTexel(3);
  values.bindStorage(0);
  block.bindUniform(0);
  auto gone = Buffer::create(*ctx, "gone", 4);
  ASSERT_TRUE(gone);
  gone->bindStorage(1);
  *gone = {};
  ASSERT_TRUE(compare.dispatch(64, 1));
  EXPECT_THAT(ctx->takeFaults(), ElementsAre(HasSubstr("storage binding 1 (Differences), where no buffer is bound")));
  take(differences, Buffer::create(*ctx, "differences", 4));
  differences.bindStorage(1);
  auto small = Buffer::create(*ctx, "small block", sizeof(BarrierBlock) - 8, BufferUse::kUpdatable);
  ASSERT_TRUE(small);
  small->bindUniform(0);
  ASSERT_TRUE(compare.dispatch(64, 1));
  EXPECT_THAT(ctx->takeFaults(), ElementsAre(AllOf(HasSubstr("the uniform block Check has 64 bytes"),
                                                   HasSubstr("\"small block\" bound to it only 56"))));
}

TEST_F(BarrierTest, ApiOperationsIssueTheirOwnBarriers) {
  auto other = Buffer::create(*ctx, "other", values.sizeBytes());
  auto ring = ReadbackRing::create(*ctx, "ring", values.sizeBytes(), 1);
  ASSERT_TRUE(other && ring);
  const auto zeros = std::vector<std::int32_t>(kBarrierCount, 0);
  const std::vector<std::pair<const char*, std::function<void()>>> operations = {
      {"download", [&] { (void)values.downloadVector<std::int32_t>(kBarrierCount); }},
      {"upload", [&] { values.upload(zeros); }},
      {"clear", [&] { values.clear(); }},
      {"copy from", [&] { other->copyFrom(values, 0, values.sizeBytes()); }},
      {"copy to", [&] { values.copyFrom(*other, 0, values.sizeBytes()); }},
      {"readback", [&] {
         auto slot = (*ring)->begin();
         ASSERT_TRUE(slot);
         ASSERT_TRUE(slot->copyFrom(values, 0, values.sizeBytes(), 0));
       }}};
  for (const auto& [name, operation] : operations) {
    ctx->barrier(kAll);
    runWrite();
    EXPECT_EQ(barriersOf(operation), 1u) << name << " after a shader wrote";
    EXPECT_EQ(barriersOf(operation), 0u) << name << ": nothing happened since";
    EXPECT_EQ(barriersOf([&] { runCompare(); }),
              name == std::string("download") || name == std::string("copy from") || name == std::string("readback")
                  ? 0u
                  : 1u)
        << name << " before a shader reads";
    ctx->barrier(kAll);
    operation();
    EXPECT_EQ(barriersOf([&] { runWrite(); }), 1u) << name << " before a shader writes";
    (void)ctx->takeFaults();  // counts are written twice in a row here
  }
}

TEST_F(BarrierTest, UpdatesOfAUniformBlockNeedNoBarrier) {
  runCompare();
  ctx->barrier(kAll);
  EXPECT_EQ(barriersOf([&] {
              for (int i = 0; i < 4; ++i) {
                block.uploadValue(BarrierBlock{});
                runCompare();
                ctx->barrier(Barrier::kStorage);
              }
            }),
            4u)
      << "only the test's own";
}

TEST_F(BarrierTest, FaultsAreReportedOnceAndBounded) {
  for (int round = 0; round < 200; ++round) runWrite();
  EXPECT_THAT(ctx->takeFaults(), SizeIs(testing::Le(4u)));
  EXPECT_THAT(ctx->takeFaults(), IsEmpty());
}

TEST(BarrierDeathTest, UntakenFaultsEndTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto forget = [] {
    auto ctx = Context::create(*testDevice(), Checks{.barriers = true});
    if (!ctx) return;
    {
      auto program = Program::create(**ctx, "tests/iota.comp", {{"GROUP", "64"}});
      auto values = Buffer::create(**ctx, "values", 256);
      auto counts = Buffer::create(**ctx, "counts", 8);
      values->bindStorage(0);
      counts->bindStorage(1);
      (void)program->dispatch(64);
      (void)program->dispatch(64);
    }
    ctx->reset();
  };
  if (!Context::create(*testDevice())) GTEST_SKIP() << "no device";
  EXPECT_DEATH(forget(), "");
}

TEST(Checks, ReadsTheModesOfTheEnvironment) {
  const auto none = parseChecks("");
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->barriers || none->poison || none->times || none->shuffle_seed || none->lag_fences_count ||
               none->memory_mib);
  const auto all = parseChecks("barriers,poison,times,shuffle=7,lag=3,memory=64");
  ASSERT_TRUE(all);
  EXPECT_TRUE(all->barriers && all->poison && all->times);
  EXPECT_EQ(all->shuffle_seed, 7u);
  EXPECT_EQ(all->lag_fences_count, 3u);
  EXPECT_EQ(all->memory_mib, 64u);
  for (const char* text : {"barrier", "shuffle", "shuffle=", "shuffle=0", "shuffle=1000001", "shuffle=x", "poison=1",
                           "lag=-1", "lag=10001", "memory=0", "memory", " barriers"}) {
    const auto wrong = parseChecks(text);
    ASSERT_FALSE(wrong) << text;
    EXPECT_THAT(wrong.error().message, HasSubstr(std::string("\"") + text + "\""));
  }
}

}  // namespace
}  // namespace spindrift::gpu
