// Poisoned scratch buffers, another order of work groups, programs that are shared.
#include <numeric>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/gpu/program.h>

#include "gpu_fixture.h"
#include "log_capture.h"

namespace spindrift::gpu {
namespace {

using testing::Each;
using testing::HasSubstr;

class TestModes : public testing::Test {
 protected:
  void make(const Checks& checks) {
    auto made = Context::create(*testDevice(), checks);
    if (!made) GTEST_SKIP() << made.error().message;
    ctx = std::move(*made);
  }
  std::unique_ptr<Context> ctx;
};

TEST_F(TestModes, PoisonFillsScratchBuffersAndNoOthers) {
  make({.poison = true});
  if (!ctx) return;
  auto scratch = TexelBuffer::create(*ctx, "scratch", 7, TexelFormat::kR32F, BufferContent::kScratch);
  auto odd = Buffer::create(*ctx, "odd", 7, BufferUse::kDeviceOnly, BufferContent::kScratch);
  auto state = Buffer::create(*ctx, "state", 28);
  ASSERT_TRUE(scratch && odd && state);
  EXPECT_THAT(scratch->downloadVector<std::uint32_t>(7), Each(0xffffffffu));
  EXPECT_THAT(odd->downloadVector<std::uint8_t>(7), Each(0xff));
  EXPECT_THAT(state->downloadVector<std::uint32_t>(7), Each(0u));
  scratch->clear();
  ctx->poisonScratch();
  EXPECT_THAT(scratch->downloadVector<std::uint32_t>(7), Each(0xffffffffu));
  EXPECT_THAT(state->downloadVector<std::uint32_t>(7), Each(0u));
}

TEST_F(TestModes, ScratchBuffersAreZeroWithoutPoison) {
  make({});
  if (!ctx) return;
  const auto scratch = Buffer::create(*ctx, "scratch", 28, BufferUse::kDeviceOnly, BufferContent::kScratch);
  ASSERT_TRUE(scratch);
  EXPECT_THAT(scratch->downloadVector<std::uint32_t>(7), Each(0u));
}

TEST_F(TestModes, ShuffledGroupsCoverEveryInvocationOnce) {
  for (const std::uint32_t seed : {1u, 2u, 7u, 1000u}) {
    make({.shuffle_seed = seed});
    if (!ctx) return;
    auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "24"}});
    ASSERT_TRUE(program) << program.error().message;
    // The last count is a multiple of the factor, so that 1 replaces the factor.
    for (const std::uint32_t count : {1u, 24u, 25u, 1009u, 24u * 7919u}) {
      auto values = Buffer::create(*ctx, "values", 4 * count);
      auto counts = Buffer::create(*ctx, "counts", 8);
      ASSERT_TRUE(values && counts);
      values->clear(0xffffffff);
      values->bindStorage(0);
      counts->bindStorage(1);
      program->setUniform("item_count", count);
      ASSERT_TRUE(program->dispatch(count));
      std::vector<std::int32_t> expected(count);
      std::iota(expected.begin(), expected.end(), 0);
      EXPECT_EQ(values->downloadVector<std::int32_t>(count), expected) << "seed " << seed;
      EXPECT_EQ(counts->downloadVector<std::uint32_t>(1)[0], count);
    }
  }
}

TEST_F(TestModes, ShuffledGroupsRunInAnotherOrder) {
  constexpr std::uint32_t kGroups = 100;
  // Counts the groups g for which g + 1 ran later.
  const auto ascendingCount = [&](std::uint32_t seed) -> std::uint32_t {
    make({.shuffle_seed = seed});
    if (!ctx) return 0;
    auto program = Program::create(*ctx, "tests/group_order.comp");
    auto order = Buffer::create(*ctx, "order", 4 * (1 + kGroups));
    EXPECT_TRUE(program && order);
    order->bindStorage(0);
    EXPECT_TRUE(program->dispatchGroups(kGroups));
    const auto seen = order->downloadVector<std::uint32_t>(1 + kGroups);
    EXPECT_EQ(seen[0], kGroups);
    std::vector<std::optional<std::size_t>> place(kGroups);
    for (std::size_t k = 1; k <= kGroups; ++k) {
      EXPECT_LT(seen[k], kGroups);
      EXPECT_FALSE(place.at(seen[k])) << "each number once";
      place.at(seen[k]) = k;
    }
    std::uint32_t count = 0;
    for (std::size_t g = 0; g + 1 < kGroups; ++g) count += *place[g] < *place[g + 1] ? 1 : 0;
    return count;
  };
  if (const std::uint32_t plain_count = ascendingCount(0); ctx) {
    // Each of a CPU's threads runs its groups in ascending order, whatever the schedule of the threads; a GPU runs them
    // at once.
    if (ctx->device().is_software) {
      EXPECT_GE(plain_count, 90u);
    }
    EXPECT_LE(ascendingCount(55), 75u);
  }
}

