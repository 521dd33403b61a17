#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>

#include "gpu_fixture.h"
#include "program_store.h"
#include "temporary_folder.h"

namespace spindrift::gpu {
namespace {

using testing::HasSubstr;

using ProgramTest = GpuTest;

TEST_F(ProgramTest, CompileErrorNamesFileAndLineOfTheInclude) {
  const auto broken = Program::create(*ctx, "tests/texel_equals_storage.comp", {{"BREAK_ON_REQUEST", "1"}});
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("tests/texel_equals_storage.comp does not compile"));
  EXPECT_THAT(broken.error().message, HasSubstr("tests/block.glsl:10"));
  EXPECT_THAT(broken.error().message, HasSubstr("no_such_name"));
  EXPECT_EQ(ctx->ledger().program_count, 0u);
}

// Kept programs: tests of the files without a driver are in program_store_test.cpp.
TEST(KeptPrograms, AreTakenByTheDriverAndCompiledAgainWhenItRefusesThem) {
  const auto choice = testDevice();
  ASSERT_TRUE(choice);
  const test::TemporaryFolder folder;
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept_before = before ? before : "";
  ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const auto valuesOf = [&](std::int32_t offset) {
    std::vector<std::int32_t> out;
    auto ctx = Context::create(*choice);
    if (!ctx) return out;
    auto program = Program::create(**ctx, "tests/iota.comp", {{"GROUP", "24"}});
    auto values = Buffer::create(**ctx, "values", 4 * 30);
    auto counts = Buffer::create(**ctx, "counts", 8);
    EXPECT_TRUE(program && values && counts);
    values->bindStorage(0);
    counts->bindStorage(1);
    program->setUniform("item_count", 30u);
    program->setUniform("offset", offset);
    EXPECT_TRUE(program->dispatch(30));
    EXPECT_EQ((*ctx)->debugErrorCount(), 0u);
    return out = values->downloadVector<std::int32_t>(30);
  };
  const auto first = valuesOf(1);
  const std::filesystem::path programs = folder.path() / "spindrift" / "programs";
  if (first.empty() || !std::filesystem::exists(programs)) {
    GTEST_SKIP() << "the driver gives no compiled programs (Mesa: only with its own cache of shaders)";
  }
  EXPECT_EQ(valuesOf(1), first);
  for (const auto& entry : std::filesystem::directory_iterator(programs)) {
    // Whole files with the right checksum, of which the driver knows nothing.
    for (const std::uint32_t format : {0u, 0x875Fu}) {
      ProgramStore::Binary nonsense{.format = format, .bytes = std::vector<std::byte>(500, std::byte{42})};
      std::fstream file(entry.path(), std::ios::binary | std::ios::in | std::ios::out);
      const std::uint64_t size_bytes = nonsense.bytes.size();
      const std::uint32_t sum =
          core::crc32c({reinterpret_cast<const std::uint8_t*>(nonsense.bytes.data()), nonsense.bytes.size()});
      file.seekp(24);
      file.write(reinterpret_cast<const char*>(&size_bytes), 8);
      file.write(reinterpret_cast<const char*>(&format), 4);
      file.write(reinterpret_cast<const char*>(&sum), 4);
      file.write(reinterpret_cast<const char*>(nonsense.bytes.data()), 500);
      file.close();
      EXPECT_EQ(valuesOf(1), first);
    }
  }
  before ? ::setenv("XDG_CACHE_HOME", kept_before.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

TEST_F(ProgramTest, RefusesAShaderThatWasNotEmbedded) {
  const auto none = Program::create(*ctx, "tests/none.comp");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("\"tests/none.comp\" is not embedded"));
}

TEST_F(ProgramTest, ReflectsTheGroupSize) {
  const auto wide = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  const auto odd = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "24"}});
  const auto flat = Program::create(*ctx, "tests/texel_equals_storage.comp");
  ASSERT_TRUE(wide && odd && flat);
  EXPECT_EQ(wide->groupSize(), (std::array<std::uint32_t, 3>{64, 1, 1}));
  EXPECT_EQ(odd->groupSize(), (std::array<std::uint32_t, 3>{24, 1, 1}));
  EXPECT_EQ(flat->groupSize(), (std::array<std::uint32_t, 3>{32, 2, 1}));
}

// The threads of zink's compiler are named "<program>:zcfq0" and up; it starts another when programs queue.
TEST_F(ProgramTest, ProgramsAreCompiledOneAfterTheOtherOnZink) {
  if (!ctx->device().name.starts_with("zink")) GTEST_SKIP() << "the device is not zink, but " << ctx->device().name;
  for (int group = 1; group <= 40; ++group) {
    ASSERT_TRUE(Program::create(*ctx, "tests/iota.comp", {{"GROUP", std::to_string(group)}}));
  }
  std::vector<std::string> compilers;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(thread.path() / "comm"), name);
    if (name.find(":zcfq") != std::string::npos) compilers.push_back(name);
  }
  EXPECT_THAT(compilers, testing::SizeIs(1));
}

