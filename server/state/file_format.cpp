#include "file_format.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/core/text.h>
#include <spindrift/state/posix_file.h>
#include <spindrift/state/room_files.h>

namespace spindrift::state {
namespace {

constexpr std::size_t kDigitCount = 12;
constexpr std::string_view kSnapshotSuffix = ".snapshot";
constexpr std::string_view kLogSuffix = ".log";

constexpr std::string_view kSnapshotMagic = "spinsnp2";
constexpr std::string_view kLogMagic = "spinlog2";
static_assert(kSnapshotMagic.size() == kMagicBytes && kLogMagic.size() == kMagicBytes);

// Version 1: snapshot: magic | generation u64 | payload length u64 | CRC-32C of the payload u32 | payload
//            log:      magic | generation u64 | records of payload length u32 | CRC-32C of the payload u32 | payload
constexpr std::size_t kOldSnapshotHeaderBytes = 28;
constexpr std::size_t kOldLogHeaderBytes = 16;
constexpr std::size_t kOldRecordHeaderBytes = 8;

constexpr std::size_t kChecksumEnd = kMagicBytes + 4;

template <typename Number>
void put(std::uint8_t* at, Number number) {
  for (std::size_t k = 0; k < sizeof(Number); ++k) at[k] = static_cast<std::uint8_t>(number >> (8 * k));
}

template <typename Number>
Number numberAt(core::ByteView bytes, std::size_t at) {
  Number number = 0;
  for (std::size_t k = 0; k < sizeof(Number); ++k) number |= static_cast<Number>(Number{bytes[at + k]} << (8 * k));
  return number;
}

std::string_view textOf(core::ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A header without its checksum, with space for `extra_bytes` before the room's name.
core::Bytes startOf(std::string_view magic, const FileOwner& owner, std::uint64_t number, std::size_t extra_bytes) {
  core::Bytes out(kStartBytes + extra_bytes);
  std::ranges::copy(magic, out.begin());
  put(out.data() + kChecksumEnd, static_cast<std::uint32_t>(owner.room.size()));
  put(out.data() + 16, owner.generation);
  put(out.data() + 24, number);
  out.insert(out.end(), owner.room.begin(), owner.room.end());
  return out;
}

void putChecksum(core::Bytes& header) {
  put(header.data() + kMagicBytes, core::crc32c(core::ByteView(header).subspan(kChecksumEnd)));
}

enum class Version { kOld, kNow };

struct Start {
  Version version = Version::kNow;
  std::optional<std::uint64_t> number{};
  std::size_t header_bytes = 0;  ///< with the room's name
  std::optional<Fault> fault{};
};

Fault wrongGeneration(std::uint64_t found, std::uint64_t expected, std::size_t at_byte) {
  return {fmt::format("it says that it is of generation {}, its name says {}", found, expected), at_byte};
}

/// Checks what both kinds of files begin with. `kind` is "snapshot" or "log"; the sizes are those of the header without
/// the room's name, in this version and in version 1.
Start readStart(core::ByteView file, std::string_view magic, std::string_view kind, std::size_t header_bytes,
                std::size_t old_header_bytes, const FileOwner& owner) {
  const auto refuse = [](std::string reason, std::uint64_t at_byte) {
    return Start{.fault = Fault{std::move(reason), at_byte}};
  };
  const std::string_view start = textOf(file.first(std::min(file.size(), kMagicBytes)));
  const std::string_view family = magic.substr(0, kMagicBytes - 1);
  if (!start.starts_with(family.substr(0, start.size())))
    return refuse(fmt::format("it is not a {}: it does not begin with {}", kind, magic), 0);
  if (start.size() == kMagicBytes && start.back() == '1') {
    if (file.size() < old_header_bytes) return refuse("it ends within its header", file.size());
    Start out{.version = Version::kOld, .number = {}, .header_bytes = old_header_bytes, .fault = {}};
    if (const auto found = numberAt<std::uint64_t>(file, kMagicBytes); found != owner.generation)
      out.fault = wrongGeneration(found, owner.generation, kMagicBytes);
    return out;
  }
  if (start.size() == kMagicBytes && start != magic) {
    if (start.back() < '0' || start.back() > '9')
      return refuse(fmt::format("it is not a {}: it does not begin with {}", kind, magic), 0);
    return refuse(
        fmt::format("it was written by {} version of the program, in the format {} (this version reads {} and the one "
                    "before); that version can use it under its old name",
                    start.back() > magic.back() ? "a newer" : "another", start, magic),
        kMagicBytes - 1);
  }
  if (file.size() < header_bytes) return refuse("it ends within its header", file.size());
  const auto name_bytes = numberAt<std::uint32_t>(file, kChecksumEnd);
  if (name_bytes > kNameMaxBytes) return refuse("its header does not match its checksum", kMagicBytes);
  if (file.size() - header_bytes < name_bytes) return refuse("it ends within its header", file.size());
  const core::ByteView header = file.first(header_bytes + name_bytes);
  if (core::crc32c(header.subspan(kChecksumEnd)) != numberAt<std::uint32_t>(file, kMagicBytes))
    return refuse("its header does not match its checksum", kMagicBytes);
  if (const std::string_view room = textOf(header.subspan(header_bytes)); room != owner.room) {
    return refuse(fmt::format("it is of the room '{}', its folder is that of '{}'",
                              core::cleanText(room, kNameMaxBytes), owner.room),
                  header_bytes);
  }
  if (const auto found = numberAt<std::uint64_t>(file, 16); found != owner.generation)
    return Start{.fault = wrongGeneration(found, owner.generation, 16)};
  return {Version::kNow, numberAt<std::uint64_t>(file, 24), header.size(), std::nullopt};
}

std::optional<Fault> checkLength(const std::string& name, std::uint32_t length, std::size_t at) {
  if (length > 0 && length <= kRecordMaxBytes) return std::nullopt;
  return Fault{fmt::format("{} has a length of {} bytes (1 to {} are possible)", name, length, kRecordMaxBytes), at};
}

/// Returns why the record at `at` cannot follow those before it; `expected` is the number that comes next.
std::optional<Fault> checkNumber(std::uint64_t found, std::uint64_t expected, std::size_t at) {
  if (found == expected) return std::nullopt;
  if (found < expected) return Fault{fmt::format("record {} stands where record {} follows", found, expected), at};
  return Fault{fmt::format("the records {} to {} are missing", expected, found - 1), at};
}

/// A record in the file, or why no whole one begins at `at`.
struct Found {
  core::ByteView payload;
  std::optional<Fault> fault;
};

/// `name` is what the record is called in messages.
Found readRecord(core::ByteView file, std::size_t at, Version version, const std::string& name,
                 std::optional<std::uint64_t> number) {
  const bool is_old = version == Version::kOld;
  const std::size_t header_bytes = is_old ? kOldRecordHeaderBytes : kRecordHeaderBytes;
  const std::size_t left = file.size() - at;
  if (left < header_bytes) return {{}, Fault{name + " is not whole", at, true}};
  const core::ByteView header = file.subspan(at, header_bytes);
  const bool is_whole = is_old || core::crc32c(header.subspan(4)) == numberAt<std::uint32_t>(header, 0);
  if (!is_whole) return {{}, Fault{name + " does not match its checksum", at}};
  const auto length = numberAt<std::uint32_t>(header, is_old ? 0 : 4);
  if (auto fault = checkLength(name, length, at)) return {{}, fault};
  if (number) {
    if (auto fault = checkNumber(numberAt<std::uint64_t>(header, 8), *number, at)) return {{}, fault};
  }
  if (length > left - header_bytes) return {{}, Fault{name + " is not whole", at, true}};
  const core::ByteView payload = file.subspan(at + header_bytes, length);
  if (core::crc32c(payload) != numberAt<std::uint32_t>(header, header_bytes - 4))
    return {{}, Fault{name + " does not match its checksum", at}};
  return {payload, std::nullopt};
}

}  // namespace

FileName parseFileName(std::string_view name) {
  const std::string_view digits = name.substr(0, kDigitCount);
  std::uint64_t generation = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), generation);
  const bool is_number = digits.size() == kDigitCount && read.ec == std::errc() && generation > 0 &&
                         read.ptr == digits.data() + digits.size();
  if (!is_number) return {};
  std::string_view rest = name.substr(kDigitCount);
  const FileKind kind = rest.starts_with(kSnapshotSuffix) ? FileKind::kSnapshot
                        : rest.starts_with(kLogSuffix)    ? FileKind::kLog
                                                          : FileKind::kForeign;
  if (kind == FileKind::kForeign) return {};
  rest.remove_prefix(kind == FileKind::kSnapshot ? kSnapshotSuffix.size() : kLogSuffix.size());
  if (rest.empty()) return {kind, generation};
  if (rest == kTemporarySuffix) return {FileKind::kTemporary, 0};
  if (rest == ".damaged" || rest.starts_with(".damaged.")) return {FileKind::kSetAside, 0};
  return {};
}

