// The bytes of MCAP records: little endian numbers, texts and maps with their lengths in front.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <spindrift/core/bytes.h>

namespace spindrift::mcap {

/// First byte of a record.
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

/// Size of a record's opcode and length, before its content.
inline constexpr std::size_t kRecordHeadBytes = 9;
/// First and last bytes of a file.
inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

/// Appends to bytes that outlive it.
class RecordBytes {
 public:
  explicit RecordBytes(core::Bytes& out) : out_(out) {}

  RecordBytes& u8(std::uint8_t value) { return number(value, 1); }
  RecordBytes& u16(std::uint16_t value) { return number(value, 2); }
  RecordBytes& u32(std::uint32_t value) { return number(value, 4); }
  RecordBytes& u64(std::uint64_t value) { return number(value, 8); }
  /// Without its length.
  RecordBytes& bytes(core::ByteView bytes);
  RecordBytes& text(std::string_view text);
  RecordBytes& map(const std::map<std::string, std::string>& values);
  /// Begins a record whose content is written next; end() puts in its length.
  RecordBytes& begin(Opcode opcode);
  void end();
  /// Puts `value` where four bytes were written before.
  void setU32(std::size_t at, std::uint32_t value) { set(at, value, 4); }

 private:
  RecordBytes& number(std::uint64_t value, int byte_count);
  void set(std::size_t at, std::uint64_t value, int byte_count);

  core::Bytes& out_;
  std::size_t content_ = 0;  ///< begin of the content of the record
};

}  // namespace spindrift::mcap
