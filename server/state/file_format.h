// The bytes of snapshots and logs. All numbers are little-endian.
//
//   snapshot: magic "spinsnp1" | generation u64 | payload length u64 | CRC-32C of the payload u32 | payload
//   log:      magic "spinlog1" | generation u64 | records
//   record:   payload length u32 | CRC-32C of the payload u32 | payload
//
// A record has at least one byte, so that a part of a file that reads as zeros is no record. The last character of the
// magic is the version of the format.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::state {

inline constexpr std::size_t kMagicBytes = 8;
inline constexpr std::size_t kSnapshotHeaderBytes = 28;
inline constexpr std::size_t kLogHeaderBytes = 16;
inline constexpr std::size_t kRecordHeaderBytes = 8;

/// Why a file cannot be used, or not beyond a byte.
struct Fault {
  std::string reason;         ///< a clause: "record 3 does not match its checksum"
  std::uint64_t at_byte = 0;  ///< where the damaged part begins
  /// The file ends within its last record and is whole before: what a process that was killed while it wrote leaves.
  bool is_torn_end = false;
};

/// What is in the file of a snapshot.
struct ParsedSnapshot {
  core::ByteView payload;  ///< views the parsed bytes; empty when there is a fault
  std::optional<Fault> fault;
};

/// What is in the file of a log.
struct ParsedLog {
  std::vector<core::ByteView> records;  ///< the whole ones up to the fault; they view the parsed bytes
  std::uint64_t whole_bytes = 0;        ///< header and whole records; 0 when the header cannot be used
  std::optional<Fault> fault;
};

std::array<std::uint8_t, kSnapshotHeaderBytes> snapshotHeader(std::uint64_t generation, core::ByteView payload);
std::array<std::uint8_t, kLogHeaderBytes> logHeader(std::uint64_t generation);
std::array<std::uint8_t, kRecordHeaderBytes> recordHeader(core::ByteView payload);

/// Both read a whole file whose name says that it is of `generation`. They allocate nothing for a length that the file
/// does not have.
ParsedSnapshot parseSnapshot(core::ByteView file, std::uint64_t generation);
ParsedLog parseLog(core::ByteView file, std::uint64_t generation);

}  // namespace spindrift::state
