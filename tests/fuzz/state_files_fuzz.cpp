// The files of a room's state: a byte that says what is tried, then the file. Checksums would stop almost every random
// change before the checks after them, so half of the inputs get the right ones first.
#include <algorithm>
#include <array>

#include <spindrift/core/bytes.h>

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
  must(fault.at_byte <= file.size() || fault.at_byte <= state::kSnapshotHeaderBytes, "a fault is in the file");
}

template <typename Header>
bool begins(core::ByteView bytes, const Header& header) {
  return bytes.size() >= header.size() && std::ranges::equal(bytes.first(header.size()), header);
}

void trySnapshot(core::ByteView file, std::uint64_t generation) {
  const state::ParsedSnapshot parsed = state::parseSnapshot(file, generation);
  if (parsed.fault) {
    checkFault(*parsed.fault, file);
    must(parsed.payload.empty(), "a damaged snapshot gives nothing");
    return;
  }
  must(begins(file, state::snapshotHeader(generation, parsed.payload)), "a snapshot that is read would be written so");
  must(std::ranges::equal(file.subspan(state::kSnapshotHeaderBytes), parsed.payload), "all of its content is read");
}

void tryLog(core::ByteView file, std::uint64_t generation) {
  const state::ParsedLog parsed = state::parseLog(file, generation);
  if (parsed.fault) checkFault(*parsed.fault, file);
  must(parsed.whole_bytes <= file.size(), "no more is whole than there is");
  must(parsed.fault.has_value() == (parsed.whole_bytes < file.size() || file.empty()),
       "a log without a fault is whole");
  if (parsed.whole_bytes == 0) {
    must(parsed.records.empty(), "a log without a header gives nothing");
    return;
  }
  must(begins(file, state::logHeader(generation)), "a log that is read begins as it would be written");
  std::size_t at = state::kLogHeaderBytes;
  for (const core::ByteView record : parsed.records) {
    must(!record.empty(), "no record is empty");
    must(begins(file.subspan(at), state::recordHeader(record)), "a record that is read would be written so");
    at += state::kRecordHeaderBytes;
    must(std::ranges::equal(file.subspan(at, record.size()), record), "its bytes are those of the file");
    at += record.size();
  }
  must(at == parsed.whole_bytes, "the whole part ends with the last record");
}

/// Writes the checksum of each record that is whole.
void repairLog(core::Bytes& file) {
  std::size_t at = state::kLogHeaderBytes;
  while (at + state::kRecordHeaderBytes <= file.size()) {
    const std::uint64_t length = numberAt(file, at, 4);
    if (length > file.size() - at - state::kRecordHeaderBytes) return;
    const auto header = state::recordHeader(core::ByteView(file).subspan(at + state::kRecordHeaderBytes, length));
    std::ranges::copy(header, file.begin() + static_cast<std::ptrdiff_t>(at));
    at += state::kRecordHeaderBytes + length;
  }
}

/// Writes the checksum of the content.
void repairSnapshot(core::Bytes& file) {
  if (file.size() < state::kSnapshotHeaderBytes) return;
  const auto header = state::snapshotHeader(0, core::ByteView(file).subspan(state::kSnapshotHeaderBytes));
  std::copy(header.begin() + 24, header.end(), file.begin() + 24);
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  if (size == 0) return 0;
  core::Bytes file(data + 1, data + size);
  const bool is_repaired = (data[0] & 1) != 0, is_of_its_name = (data[0] & 2) == 0;
  const std::uint64_t generation = is_of_its_name ? fuzz::numberAt(file, state::kMagicBytes, 8) : 1;
  core::Bytes log = file;
  if (is_repaired) {
    fuzz::repairSnapshot(file);
    fuzz::repairLog(log);
  }
  fuzz::trySnapshot(file, generation);
  fuzz::tryLog(log, generation);
  return 0;
}
