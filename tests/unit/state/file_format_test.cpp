#include "file_format.h"

#include <string>

#include <gmock/gmock.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/state/room_files.h>

#include "state_fixture.h"

namespace spindrift::state {
namespace {

using testing::HasSubstr;

constexpr const char* kRoom = "pool";

template <typename Header>
std::string textOf(const Header& header) {
  return {header.begin(), header.end()};
}

std::string snapshotFile(std::uint64_t generation, const std::string& payload, std::string_view room = kRoom,
                         std::uint64_t next_number = 1) {
  return textOf(snapshotHeader({room, generation}, next_number, viewOf(payload))) + payload;
}

std::string recordBytes(std::uint64_t number, const std::string& payload) {
  return textOf(recordHeader(number, viewOf(payload))) + payload;
}

/// A log whose first record has the number 5.
std::string logFile(std::uint64_t generation, const std::vector<std::string>& records, std::string_view room = kRoom) {
  std::string file = textOf(logHeader({room, generation}, 5));
  for (std::size_t k = 0; k < records.size(); ++k) file += recordBytes(5 + k, records[k]);
  return file;
}

ParsedSnapshot parsedSnapshot(const std::string& file, std::uint64_t generation = 1) {
  return parseSnapshot(viewOf(file), {kRoom, generation});
}

ParsedLog parsedLog(const std::string& file, std::uint64_t generation = 1) {
  return parseLog(viewOf(file), {kRoom, generation});
}

/// Returns the reason why the log has no further record after its header and these bytes.
std::string faultAfterHeader(const std::string& bytes) {
  const std::string file = logFile(1, {}) + bytes;
  const ParsedLog log = parsedLog(file);
  EXPECT_TRUE(log.records.empty());
  return log.fault ? log.fault->reason : "none";
}

/// A record's header with a right checksum and this length, and one byte.
std::string recordOfLength(std::uint32_t length) {
  std::string header = textOf(recordHeader(5, viewOf("x")));
  for (unsigned k = 0; k < 4; ++k) header[4 + k] = static_cast<char>(length >> (8 * k));
  const std::uint32_t crc = core::crc32c(viewOf(std::string_view(header).substr(4)));
  for (unsigned k = 0; k < 4; ++k) header[k] = static_cast<char>(crc >> (8 * k));
  return header + "x";
}

TEST(StateFormat, TheBytesOfASnapshotAreThoseOfTheDocument) {
  const std::string expected = std::string("spinsnp2") + "\x87\xA4\x0B\x9D" + std::string("\x04\0\0\0", 4) +
                               std::string("\x02\0\0\0\0\0\0\0", 8) + std::string("\x07\0\0\0\0\0\0\0", 8) +
                               std::string("\x09\0\0\0\0\0\0\0", 8) + "\x83\x92\x06\xE3" + "pool" + "123456789";
  EXPECT_EQ(snapshotFile(2, "123456789", kRoom, 7), expected);
}

TEST(StateFormat, TheBytesOfALogAreThoseOfTheDocument) {
  const std::string expected = std::string("spinlog2") + "\x20\x84\x11\xF1" + std::string("\x04\0\0\0", 4) +
                               std::string("\x02\x01\0\0\0\0\0\0", 8) + std::string("\x05\0\0\0\0\0\0\0", 8) + "pool" +
                               "\xDD\x2E\xE8\xD0" + std::string("\x09\0\0\0", 4) +
                               std::string("\x05\0\0\0\0\0\0\0", 8) + "\x83\x92\x06\xE3" + "123456789";
  EXPECT_EQ(logFile(258, {"123456789"}), expected);
}

TEST(StateFormat, AnEmptySnapshotIsWhole) {
  EXPECT_FALSE(parsedSnapshot(snapshotFile(7, ""), 7).fault);
}

TEST(StateFormat, LengthsThatTheFileDoesNotHaveAreRefused) {
  EXPECT_THAT(faultAfterHeader(recordOfLength(~0u)), HasSubstr("4294967295 bytes"));
  EXPECT_THAT(faultAfterHeader(recordOfLength((8u << 20) + 1)), HasSubstr("8388609 bytes"));
  EXPECT_THAT(faultAfterHeader(recordOfLength(8u << 20)), HasSubstr("not whole"));
  EXPECT_THAT(faultAfterHeader(recordOfLength(0)), HasSubstr("length of 0 bytes"));
  for (const std::uint64_t length :
       std::vector<std::uint64_t>{~0ull, 1ull << 63, kSnapshotMaxBytes + 1, kSnapshotMaxBytes, 6, 4, 0}) {
    std::string file = snapshotFile(1, "state");
    for (unsigned k = 0; k < 8; ++k) file[kStartBytes + k] = static_cast<char>(length >> (8 * k));
    const std::string header = file.substr(12, kSnapshotHeaderBytes + 4 - 12);
    const std::uint32_t crc = core::crc32c(viewOf(header));
    for (unsigned k = 0; k < 4; ++k) file[8 + k] = static_cast<char>(crc >> (8 * k));
    const ParsedSnapshot parsed = parsedSnapshot(file);
    ASSERT_TRUE(parsed.fault) << length;
    EXPECT_THAT(parsed.fault->reason, HasSubstr(std::to_string(length)));
    EXPECT_TRUE(parsed.payload.empty());
  }
}

TEST(StateFormat, ZerosAreNoRecord) {
  EXPECT_THAT(faultAfterHeader(std::string(20, '\0')), HasSubstr("checksum"));
  EXPECT_THAT(faultAfterHeader(std::string(4096, '\0')), HasSubstr("checksum"));
}

TEST(StateFormat, AFileOfAnotherVersionIsNamedAsSuch) {
  std::string snapshot = snapshotFile(1, "state"), log = logFile(1, {"record"});
  snapshot[7] = '3';
  EXPECT_THAT(parsedSnapshot(snapshot).fault->reason, HasSubstr("a newer version of the program"));
  log[7] = '0';
  EXPECT_THAT(parsedLog(log).fault->reason, HasSubstr("another version of the program"));
  EXPECT_THAT(parsedLog(snapshot).fault->reason, HasSubstr("not a log"));
  EXPECT_THAT(parsedSnapshot("GIF89a").fault->reason, HasSubstr("not a snapshot"));
  EXPECT_THAT(parsedSnapshot("").fault->reason, HasSubstr("ends within its header"));
}

TEST(StateFormat, AFileUnderTheNameOfAnotherGenerationIsRefused) {
  EXPECT_THAT(parsedSnapshot(snapshotFile(1, "state"), 2).fault->reason, HasSubstr("of generation 1"));
  EXPECT_EQ(parsedLog(logFile(3, {"record"}), 2).whole_bytes, 0U);
}

TEST(StateFormat, AFileOfAnotherRoomIsRefused) {
  EXPECT_THAT(parsedSnapshot(snapshotFile(1, "state", "quay")).fault->reason,
              HasSubstr("it is of the room 'quay', its folder is that of 'pool'"));
  const std::string log = logFile(1, {"record"}, "quay");
  EXPECT_THAT(parsedLog(log).fault->reason, HasSubstr("it is of the room 'quay'"));
  EXPECT_TRUE(parsedLog(log).records.empty());
}

TEST(StateFormat, RecordsOutOfOrderAreRefused) {
  const std::string start = logFile(1, {"a"});
  const auto faultOf = [&](const std::string& bytes) {
    const std::string file = start + bytes;
    const ParsedLog log = parsedLog(file);
    EXPECT_EQ(log.records.size(), 1U);
    EXPECT_EQ(log.whole_bytes, start.size());
    return log.fault ? log.fault->reason : "none";
  };
  EXPECT_EQ(faultOf(recordBytes(6, "b").substr(0, 20)), "record 6 is not whole");
  EXPECT_EQ(faultOf(recordBytes(5, "a")), "record 5 stands where record 6 follows");
  EXPECT_EQ(faultOf(recordBytes(7, "c") + recordBytes(6, "b")), "the records 6 to 6 are missing");
  EXPECT_EQ(faultOf(recordBytes(9, "e")), "the records 6 to 8 are missing");
}

TEST(StateFormat, FilesOfTheVersionBeforeAreRead) {
  const std::string snapshot = std::string("spinsnp1") + std::string("\x02\0\0\0\0\0\0\0", 8) +
                               std::string("\x09\0\0\0\0\0\0\0", 8) + "\x83\x92\x06\xE3" + "123456789";
  const ParsedSnapshot state = parsedSnapshot(snapshot, 2);
  ASSERT_FALSE(state.fault) << state.fault->reason;
  EXPECT_EQ(state::textOf(state.payload), "123456789");
  EXPECT_FALSE(state.next_number);
  constexpr std::string_view kRecord(
      "\x09\0\0\0\x83\x92\x06\xE3"
      "123456789",
      17);
  std::string file("spinlog1\x02\x01\0\0\0\0\0\0", 16);
  for (int k = 0; k < 2; ++k) file.append(kRecord);
  const ParsedLog log = parsedLog(file, 258);
  ASSERT_FALSE(log.fault) << log.fault->reason;
  EXPECT_EQ(log.records.size(), 2U);
  EXPECT_FALSE(log.first_number);
  EXPECT_TRUE(parsedLog(file, 257).fault) << "of another generation";
  EXPECT_TRUE(parsedSnapshot(snapshot.substr(0, snapshot.size() - 1), 2).fault);
}

}  // namespace
}  // namespace spindrift::state