std::string snapshotName(std::uint64_t generation) {
  return fmt::format("{:0{}}{}", generation, kDigitCount, kSnapshotSuffix);
}

std::string logName(std::uint64_t generation) {
  return fmt::format("{:0{}}{}", generation, kDigitCount, kLogSuffix);
}

core::Bytes snapshotHeader(const FileOwner& owner, std::uint64_t next_number, core::ByteView payload) {
  core::Bytes header = startOf(kSnapshotMagic, owner, next_number, kSnapshotHeaderBytes - kStartBytes);
  put(header.data() + kStartBytes, static_cast<std::uint64_t>(payload.size()));
  put(header.data() + kStartBytes + 8, core::crc32c(payload));
  putChecksum(header);
  return header;
}

core::Bytes logHeader(const FileOwner& owner, std::uint64_t first_number) {
  core::Bytes header = startOf(kLogMagic, owner, first_number, 0);
  putChecksum(header);
  return header;
}

std::array<std::uint8_t, kRecordHeaderBytes> recordHeader(std::uint64_t number, core::ByteView payload) {
  std::array<std::uint8_t, kRecordHeaderBytes> header{};
  put(header.data() + 4, static_cast<std::uint32_t>(payload.size()));
  put(header.data() + 8, number);
  put(header.data() + 16, core::crc32c(payload));
  put(header.data(), core::crc32c(core::ByteView(header).subspan(4)));
  return header;
}

