#include "file_format.h"

#include <algorithm>
#include <string_view>

#include <spindrift/core/crc32c.h>
#include <spindrift/state/room_files.h>

namespace spindrift::state {
namespace {

constexpr std::string_view kSnapshotMagic = "spinsnp1";
constexpr std::string_view kLogMagic = "spinlog1";
static_assert(kSnapshotMagic.size() == kMagicBytes && kLogMagic.size() == kMagicBytes);

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

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Checks magic and generation, which both kinds of files begin with. `kind` is "snapshot" or "log".
std::optional<Fault> checkStart(core::ByteView file, std::string_view magic, std::string_view kind,
                                std::size_t header_bytes, std::uint64_t generation) {
  const std::string_view start = textOf(file.first(std::min(file.size(), kMagicBytes)));
  if (start.size() == kMagicBytes && start != magic && start.starts_with(magic.substr(0, kMagicBytes - 1)) &&
      isDigit(start.back())) {
    return Fault{"it was written by " + std::string(start.back() > magic.back() ? "a newer" : "another") +
                     " version of the program, in the format " + std::string(start) + " (this version reads " +
                     std::string(magic) + "); that version can use it under its old name",
                 kMagicBytes - 1};
  }
  if (!magic.starts_with(start))
    return Fault{"it is no " + std::string(kind) + ": it does not begin with " + std::string(magic), 0};
  if (file.size() < header_bytes) return Fault{"it ends within its header", file.size()};
  if (const auto found = numberAt<std::uint64_t>(file, kMagicBytes); found != generation) {
    return Fault{
        "it says that it is of generation " + std::to_string(found) + ", its name says " + std::to_string(generation),
        kMagicBytes};
  }
  return std::nullopt;
}

/// Returns why no whole record begins at `at`; `number` counts records from 1.
std::optional<Fault> checkRecord(core::ByteView file, std::size_t at, std::size_t number) {
  const std::string name = "record " + std::to_string(number);
  const std::size_t left = file.size() - at;
  if (left < kRecordHeaderBytes) return Fault{name + " is not whole", at, true};
  const auto length = numberAt<std::uint32_t>(file, at);
  if (length == 0 || length > kRecordMaxBytes) {
    return Fault{name + " has a length of " + std::to_string(length) + " bytes (1 to " +
                     std::to_string(kRecordMaxBytes) + " are possible)",
                 at};
  }
  if (length > left - kRecordHeaderBytes) return Fault{name + " is not whole", at, true};
  if (core::crc32c(file.subspan(at + kRecordHeaderBytes, length)) != numberAt<std::uint32_t>(file, at + 4))
    return Fault{name + " does not match its checksum", at};
  return std::nullopt;
}

}  // namespace

std::array<std::uint8_t, kSnapshotHeaderBytes> snapshotHeader(std::uint64_t generation, core::ByteView payload) {
  std::array<std::uint8_t, kSnapshotHeaderBytes> header{};
  std::ranges::copy(kSnapshotMagic, header.begin());
  put(header.data() + 8, generation);
  put(header.data() + 16, static_cast<std::uint64_t>(payload.size()));
  put(header.data() + 24, core::crc32c(payload));
  return header;
}

std::array<std::uint8_t, kLogHeaderBytes> logHeader(std::uint64_t generation) {
  std::array<std::uint8_t, kLogHeaderBytes> header{};
  std::ranges::copy(kLogMagic, header.begin());
  put(header.data() + 8, generation);
  return header;
}

std::array<std::uint8_t, kRecordHeaderBytes> recordHeader(core::ByteView payload) {
  std::array<std::uint8_t, kRecordHeaderBytes> header{};
  put(header.data(), static_cast<std::uint32_t>(payload.size()));
  put(header.data() + 4, core::crc32c(payload));
  return header;
}

ParsedSnapshot parseSnapshot(core::ByteView file, std::uint64_t generation) {
  if (auto fault = checkStart(file, kSnapshotMagic, "snapshot", kSnapshotHeaderBytes, generation)) return {{}, fault};
  const auto length = numberAt<std::uint64_t>(file, 16);
  const core::ByteView payload = file.subspan(kSnapshotHeaderBytes);
  if (length > kSnapshotMaxBytes) {
    return {{},
            Fault{"it says that its content has " + std::to_string(length) + " bytes (at most " +
                      std::to_string(kSnapshotMaxBytes) + " are possible)",
                  16}};
  }
  if (payload.size() != length) {
    return {{},
            Fault{"its content has " + std::to_string(payload.size()) + " bytes instead of " + std::to_string(length),
                  kSnapshotHeaderBytes + std::min<std::uint64_t>(payload.size(), length)}};
  }
  if (core::crc32c(payload) != numberAt<std::uint32_t>(file, 24))
    return {{}, Fault{"its content does not match its checksum", kSnapshotHeaderBytes}};
  return {payload, std::nullopt};
}

ParsedLog parseLog(core::ByteView file, std::uint64_t generation) {
  ParsedLog log;
  log.fault = checkStart(file, kLogMagic, "log", kLogHeaderBytes, generation);
  if (log.fault) return log;
  std::size_t at = kLogHeaderBytes;
  while (at < file.size()) {
    log.fault = checkRecord(file, at, log.records.size() + 1);
    if (log.fault) break;
    const auto length = numberAt<std::uint32_t>(file, at);
    log.records.push_back(file.subspan(at + kRecordHeaderBytes, length));
    at += kRecordHeaderBytes + length;
  }
  log.whole_bytes = at;
  return log;
}

}  // namespace spindrift::state