TEST_F(TestModes, TimesOfProgramsAreLoggedAtTheEnd) {
  make({.times = true});
  if (!ctx) return;
  {
    auto program = Program::create(*ctx, "tests/group_order.comp");
    auto order = Buffer::create(*ctx, "order", 4 * (1 + 3));
    ASSERT_TRUE(program && order);
    order->bindStorage(0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(program->dispatchGroups(1));
      ctx->barrier(Barrier::kStorage);
    }
  }
  const test::LogCapture log;
  ctx.reset();
  EXPECT_THAT(log.text(), HasSubstr("100.0 % tests/group_order.comp: 3 dispatches of "));
}

TEST_F(TestModes, CompileErrorsOfShuffledShadersNameTheirLines) {
  make({.shuffle_seed = 5});
  if (!ctx) return;
  const auto broken = Program::create(*ctx, "tests/texel_equals_storage.comp", {{"BREAK_ON_REQUEST", "1"}});
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("tests/block.glsl:10"));
}

using ProgramCacheTest = GpuTest;

TEST_F(ProgramCacheTest, AVariantIsCompiledOncePerContext) {
  const Ledger& ledger = ctx->ledger();
  {
    const auto first = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
    const auto second = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
    const auto other = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "24"}});
    const auto same = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}, {"GROUP_UNUSED", "1"}, {"ROUP", "1"}});
    ASSERT_TRUE(first && second && other && same);
    EXPECT_EQ(ledger.programs_made_count, 2u) << "a define that the shader does not use makes no other program";
    EXPECT_EQ(ledger.program_count, 4u);
    EXPECT_EQ(first->id(), second->id());
    EXPECT_EQ(first->id(), same->id());
    EXPECT_NE(first->id(), other->id());
  }
  EXPECT_EQ(ledger.program_count, 0u);
  const auto again = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(again);
  EXPECT_EQ(ledger.programs_made_count, 2u) << "kept for the next room";
  auto beside = Context::create(*testDevice());
  ASSERT_TRUE(beside);
  {
    const auto elsewhere = Program::create(**beside, "tests/iota.comp", {{"GROUP", "64"}});
    ASSERT_TRUE(elsewhere);
    EXPECT_EQ((*beside)->ledger().programs_made_count, 1u) << "contexts share nothing";
  }
  beside->reset();
  ASSERT_TRUE(ctx->makeCurrent());
}

TEST_F(ProgramCacheTest, AnErrorIsNotKept) {
  for (int i = 0; i < 2; ++i) {
    const auto broken = Program::create(*ctx, "tests/texel_equals_storage.comp", {{"BREAK_ON_REQUEST", "1"}});
    ASSERT_FALSE(broken);
    EXPECT_THAT(broken.error().message, HasSubstr("no_such_name"));
  }
}

TEST_F(ProgramCacheTest, SharedProgramsKeepTheirOwnUniforms) {
  auto values = Buffer::create(*ctx, "values", 16);
  auto counts = Buffer::create(*ctx, "counts", 8);
  auto ten = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  auto zero = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(values && counts && ten && zero);
  values->bindStorage(0);
  counts->bindStorage(1);
  ten->setUniform("item_count", 4u);
  ten->setUniform("offset", 10);
  zero->setUniform("item_count", 4u);  // its offset was not set, so it is zero
  const auto first = [&](Program& program) {
    EXPECT_TRUE(program.dispatch(4));
    ctx->barrier(Barrier::kStorage);
    return values->downloadVector<std::int32_t>(1)[0];
  };
  EXPECT_EQ(first(*ten), 10);
  EXPECT_EQ(first(*zero), 0);
  EXPECT_EQ(first(*ten), 10);
  zero->setUniform("offset", 7);
  EXPECT_EQ(first(*ten), 10);
  EXPECT_EQ(first(*zero), 7);
  Program moved = std::move(*ten);
  EXPECT_EQ(first(moved), 10);
}

}  // namespace
}  // namespace spindrift::gpu
