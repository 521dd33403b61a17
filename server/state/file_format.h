// The names and the bytes of snapshots and logs.
//
// Names: NNNNNNNNNNNN.snapshot and NNNNNNNNNNNN.log, twelve digits; NAME.tmp while a file is written; NAME.damaged,
// NAME.damaged.2, ... for what was set aside.
//
// Bytes, all numbers little-endian:
//
//   snapshot: start, with the magic "spinsnp2" | payload length u64 | CRC-32C of the payload u32 | room | payload
//   log:      start, with the magic "spinlog2" | room | records
//   start:    magic | checksum u32 | length of the room's name u32 | generation u64 | record number u64
//   record:   checksum u32 | payload length u32 | record number u64 | CRC-32C of the payload u32 | payload
//
// A checksum is the CRC-32C of what follows it in the header: up to the payload, or to the first record. Records of a
// room are numbered from 1 through all its logs; the number in a snapshot is that of the first record after its state,
// the one in the start of a log that of its first record. A record has at least one byte. The last character of the
// magic is the version of the format. Files of version 1, which have neither room nor record numbers, are still read.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::state {

enum class FileKind { kSnapshot, kLog, kTemporary, kSetAside, kForeign };

struct FileName {
  FileKind kind = FileKind::kForeign;
  std::uint64_t generation = 0;  ///< of a snapshot or log; from 1
};

FileName parseFileName(std::string_view name);
std::string snapshotName(std::uint64_t generation);
std::string logName(std::uint64_t generation);

inline constexpr std::size_t kMagicBytes = 8;
inline constexpr std::size_t kStartBytes = 32;
/// Before the room's name.
inline constexpr std::size_t kSnapshotHeaderBytes = 44;
inline constexpr std::size_t kRecordHeaderBytes = 20;
inline constexpr std::size_t kNameMaxBytes = 255;

/// Whose file it is. Views the room's name.
struct FileOwner {
  std::string_view room;
  std::uint64_t generation;
};

/// Why a file cannot be used, or not beyond a byte.
struct Fault {
  std::string reason;         ///< a clause: "record 3 does not match its checksum"
  std::uint64_t at_byte = 0;  ///< where the damaged part begins
  /// The file ends within its last record and is whole before: what a process that was killed while it wrote leaves.
  bool is_torn_end = false;
};

/// Content of a snapshot file.
struct ParsedSnapshot {
  core::ByteView payload;                    ///< views the parsed bytes; empty when there is a fault
  std::optional<std::uint64_t> next_number;  ///< of the first record after it; nullopt in version 1
  std::optional<Fault> fault;
};

/// Content of a log file.
struct ParsedLog {
  std::optional<std::uint64_t> first_number;  ///< of records[0], also without records; nullopt in version 1
  std::vector<core::ByteView> records;        ///< the whole ones up to the fault; they view the parsed bytes
  std::uint64_t whole_bytes = 0;              ///< header and whole records; 0 when the header cannot be used
  std::optional<Fault> fault;
};

core::Bytes snapshotHeader(const FileOwner& owner, std::uint64_t next_number, core::ByteView payload);
core::Bytes logHeader(const FileOwner& owner, std::uint64_t first_number);
std::array<std::uint8_t, kRecordHeaderBytes> recordHeader(std::uint64_t number, core::ByteView payload);

/// Both read a whole file that should be of `owner`. They allocate nothing for a length that the file does not have.
ParsedSnapshot parseSnapshot(core::ByteView file, const FileOwner& owner);
ParsedLog parseLog(core::ByteView file, const FileOwner& owner);

}  // namespace spindrift::state
