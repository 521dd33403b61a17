// The bytes of MCAP files: a golden file, which @mcap/core has read, bounds, and sinks that break.
#include <string>
#include <utility>

#include <spindrift/mcap/writer.h>

namespace spindrift::mcap {
namespace {

using core::Bytes;
using core::ByteView;

/// Keeps the file in memory; refuses what goes beyond `max_bytes`.
struct MemorySink final : Sink {
  MemorySink(Bytes& out, std::size_t most_bytes) : file(out), max_bytes(most_bytes) {}
  core::Result<void> append(ByteView bytes) override {
    if (file.size() + bytes.size() > max_bytes) return core::unavailable("the disk is full");
    file.insert(file.end(), bytes.begin(), bytes.end());
    return {};
  }
  Bytes& file;
  std::size_t max_bytes;
};

struct WriterTest : testing::Test {
  std::unique_ptr<Writer> begin(const WriterOptions& options, std::size_t max_bytes = 1u << 30) {
    auto writer = Writer::begin(std::make_unique<MemorySink>(file, max_bytes), options);
    EXPECT_TRUE(writer);
    return *std::move(writer);
  }
  static core::Result<void> add(Writer& writer, std::uint16_t channel, std::uint32_t sequence, const Bytes& data) {
    return writer.add({.channel_id = channel,
                       .sequence = sequence,
                       .log_time_ns = 1000 + sequence,
                       .publish_time_ns = sequence,
                       .data = data});
  }
  /// Opcodes and lengths of the records in the file, without those inside of chunks.
  std::vector<std::pair<int, std::size_t>> records() const {
    std::vector<std::pair<int, std::size_t>> out;
    for (std::size_t at = 8; at + 9 <= file.size();) {
      std::size_t length = 0;
      for (std::size_t k = 8; k > 0; --k) length = length << 8 | file[at + k];
      out.emplace_back(file[at], length);
      at += 9 + length;
    }
    return out;
  }
  std::vector<int> opcodes() const {
    std::vector<int> out;
    for (const auto& [opcode, length] : records()) out.push_back(opcode);
    return out;
  }
  static std::string hex(ByteView bytes) {
    std::string out;
    for (const std::uint8_t byte : bytes) {
      constexpr const char* kDigits = "0123456789abcdef";
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    }
    return out;
  }