ParsedSnapshot parseSnapshot(core::ByteView file, const FileOwner& owner) {
  const Start start = readStart(file, kSnapshotMagic, "snapshot", kSnapshotHeaderBytes, kOldSnapshotHeaderBytes, owner);
  if (start.fault) return {.payload = {}, .next_number = {}, .fault = start.fault};
  const auto refuse = [](std::string reason, std::uint64_t at_byte) {
    return ParsedSnapshot{.payload = {}, .next_number = {}, .fault = Fault{std::move(reason), at_byte}};
  };
  const std::size_t length_at = start.version == Version::kOld ? 16 : kStartBytes;
  const auto length = numberAt<std::uint64_t>(file, length_at);
  const core::ByteView payload = file.subspan(start.header_bytes);
  if (length > kSnapshotMaxBytes) {
    return refuse(
        fmt::format("it says that its content has {} bytes (at most {} are possible)", length, kSnapshotMaxBytes),
        length_at);
  }
  if (payload.size() != length) {
    return refuse(fmt::format("its content has {} bytes instead of {}", payload.size(), length),
                  start.header_bytes + std::min<std::uint64_t>(payload.size(), length));
  }
  if (core::crc32c(payload) != numberAt<std::uint32_t>(file, length_at + 8))
    return refuse("its content does not match its checksum", start.header_bytes);
  return {.payload = payload, .next_number = start.number, .fault = std::nullopt};
}

ParsedLog parseLog(core::ByteView file, const FileOwner& owner) {
  ParsedLog log;
  const Start start = readStart(file, kLogMagic, "log", kStartBytes, kOldLogHeaderBytes, owner);
  log.fault = start.fault;
  if (log.fault) return log;
  log.first_number = start.number;
  std::size_t at = start.header_bytes;
  while (at < file.size()) {
    std::optional<std::uint64_t> number;
    if (start.number) number = *start.number + log.records.size();
    const std::string name = "record " + std::to_string(number.value_or(log.records.size() + 1));
    const Found found = readRecord(file, at, start.version, name, number);
    log.fault = found.fault;
    if (log.fault) break;
    log.records.push_back(found.payload);
    at = static_cast<std::size_t>(found.payload.data() - file.data()) + found.payload.size();
  }
  log.whole_bytes = at;
  return log;
}

}  // namespace spindrift::state
