#include <array>
#include <numeric>

#include <gmock/gmock.h>

#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

using testing::Each;
using testing::HasSubstr;

using BufferTest = GpuTest;

std::vector<std::uint8_t> ramp(std::size_t count) {
  std::vector<std::uint8_t> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::uint8_t>(i * 37 + 11);
  return out;
}

TEST_F(BufferTest, ReturnsUploadedDataAtOddSizes) {
  for (const std::size_t size : {1u, 3u, 4u, 17u, 4099u, 65537u}) {
    auto buffer = Buffer::create(*ctx, "odd", size);
    ASSERT_TRUE(buffer) << buffer.error().message;
    EXPECT_EQ(buffer->sizeBytes(), size);
    EXPECT_THAT(buffer->downloadVector<std::uint8_t>(size), Each(0));
    buffer->upload(ramp(size));
    EXPECT_EQ(buffer->downloadVector<std::uint8_t>(size), ramp(size));
  }
}

TEST_F(BufferTest, UploadsAndDownloadsAtAnOffset) {
  auto buffer = Buffer::create(*ctx, "offset", 23);
  ASSERT_TRUE(buffer);
  const std::uint16_t value = 0xBEEF;
  buffer->uploadValue(value, 21);
  buffer->upload(std::vector<std::uint8_t>{1, 2, 3}, 5);
  std::vector<std::uint8_t> part(5);
  buffer->download(std::span(part), 4);
  EXPECT_EQ(part, (std::vector<std::uint8_t>{0, 1, 2, 3, 0}));
  std::uint16_t read = 0;
  buffer->download(std::span(&read, 1), 21);
  EXPECT_EQ(read, value);
}

TEST_F(BufferTest, LivesInDeviceMemoryUnlessItIsUpdatable) {
  const auto flags = [](const Buffer& buffer) {
    GLint value = 0;
    glGetNamedBufferParameteriv(buffer.id(), GL_BUFFER_STORAGE_FLAGS, &value);
    return value;
  };
  const auto texels = TexelBuffer::create(*ctx, "texels", 4, TexelFormat::kR32F);
  const auto storage = Buffer::create(*ctx, "storage", 16);
  const auto block = Buffer::create(*ctx, "block", 16, BufferUse::kUpdatable);
  ASSERT_TRUE(texels && storage && block);
  EXPECT_EQ(flags(*texels), 0);
  EXPECT_EQ(flags(*storage), 0);
  EXPECT_EQ(flags(*block), GL_DYNAMIC_STORAGE_BIT);
}

TEST_F(BufferTest, TransfersMoreThanItsStagingMemoryHolds) {
  constexpr std::size_t kBytes = (std::size_t{11} << 20) + 13;  // more than ten times its 1 MiB
  auto buffer = Buffer::create(*ctx, "large", kBytes);
  ASSERT_TRUE(buffer);
  const auto bytes = ramp(kBytes);
  buffer->upload(bytes);
  EXPECT_TRUE(buffer->downloadVector<std::uint8_t>(kBytes) == bytes);
}