  Bytes file;
};

TEST_F(WriterTest, SmallFileHasTheGoldenBytes) {
  const auto writer = begin({.profile = "p", .library = "lib", .is_compressed = false});
  const std::uint16_t schema = writer->addSchema("S", "protobuf", Bytes{1, 2});
  const std::uint16_t channel =
      writer->addChannel({.topic = "/t", .message_encoding = "protobuf", .schema_id = schema});
  ASSERT_TRUE(writer->addMetadata("m", {{"k", "v"}}));
  ASSERT_TRUE(add(*writer, channel, 7, {0xaa, 0xbb}));
  ASSERT_TRUE(writer->finish());
  // @mcap/core reads it, with the checksums.
  const std::string golden =
      "894d434150300d0a"                                                                      // magic
      "010c000000000000000100000070030000006c6962"                                            // Header
      "0c1300000000000000010000006d0a000000010000006b0100000076"                              // Metadata
      "068e00000000000000ef03000000000000ef030000000000006600000000000000f35149720000000066"  // Chunk
      "00000000000000031900000000000000010001000000530800000070726f746f62756602000000010204"
      "1a0000000000000000000100020000002f740800000070726f746f627566000000000518000000000000"
      "00000007000000ef030000000000000700000000000000aabb"
      "071600000000000000000010000000ef030000000000004500000000000000"                        // MessageIndex
      "0f0400000000000000130da211"                                                            // DataEnd
      "031900000000000000010001000000530800000070726f746f627566020000000102"                  // Schema
      "041a0000000000000000000100020000002f740800000070726f746f62756600000000"                // Channel
      "0b38000000000000000100000000000000010001000000000000000100000001000000ef030000000000"  // Statistics
      "00ef030000000000000a00000000000100000000000000"
      "084a00000000000000ef03000000000000ef03000000000000390000000000000097000000000000000a"  // ChunkIndex
      "0000000000d0000000000000001f000000000000000000000066000000000000006600000000000000"
      "0d15000000000000001d000000000000001c00000000000000010000006d"  // MetadataIndex
      "0e110000000000000003fc000000000000002200000000000000"          // SummaryOffset
      "0e1100000000000000041e010000000000002300000000000000"          // SummaryOffset
      "0e11000000000000000882010000000000005300000000000000"          // SummaryOffset
      "0e11000000000000000b41010000000000004100000000000000"          // SummaryOffset
      "0e11000000000000000dd5010000000000001e00000000000000"          // SummaryOffset
      "021400000000000000fc00000000000000f301000000000000205791bd"    // Footer
      "894d434150300d0a";
  EXPECT_EQ(hex(file), golden);
}

TEST_F(WriterTest, EmptyFileIsWhole) {
  const auto writer = begin({.profile = "", .library = "lib"});
  ASSERT_TRUE(writer->finish());
  EXPECT_THAT(opcodes(), testing::ElementsAre(0x01, 0x0f, 0x0b, 0x0e, 0x02));
  EXPECT_EQ(hex(ByteView(file).last(8)), "894d434150300d0a");
}

TEST_F(WriterTest, ChunksAreClosedAtTheirSizeAndCompressed) {
  const auto writer = begin({.profile = "", .library = "lib", .chunk_bytes = 10'000});
  const std::uint16_t channel = writer->addChannel({.topic = "/t", .message_encoding = "raw"});
  for (std::uint32_t k = 0; k < 100; ++k) ASSERT_TRUE(add(*writer, channel, k, Bytes(1000, 5)));
  ASSERT_TRUE(writer->finish());
  std::size_t chunk_count = 0;
  for (const auto& [opcode, length] : records()) {
    if (opcode != 0x06) continue;
    ++chunk_count;
    EXPECT_LT(length, 1000u);
  }
  EXPECT_EQ(chunk_count, 10u);
  EXPECT_EQ(writer->messageCount(), 100u);
}

TEST_F(WriterTest, SizeStaysWithinWhatWasPredicted) {
  std::uint32_t noise = 1;
  for (std::uint32_t count = 1; count < 60; ++count) {
    file.clear();
    const auto writer = begin({.profile = "", .library = "lib", .chunk_bytes = 4000});
    std::uint64_t bound = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      if (k % 10 == 0) writer->addChannel({.topic = "/t" + std::to_string(k), .message_encoding = "raw"});
      Bytes data(noise % 997);
      for (std::uint8_t& byte : data) {
        noise = noise * 1664525 + 1013904223;
        byte = static_cast<std::uint8_t>(noise >> 24);  // does not compress
      }
      bound = writer->finishedMaxBytes(data.size());
      ASSERT_TRUE(add(*writer, static_cast<std::uint16_t>(k / 10), k, data));
    }
    ASSERT_TRUE(writer->finish());
    ASSERT_LE(file.size(), bound) << count;
    ASSERT_GT(2 * file.size() + 500, bound) << count;
    EXPECT_EQ(writer->writtenBytes(), file.size());
  }
}

TEST_F(WriterTest, FullDiskLosesTheOpenChunkOnlyAndTheFileIsFinished) {
  const auto writer = begin({.profile = "", .library = "lib", .chunk_bytes = 1000, .is_compressed = false}, 4000);
  const std::uint16_t channel = writer->addChannel({.topic = "/t", .message_encoding = "raw"});
  std::uint32_t count = 0;
  core::Result<void> added;
  while ((added = add(*writer, channel, count, Bytes(1000, 1)))) ++count;
  EXPECT_EQ(added.error().message, "the disk is full");
  EXPECT_EQ(count, 3u);
  ASSERT_TRUE(writer->finish());
  EXPECT_EQ(writer->messageCount(), 3u);
  EXPECT_EQ(std::ranges::count(opcodes(), 0x06), 3);
  EXPECT_EQ(opcodes().back(), 0x02);
}

TEST_F(WriterTest, BrokenSinkIsReportedAtTheBegin) {
  const auto writer = Writer::begin(std::make_unique<MemorySink>(file, 10), {.profile = "", .library = "lib"});
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().message, "the disk is full");
}

}  // namespace
}  // namespace spindrift::mcap