TEST_F(ProgramTest, DispatchCoversOddSizes) {
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "24"}});
  ASSERT_TRUE(program);
  for (const std::uint32_t count : {1u, 23u, 24u, 25u, 1009u}) {
    auto values = Buffer::create(*ctx, "values", 4 * (count + 8));
    auto counts = Buffer::create(*ctx, "counts", 8);
    ASSERT_TRUE(values && counts);
    values->clear(0xFFFFFFFF);
    values->bindStorage(0);
    counts->bindStorage(1);
    program->setUniform("item_count", count);
    program->setUniform("offset", 5);
    ASSERT_TRUE(program->dispatch(count));
    const auto read = values->downloadVector<std::int32_t>(count + 8);
    for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(read[i], static_cast<std::int32_t>(i) + 5) << count;
    for (std::uint32_t i = count; i < count + 8; ++i) ASSERT_EQ(read[i], -1) << count;
    const std::uint32_t whole_count = (count + 23) / 24 * 24;
    EXPECT_EQ(counts->downloadVector<std::uint32_t>(2), (std::vector<std::uint32_t>{count, whole_count - count}));
  }
}

TEST_F(ProgramTest, DispatchOfNothingRunsNothing) {
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(program);
  EXPECT_TRUE(program->dispatch(0));
  EXPECT_TRUE(program->dispatch(10, 0));
  EXPECT_EQ(ctx->ledger().dispatch_count, 0u);
}

TEST_F(ProgramTest, DispatchOverTheDeviceLimitIsRefusedAndCounted) {
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  ASSERT_TRUE(program);
  const auto over = ctx->limits().max_work_group_count_y + 1;
  EXPECT_FALSE(program->dispatchGroups(1, static_cast<std::uint32_t>(over), 1));
  EXPECT_EQ(ctx->ledger().dispatch_count, 0u);
  expected_error_count = 1;
}

TEST_F(ProgramTest, RunsTheGroupCountsInABuffer) {
  auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  auto values = Buffer::create(*ctx, "values", 4 * 192);
  auto counts = Buffer::create(*ctx, "counts", 8);
  auto arguments = Buffer::create(*ctx, "arguments", 16);
  ASSERT_TRUE(program && values && counts && arguments);
  arguments->upload(std::vector<std::uint32_t>{99, 3, 1, 1});
  values->bindStorage(0);
  counts->bindStorage(1);
  program->setUniform("item_count", 190u);
  program->dispatchIndirect(*arguments, 4);
  EXPECT_EQ(counts->downloadVector<std::uint32_t>(2), (std::vector<std::uint32_t>{190, 2}));
}

TEST_F(ProgramTest, DescribesBlocksAsTheDriverLaidThemOut) {
  const auto program = Program::create(*ctx, "tests/texel_equals_storage.comp");
  ASSERT_TRUE(program);
  const auto blocks = program->blocks();
  ASSERT_TRUE(blocks.contains("Check"));
  const BlockLayout& check = blocks.at("Check");
  EXPECT_FALSE(check.is_storage);
  EXPECT_EQ(check.binding, 0u);
  EXPECT_EQ(check.size_bytes, 64u);
  EXPECT_EQ(check.offsets.at("item_count"), 0u);
  EXPECT_EQ(check.offsets.at("gain"), 4u);
  EXPECT_EQ(check.offsets.at("unused_m"), 16u);
  EXPECT_EQ(check.offsets.at("tail_s[0]"), 32u);
  ASSERT_TRUE(blocks.contains("Differences"));
  EXPECT_TRUE(blocks.at("Differences").is_storage);
  EXPECT_EQ(blocks.at("Differences").binding, 1u);
  EXPECT_EQ(blocks.at("Differences").offsets.at("difference_count"), 0u);
}

TEST_F(ProgramTest, LedgerCountsProgramsAndDispatches) {
  const Ledger& ledger = ctx->ledger();
  {
    auto program = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
    auto values = Buffer::create(*ctx, "values", 256);
    auto counts = Buffer::create(*ctx, "counts", 8);
    ASSERT_TRUE(program && values && counts);
    values->bindStorage(0);
    counts->bindStorage(1);
    EXPECT_EQ(ledger.program_count, 1u);
    Program moved = std::move(*program);
    EXPECT_FALSE(*program);
    EXPECT_EQ(ledger.program_count, 1u);
    moved.setUniform("item_count", 64u);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(moved.dispatch(64));
      ctx->barrier(Barrier::kStorage);
    }
    EXPECT_EQ(ledger.dispatch_count, 3u);
  }
  EXPECT_EQ(ledger.program_count, 0u);
  EXPECT_EQ(ledger.programs_made_count, 1u);
}

}  // namespace
}  // namespace spindrift::gpu
