#include <algorithm>

#include <zlib.h>
#include <zstd.h>

#include <spindrift/mcap/writer.h>

#include "record_bytes.h"

namespace spindrift::mcap {
namespace {

constexpr int kCompressionLevel = 1;  // what is inside is packed already
constexpr std::string_view kZstd = "zstd";
/// Of the Chunk record without what it contains, and of a ChunkIndex record without its offsets.
constexpr std::size_t kChunkHeadBytes = kRecordHeadBytes + 8 + 8 + 8 + 4 + 4 + kZstd.size() + 8;
constexpr std::size_t kChunkIndexHeadBytes = kRecordHeadBytes + 5 * 8 + 4 + 4 + kZstd.size() + 2 * 8;
constexpr std::size_t kIndexedChannelBytes = kRecordHeadBytes + 2 + 4 + 10;  // MessageIndex and entry of the ChunkIndex
constexpr std::size_t kIndexedMessageBytes = 16;
constexpr std::size_t kMessageHeadBytes = kRecordHeadBytes + 2 + 4 + 8 + 8;
/// DataEnd, Statistics without its counts, five SummaryOffsets, Footer, magic.
constexpr std::size_t kEndBytes = (kRecordHeadBytes + 4) + (kRecordHeadBytes + 50) + 5 * (kRecordHeadBytes + 17) +
                                  (kRecordHeadBytes + 20) + kMagic.size();

/// IEEE 802.3, as zlib has it.
std::uint32_t crc32Of(core::ByteView bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

/// Returns the compressed bytes; empty if they would not be fewer.
core::Bytes compressed(const core::Bytes& bytes) {
  core::Bytes out(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size) || size >= bytes.size()) return {};
  out.resize(size);
  return out;
}

}  // namespace

struct Writer::ChunkIndex {
  std::uint64_t begin_ns = 0;
  std::uint64_t end_ns = 0;
  std::uint64_t at = 0;  ///< in the file
  std::uint64_t chunk_bytes = 0;
  std::map<std::uint16_t, std::uint64_t> message_indexes;  ///< position of each channel's in the file
  std::uint64_t message_indexes_bytes = 0;
  std::string_view compression;
  std::uint64_t stored_bytes = 0;
  std::uint64_t records_bytes = 0;
};

Writer::Writer(std::unique_ptr<Sink> sink, const WriterOptions& options) : sink_(std::move(sink)), options_(options) {}

Writer::~Writer() = default;

core::Result<std::unique_ptr<Writer>> Writer::begin(std::unique_ptr<Sink> sink, const WriterOptions& options) {
  auto out = std::unique_ptr<Writer>(new Writer(std::move(sink), options));
  core::Bytes bytes;
  RecordBytes record(bytes);
  record.bytes(core::viewOf(std::string(kMagic))).begin(Opcode::kHeader).text(options.profile).text(options.library);
  record.end();
  if (auto written = out->write(bytes); !written) return written.error();
  return out;
}

core::Result<void> Writer::write(const core::Bytes& bytes) {
  if (auto written = sink_->append(bytes); !written) return written;
  written_bytes_ += bytes.size();
  data_crc_ = crc32Of(bytes, data_crc_);
  return {};
}

std::uint16_t Writer::addSchema(const std::string& name, const std::string& encoding, core::ByteView data) {
  const auto id = static_cast<std::uint16_t>(++schema_count_);
  const std::size_t at = schemas_.size();
  RecordBytes record(schemas_);
  record.begin(Opcode::kSchema).u16(id).text(name).text(encoding);
  record.u32(static_cast<std::uint32_t>(data.size())).bytes(data).end();
  RecordBytes(chunk_.records).bytes(core::ByteView(schemas_).subspan(at));
  return id;
}

std::uint16_t Writer::addChannel(const ChannelSetup& setup) {
  const auto id = static_cast<std::uint16_t>(channel_count_++);
  const std::size_t at = channels_.size();
  RecordBytes record(channels_);
  record.begin(Opcode::kChannel).u16(id).u16(setup.schema_id).text(setup.topic).text(setup.message_encoding).map({});
  record.end();
  RecordBytes(chunk_.records).bytes(core::ByteView(channels_).subspan(at));
  return id;
}

core::Result<void> Writer::add(const Message& message) {
  chunk_.indexes[message.channel_id].emplace_back(message.log_time_ns, chunk_.records.size());
  RecordBytes record(chunk_.records);
  record.begin(Opcode::kMessage).u16(message.channel_id).u32(message.sequence);
  record.u64(message.log_time_ns).u64(message.publish_time_ns).bytes(message.data).end();
  const bool is_first = chunk_.message_count++ == 0;
  chunk_.begin_ns = is_first ? message.log_time_ns : std::min(chunk_.begin_ns, message.log_time_ns);
  chunk_.end_ns = is_first ? message.log_time_ns : std::max(chunk_.end_ns, message.log_time_ns);
  return chunk_.records.size() < options_.chunk_bytes ? core::Result<void>() : endChunk();
}

core::Result<void> Writer::addMetadata(const std::string& name, const std::map<std::string, std::string>& values) {
  const std::uint64_t at = written_bytes_;
  core::Bytes bytes;
  RecordBytes record(bytes);
  record.begin(Opcode::kMetadata).text(name).map(values).end();
  if (auto written = write(bytes); !written) return written;
  RecordBytes index(metadata_);
  index.begin(Opcode::kMetadataIndex).u64(at).u64(bytes.size()).text(name).end();
  ++metadata_count_;
  return {};
}

core::Result<void> Writer::endChunk() {
  if (chunk_.message_count == 0) return {};
  OpenChunk chunk;
  std::swap(chunk, chunk_);
  const core::Bytes packed = options_.is_compressed ? compressed(chunk.records) : core::Bytes();
  const core::Bytes& stored = packed.empty() ? chunk.records : packed;

  ChunkIndex index;
  index.begin_ns = chunk.begin_ns;
  index.end_ns = chunk.end_ns;
  index.at = written_bytes_;
  index.compression = packed.empty() ? std::string_view() : kZstd;
  index.stored_bytes = stored.size();
  index.records_bytes = chunk.records.size();
  // One write for the chunk and its indexes: a file whose writer is killed ends at a whole chunk.
  core::Bytes bytes;
  bytes.reserve(stored.size() + kChunkHeadBytes + kIndexedChannelBytes * chunk.indexes.size() +
                kIndexedMessageBytes * chunk.message_count);
  RecordBytes record(bytes);
  record.begin(Opcode::kChunk).u64(index.begin_ns).u64(index.end_ns).u64(index.records_bytes);
  record.u32(crc32Of(chunk.records)).text(index.compression).u64(stored.size()).bytes(stored).end();
  index.chunk_bytes = bytes.size();
  for (const auto& [channel, messages] : chunk.indexes) {
    index.message_indexes[channel] = written_bytes_ + bytes.size();
    record.begin(Opcode::kMessageIndex).u16(channel);
    record.u32(static_cast<std::uint32_t>(kIndexedMessageBytes * messages.size()));
    for (const auto& [log_time_ns, offset] : messages) record.u64(log_time_ns).u64(offset);
    record.end();
  }
  index.message_indexes_bytes = bytes.size() - index.chunk_bytes;
  if (auto written = write(bytes); !written) return written;

  begin_ns_ = message_count_ == 0 ? chunk.begin_ns : std::min(begin_ns_, chunk.begin_ns);
  end_ns_ = std::max(end_ns_, chunk.end_ns);
  message_count_ += chunk.message_count;
  for (const auto& [channel, messages] : chunk.indexes) channel_message_counts_[channel] += messages.size();
  chunk_indexes_bytes_ += kChunkIndexHeadBytes + 10 * index.message_indexes.size();
  chunks_.push_back(std::move(index));
  return {};
}

std::uint64_t Writer::finishedMaxBytes(std::size_t message_bytes) const {
  const std::uint64_t open = kChunkHeadBytes + chunk_.records.size() + kMessageHeadBytes + message_bytes +
                             kIndexedMessageBytes * (chunk_.message_count + 1) +
                             kIndexedChannelBytes * (chunk_.indexes.size() + 1) + kChunkIndexHeadBytes;
  return written_bytes_ + open + chunk_indexes_bytes_ + schemas_.size() + channels_.size() + metadata_.size() +
         10 * channel_count_ + kEndBytes;
}

std::optional<std::uint64_t> Writer::chunkBegin_ns() const {
  return chunk_.message_count > 0 ? std::optional(chunk_.begin_ns) : std::nullopt;
}

core::Bytes Writer::summary() const {
  core::Bytes out;
  RecordBytes record(out);
  record.begin(Opcode::kDataEnd).u32(data_crc_).end();
  const std::size_t data_end_bytes = out.size();

  std::map<Opcode, std::pair<std::size_t, std::size_t>> groups;  // where in `out`
  const auto group = [&](Opcode opcode, auto write_group) {
    const std::size_t at = out.size();
    write_group();
    if (out.size() > at) groups[opcode] = {at, out.size() - at};
  };
  group(Opcode::kSchema, [&] { record.bytes(schemas_); });
  group(Opcode::kChannel, [&] { record.bytes(channels_); });
  group(Opcode::kStatistics, [&] {
    record.begin(Opcode::kStatistics).u64(message_count_).u16(static_cast<std::uint16_t>(schema_count_));
    record.u32(static_cast<std::uint32_t>(channel_count_)).u32(0).u32(static_cast<std::uint32_t>(metadata_count_));
    record.u32(static_cast<std::uint32_t>(chunks_.size())).u64(begin_ns_).u64(end_ns_);
    record.u32(static_cast<std::uint32_t>(10 * channel_message_counts_.size()));
    for (const auto& [channel, count] : channel_message_counts_) record.u16(channel).u64(count);
    record.end();
  });
  group(Opcode::kChunkIndex, [&] {
    for (const ChunkIndex& chunk : chunks_) {
      record.begin(Opcode::kChunkIndex).u64(chunk.begin_ns).u64(chunk.end_ns).u64(chunk.at).u64(chunk.chunk_bytes);
      record.u32(static_cast<std::uint32_t>(10 * chunk.message_indexes.size()));
      for (const auto& [channel, at] : chunk.message_indexes) record.u16(channel).u64(at);
      record.u64(chunk.message_indexes_bytes).text(chunk.compression).u64(chunk.stored_bytes);
      record.u64(chunk.records_bytes).end();
    }
  });
  group(Opcode::kMetadataIndex, [&] { record.bytes(metadata_); });

  const std::uint64_t offsets_at = written_bytes_ + out.size();
  for (const auto& [opcode, where] : groups) {
    record.begin(Opcode::kSummaryOffset).u8(static_cast<std::uint8_t>(opcode));
    record.u64(written_bytes_ + where.first).u64(where.second).end();
  }
  record.begin(Opcode::kFooter).u64(written_bytes_ + data_end_bytes).u64(offsets_at);
  // The checksum covers the summary, and the footer up to the checksum itself.
  const std::size_t crc_at = out.size();
  record.u32(0).end();
  record.setU32(crc_at, crc32Of(core::ByteView(out).subspan(data_end_bytes, crc_at - data_end_bytes)));
  record.bytes(core::viewOf(std::string(kMagic)));
  return out;
}

core::Result<void> Writer::finish() {
  auto ended = endChunk();
  auto written = write(summary());
  return ended ? written : ended;
}

}  // namespace spindrift::mcap