TEST_F(BufferTest, ManySmallUploadsInARowKeepTheirOrder) {
  auto buffer = Buffer::create(*ctx, "small", 4 * 1000);
  ASSERT_TRUE(buffer);
  // More than the staging memory, so that its parts are reused while the device may still read them.
  for (std::uint32_t round = 0; round < 4; ++round) {
    for (std::uint32_t i = 0; i < 1000; ++i) buffer->uploadValue(std::array<std::uint32_t, 1>{1000 * round + i}, 4 * i);
    std::vector<std::uint32_t> filler(300'000, round);
    auto other = Buffer::create(*ctx, "filler", 4 * filler.size());
    ASSERT_TRUE(other);
    other->upload(filler);
    std::vector<std::uint32_t> expected(1000);
    std::iota(expected.begin(), expected.end(), 1000 * round);
    ASSERT_EQ(buffer->downloadVector<std::uint32_t>(1000), expected);
  }
}

TEST_F(BufferTest, ClearsWholeWordsAndTheTail) {
  auto buffer = Buffer::create(*ctx, "clear", 11, BufferUse::kDeviceOnly);
  ASSERT_TRUE(buffer);
  buffer->clear(0x44332211);
  EXPECT_EQ(buffer->downloadVector<std::uint8_t>(11),
            (std::vector<std::uint8_t>{0x11, 0x22, 0x33, 0x44, 0x11, 0x22, 0x33, 0x44, 0x11, 0x22, 0x33}));
  buffer->clearRange(0, 4, 4);
  EXPECT_EQ(buffer->downloadVector<std::uint8_t>(11),
            (std::vector<std::uint8_t>{0x11, 0x22, 0x33, 0x44, 0, 0, 0, 0, 0x11, 0x22, 0x33}));
}

TEST_F(BufferTest, CopiesOnTheDevice) {
  auto from = Buffer::create(*ctx, "from", 101);
  auto to = Buffer::create(*ctx, "to", 57, BufferUse::kDeviceOnly);
  ASSERT_TRUE(from && to);
  const auto bytes = ramp(101);
  from->upload(bytes);
  to->copyFrom(*from, 33, 50, 7);
  const auto read = to->downloadVector<std::uint8_t>(57);
  EXPECT_TRUE(std::equal(read.begin() + 7, read.end(), bytes.begin() + 33));
  EXPECT_THAT(std::vector(read.begin(), read.begin() + 7), Each(0));
}

TEST_F(BufferTest, RefusesImpossibleSizes) {
  const auto empty = Buffer::create(*ctx, "nothing", 0);
  ASSERT_FALSE(empty);
  EXPECT_THAT(empty.error().message, HasSubstr("\"nothing\""));
  const auto over = static_cast<std::size_t>(ctx->limits().max_ssbo_bytes) + 1;
  const auto large = Buffer::create(*ctx, "too much", over);
  ASSERT_FALSE(large);
  EXPECT_THAT(large.error().message, HasSubstr(std::to_string(over)));
  const auto texels = static_cast<std::size_t>(ctx->limits().max_texel_buffer_elements) + 1;
  const auto wide = TexelBuffer::create(*ctx, "too many", texels, TexelFormat::kR32F);
  ASSERT_FALSE(wide);
  EXPECT_THAT(wide.error().message, HasSubstr(std::to_string(texels) + " texels"));
  EXPECT_EQ(ctx->ledger().buffer_count, 0u);
}

TEST_F(BufferTest, LedgerCountsLiveBuffers) {
  const Ledger& ledger = ctx->ledger();
  {
    auto a = Buffer::create(*ctx, "a", 100);
    auto b = TexelBuffer::create(*ctx, "b", 7, TexelFormat::kRGBA32F);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(ledger.buffer_count, 2u);
    EXPECT_EQ(ledger.buffer_bytes, 212u);
    Buffer moved = std::move(*a);
    EXPECT_FALSE(*a);
    EXPECT_EQ(ledger.buffer_bytes, 212u);
    *b = TexelBuffer();  // releases its old storage
    EXPECT_EQ(ledger.buffer_count, 1u);
    EXPECT_EQ(ledger.buffer_bytes, 100u);
  }
  EXPECT_EQ(ledger.buffer_count, 0u);
  EXPECT_EQ(ledger.buffer_bytes, 0u);
  EXPECT_EQ(ledger.buffers_made_count, 2u);
}

TEST_F(BufferTest, TexelFormatsHaveTheSizeOfTheirWords) {
  const std::pair<TexelFormat, std::size_t> formats[] = {{TexelFormat::kR32F, 4},     {TexelFormat::kRG32F, 8},
                                                         {TexelFormat::kRGBA32F, 16}, {TexelFormat::kR32UI, 4},
                                                         {TexelFormat::kRG32UI, 8},   {TexelFormat::kRGBA32UI, 16},
                                                         {TexelFormat::kR32I, 4},     {TexelFormat::kRGBA32I, 16}};
  for (const auto& [format, bytes] : formats) {
    const auto buffer = TexelBuffer::create(*ctx, "format", 5, format);
    ASSERT_TRUE(buffer);
    EXPECT_EQ(buffer->sizeBytes(), 5 * bytes);
    buffer->bindTexel(0);
  }
}

/// Layout of the block in shaders/tests/block.glsl.
struct CheckBlock {
  std::uint32_t item_count;
  float gain;
  float padding[2];
  float unused_m[4];
  float tail_s[8];
};

TEST_F(BufferTest, TexelViewEqualsStorageBitForBit) {
  constexpr std::uint32_t kCount = 1009;
  auto values = TexelBuffer::create(*ctx, "values", kCount, TexelFormat::kRGBA32F);
  auto differences = Buffer::create(*ctx, "differences", 4);
  auto block = Buffer::create(*ctx, "block", sizeof(CheckBlock));
  auto program = Program::create(*ctx, "tests/texel_equals_storage.comp");
  ASSERT_TRUE(values && differences && block);
  ASSERT_TRUE(program) << program.error().message;
  std::vector<float> floats(4 * kCount);
  std::iota(floats.begin(), floats.end(), -1500.25f);
  values->upload(floats);
  block->uploadValue(CheckBlock{kCount, 1.5f, {}, {}, {}});
  block->bindUniform(0);
  differences->bindStorage(1);
  values->bindStorage(0);
  values->bindTexel(3);
  ASSERT_TRUE(program->dispatch(64, (kCount + 63) / 64));
  EXPECT_EQ(differences->downloadVector<std::uint32_t>(1)[0], 0u);

  // Check of the test itself: with another buffer at the storage binding, everything differs.
  auto others = Buffer::create(*ctx, "others", values->sizeBytes());
  ASSERT_TRUE(others);
  others->clear(0x7e000000);
  others->bindStorage(0);
  ASSERT_TRUE(program->dispatch(64, (kCount + 63) / 64));
  EXPECT_EQ(differences->downloadVector<std::uint32_t>(1)[0], kCount);
}

TEST_F(BufferTest, TexelViewSeesWhatAShaderWroteBefore) {
  constexpr std::uint32_t kCount = 4 * 333;
  auto values = TexelBuffer::create(*ctx, "values", kCount / 4, TexelFormat::kRGBA32F);
  auto expected = Buffer::create(*ctx, "expected", kCount * 4);
  auto counts = Buffer::create(*ctx, "counts", 8);
  auto block = Buffer::create(*ctx, "block", sizeof(CheckBlock));
  auto write = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
  auto compare = Program::create(*ctx, "tests/texel_equals_storage.comp");
  ASSERT_TRUE(values && expected && counts && block && write && compare);
  std::vector<std::int32_t> numbers(kCount);
  std::iota(numbers.begin(), numbers.end(), 0x3f800000);  // the bits of floats just above 1
  expected->upload(numbers);
  counts->bindStorage(1);
  values->bindStorage(0);
  write->setUniform("item_count", kCount);
  write->setUniform("offset", 0x3f800000);
  ASSERT_TRUE(write->dispatch(kCount));
  ctx->barrier(Barrier::kStorageAndTexel);
  counts->clear();
  block->uploadValue(CheckBlock{kCount / 4, 1.0f, {}, {}, {}});
  block->bindUniform(0);
  expected->bindStorage(0);
  values->bindTexel(3);
  ASSERT_TRUE(compare->dispatch(64, (kCount / 4 + 63) / 64));
  EXPECT_EQ(counts->downloadVector<std::uint32_t>(1)[0], 0u);
}

}  // namespace
}  // namespace spindrift::gpu
