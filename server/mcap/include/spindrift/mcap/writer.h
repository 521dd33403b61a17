// Writes a file in the MCAP format (https://mcap.dev/spec), version 0: messages in chunks, compressed with Zstandard,
// each followed by its index, and a summary with which a reader finds any moment without reading the rest. What was
// written can be read at any time up to the last whole chunk, also if the end of the file is missing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::mcap {

/// Takes the bytes of a file in their order.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Appends all of the bytes. After an error none of them is there, and further calls may succeed.
  virtual core::Result<void> append(core::ByteView bytes) = 0;
};

struct WriterOptions {
  std::string profile;                 ///< of the Header; empty: none
  std::string library;                 ///< name and version of the program
  std::size_t chunk_bytes = 1u << 20;  ///< a chunk is closed by the message that reaches this size
  bool is_compressed = true;           ///< a chunk that Zstandard does not make smaller stays as it is
};

struct ChannelSetup {
  std::string topic;
  std::string message_encoding;
  std::uint16_t schema_id = 0;  ///< from addSchema(); 0: without a schema
};

/// One message; times are nanoseconds.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  core::ByteView data;
};

/// Memory: one chunk with one message more than its size, its compressed form, and about 100 bytes per chunk for the
/// summary. After an error nothing but finish() may be called. One thread at a time.
class Writer {
 public:
  /// Writes the begin of the file. Error: that of the sink.
  static core::Result<std::unique_ptr<Writer>> begin(std::unique_ptr<Sink> sink, const WriterOptions& options);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Returns the number of the new schema, from 1. At most 65,000 of them, which the caller keeps to.
  std::uint16_t addSchema(const std::string& name, const std::string& encoding, core::ByteView data);
  /// Returns the number of the new channel, from 0; as many.
  std::uint16_t addChannel(const ChannelSetup& setup);

  /// Puts the message into the open chunk, and writes the chunk if it is full. Error: that of the sink; the chunk is
  /// lost then.
  core::Result<void> add(const Message& message);
  /// Writes a record of names and values, which belongs to the file as a whole.
  core::Result<void> addMetadata(const std::string& name, const std::map<std::string, std::string>& values);
  /// Writes the open chunk, if it has messages.
  core::Result<void> endChunk();
  /// Writes the open chunk and the summary; the last call. After an earlier error: the summary of what is in the file.
  core::Result<void> finish();

  /// Returns the messages in the file and in the open chunk; a chunk that could not be written does not count.
  [[nodiscard]] std::uint64_t messageCount() const { return message_count_ + chunk_.message_count; }
  /// Returns the bytes that the file has now, without the open chunk.
  [[nodiscard]] std::uint64_t writtenBytes() const { return written_bytes_; }
  /// Returns a bound for the size of the file if it were finished after one more message of this many bytes.
  [[nodiscard]] std::uint64_t finishedMaxBytes(std::size_t message_bytes) const;
  /// Returns the log time of the first message in the open chunk; nullopt: it has none.
  [[nodiscard]] std::optional<std::uint64_t> chunkBegin_ns() const;

 private:
  struct ChunkIndex;
  /// Place of each message of a channel in the open chunk: log time and offset.
  using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  struct OpenChunk {
    core::Bytes records;
    std::map<std::uint16_t, MessageIndex> indexes;
    std::size_t message_count = 0;
    std::uint64_t begin_ns = 0;
    std::uint64_t end_ns = 0;
  };

  Writer(std::unique_ptr<Sink> sink, const WriterOptions& options);
  core::Result<void> write(const core::Bytes& bytes);
  [[nodiscard]] core::Bytes summary() const;

  const std::unique_ptr<Sink> sink_;
  const WriterOptions options_;
  OpenChunk chunk_;
  std::vector<ChunkIndex> chunks_;
  core::Bytes schemas_;   ///< records, for the summary
  core::Bytes channels_;  ///< the same
  core::Bytes metadata_;  ///< MetadataIndex records, the same
  std::size_t schema_count_ = 0;
  std::size_t channel_count_ = 0;
  std::size_t metadata_count_ = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts_;  ///< of whole chunks
  std::uint64_t message_count_ = 0;                                ///< the same
  std::uint64_t begin_ns_ = 0;
  std::uint64_t end_ns_ = 0;
  std::uint64_t chunk_indexes_bytes_ = 0;  ///< of the ChunkIndex records
  std::uint64_t written_bytes_ = 0;
  std::uint32_t data_crc_ = 0;  ///< of all bytes written so far
};

}  // namespace spindrift::mcap
