// The files of a room's state: a byte that says what is tried, then the file. Checksums would stop almost every random
// change before the checks after them, so half of the inputs get the right ones first.
#include <algorithm>
#include <string_view>

#include <spindrift/core/bytes.h>
#include <spindrift/core/crc32c.h>

#include "file_format.h"
#include "fuzz.h"

namespace spindrift::fuzz {
namespace {

std::uint64_t numberAt(core::ByteView bytes, std::size_t at, std::size_t byte_count) {
  std::uint64_t number = 0;
  for (std::size_t k = 0; k < byte_count && at + k < bytes.size(); ++k)
    number |= std::uint64_t{bytes[at + k]} << (8 * k);
  return number;
}

void checkFault(const state::Fault& fault, core::ByteView file) {
  must(!fault.reason.empty() && std::ranges::none_of(fault.reason, [](char c) { return c >= 0 && c < ' '; }),
       "a fault has a reason of one line");
  must(fault.at_byte <= std::max<std::size_t>(file.size(), state::kSnapshotHeaderBytes), "a fault is in the file");
}

bool begins(core::ByteView bytes, core::ByteView header) {
  return bytes.size() >= header.size() && std::ranges::equal(bytes.first(header.size()), header);
}

bool isOld(core::ByteView file) {
  return file[state::kMagicBytes - 1] == '1';
}

void trySnapshot(core::ByteView file, const state::FileOwner& owner) {
  const state::ParsedSnapshot parsed = state::parseSnapshot(file, owner);
  if (parsed.fault) {
    checkFault(*parsed.fault, file);
    must(parsed.payload.empty(), "a damaged snapshot gives nothing");
    return;
  }
  must(parsed.next_number.has_value() != isOld(file), "only a snapshot of the version before has no number");
  if (parsed.next_number) {
    must(begins(file, state::snapshotHeader(owner, *parsed.next_number, parsed.payload)),
         "a snapshot that is read would be written so");
  }
  must(std::ranges::equal(file.last(parsed.payload.size()), parsed.payload), "all of its content is read");
}

void tryLog(core::ByteView file, const state::FileOwner& owner) {
  const state::ParsedLog parsed = state::parseLog(file, owner);
  if (parsed.fault) checkFault(*parsed.fault, file);
  must(parsed.whole_bytes <= file.size(), "no more is whole than there is");
  must(parsed.fault.has_value() == (parsed.whole_bytes < file.size() || file.empty()),
       "a log without a fault is whole");
  if (parsed.whole_bytes == 0) {
    must(parsed.records.empty(), "a log without a header gives nothing");
    return;
  }
  must(parsed.first_number.has_value() != isOld(file), "only a log of the version before has no number");
  if (!parsed.first_number) return;
  const core::Bytes start = state::logHeader(owner, *parsed.first_number);
  must(begins(file, start), "a log that is read begins as it would be written");
  std::size_t at = start.size();
  std::uint64_t number = *parsed.first_number;
  for (const core::ByteView record : parsed.records) {
    must(!record.empty(), "no record is empty");
    must(begins(file.subspan(at), state::recordHeader(number++, record)), "a record that is read would be written so");
    at += state::kRecordHeaderBytes;
    must(std::ranges::equal(file.subspan(at, record.size()), record), "its bytes are those of the file");
    at += record.size();
  }
  must(at == parsed.whole_bytes, "the whole part ends with the last record");
}

/// Writes the CRC-32C of the bytes between `from` and `to` at `at`.
void repair(core::Bytes& file, std::size_t at, std::size_t from, std::size_t to) {
  const std::uint32_t crc = core::crc32c(core::ByteView(file).subspan(from, to - from));
  for (std::size_t k = 0; k < 4; ++k) file[at + k] = static_cast<std::uint8_t>(crc >> (8 * k));
}

/// Returns the room's name in the file, whose kind has a header of `header_bytes` before it.
std::string_view roomIn(core::ByteView file, std::size_t header_bytes) {
  if (file.size() < header_bytes) return "";
  const std::size_t length = std::min<std::size_t>(numberAt(file, 12, 4), file.size() - header_bytes);
  return {reinterpret_cast<const char*>(file.data()) + header_bytes, length};
}

/// Writes the checksums of the header and of each record that is whole.
void repairLog(core::Bytes& file) {
  if (file.size() < state::kStartBytes) return;
  std::size_t at = state::kStartBytes + roomIn(file, state::kStartBytes).size();
  repair(file, state::kMagicBytes, 12, at);
  while (at + state::kRecordHeaderBytes <= file.size()) {
    const std::uint64_t length = numberAt(file, at + 4, 4);
    const std::size_t payload = at + state::kRecordHeaderBytes;
    if (length > file.size() - payload) return;
    repair(file, at + 16, payload, payload + length);
    repair(file, at, at + 4, payload);
    at = payload + length;
  }
}

/// Writes the checksums of the content and of the header.
void repairSnapshot(core::Bytes& file) {
  if (file.size() < state::kSnapshotHeaderBytes) return;
  const std::size_t payload = state::kSnapshotHeaderBytes + roomIn(file, state::kSnapshotHeaderBytes).size();
  repair(file, 40, payload, file.size());
  repair(file, state::kMagicBytes, 12, payload);
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  if (size == 0) return 0;
  core::Bytes snapshot(data + 1, data + size);
  core::Bytes log = snapshot;
  const bool is_repaired = (data[0] & 1) != 0, is_of_its_name = (data[0] & 2) == 0;
  if (is_repaired) {
    fuzz::repairSnapshot(snapshot);
    fuzz::repairLog(log);
  }
  const bool is_old = log.size() >= state::kMagicBytes && fuzz::isOld(log);
  const std::uint64_t generation = is_of_its_name ? fuzz::numberAt(log, is_old ? 8 : 16, 8) : 1;
  fuzz::trySnapshot(snapshot,
                    {is_of_its_name ? fuzz::roomIn(snapshot, state::kSnapshotHeaderBytes) : "pool", generation});
  fuzz::tryLog(log, {is_of_its_name ? fuzz::roomIn(log, state::kStartBytes) : "pool", generation});
  return 0;
}
