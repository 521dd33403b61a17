#include "file_format.h"

#include <string>

#include <gmock/gmock.h>

#include <spindrift/state/room_files.h>

#include "state_fixture.h"

namespace spindrift::state {
namespace {

using testing::HasSubstr;

template <typename Header>
std::string textOf(const Header& header) {
  return {header.begin(), header.end()};
}

std::string snapshotFile(std::uint64_t generation, const std::string& payload) {
  return textOf(snapshotHeader(generation, viewOf(payload))) + payload;
}

std::string logFile(std::uint64_t generation, const std::vector<std::string>& records) {
  std::string file = textOf(logHeader(generation));
  for (const std::string& record : records) file += textOf(recordHeader(viewOf(record))) + record;
  return file;
}

/// Returns the reason why the log has no further record after its header and these bytes.
std::string faultAfterHeader(const std::string& bytes) {
  const std::string file = logFile(1, {}) + bytes;
  const ParsedLog log = parseLog(viewOf(file), 1);
  EXPECT_TRUE(log.records.empty());
  return log.fault ? log.fault->reason : "none";
}

TEST(StateFormat, TheBytesOfASnapshotAreThoseOfTheDocument) {
  const std::string expected = std::string("spinsnp1") + std::string("\x02\0\0\0\0\0\0\0", 8) +
                               std::string("\x09\0\0\0\0\0\0\0", 8) + "\x83\x92\x06\xE3" + "123456789";
  EXPECT_EQ(snapshotFile(2, "123456789"), expected);
}

TEST(StateFormat, TheBytesOfALogAreThoseOfTheDocument) {
  const std::string expected = std::string("spinlog1") + std::string("\x02\x01\0\0\0\0\0\0", 8) +
                               std::string("\x09\0\0\0", 4) + "\x83\x92\x06\xE3" + "123456789";
  EXPECT_EQ(logFile(258, {"123456789"}), expected);
}

TEST(StateFormat, AnEmptySnapshotIsWhole) {
  const std::string file = snapshotFile(7, "");
  EXPECT_FALSE(parseSnapshot(viewOf(file), 7).fault);
}

TEST(StateFormat, LengthsThatTheFileDoesNotHaveAreRefused) {
  EXPECT_THAT(faultAfterHeader("\xff\xff\xff\xff....x"), HasSubstr("4294967295 bytes"));
  EXPECT_THAT(faultAfterHeader(std::string("\x01\x00\x80\x00....x", 9)), HasSubstr("8388609 bytes"));
  EXPECT_THAT(faultAfterHeader(std::string("\x00\x00\x80\x00....x", 9)), HasSubstr("not whole"));
  for (const std::uint64_t length :
       std::vector<std::uint64_t>{~0ull, 1ull << 63, kSnapshotMaxBytes + 1, kSnapshotMaxBytes, 6, 4, 0}) {
    std::string file = snapshotFile(1, "state");
    for (unsigned k = 0; k < 8; ++k) file[16 + k] = static_cast<char>(length >> (8 * k));
    const ParsedSnapshot parsed = parseSnapshot(viewOf(file), 1);
    ASSERT_TRUE(parsed.fault) << length;
    EXPECT_THAT(parsed.fault->reason, HasSubstr(std::to_string(length)));
    EXPECT_TRUE(parsed.payload.empty());
  }
}

TEST(StateFormat, ZerosAreNoRecord) {
  EXPECT_THAT(faultAfterHeader(std::string(8, '\0')), HasSubstr("length of 0 bytes"));
  EXPECT_THAT(faultAfterHeader(std::string(4096, '\0')), HasSubstr("length of 0 bytes"));
}

TEST(StateFormat, AFileOfAnotherVersionIsNamedAsSuch) {
  std::string snapshot = snapshotFile(1, "state"), log = logFile(1, {"record"});
  snapshot[7] = '2';
  EXPECT_THAT(parseSnapshot(viewOf(snapshot), 1).fault->reason, HasSubstr("a newer version of the program"));
  log[7] = '0';
  EXPECT_THAT(parseLog(viewOf(log), 1).fault->reason, HasSubstr("another version of the program"));
  EXPECT_THAT(parseLog(viewOf(snapshot), 1).fault->reason, HasSubstr("no log"));
  EXPECT_THAT(parseSnapshot(viewOf("GIF89a"), 1).fault->reason, HasSubstr("no snapshot"));
  EXPECT_THAT(parseSnapshot({}, 1).fault->reason, HasSubstr("ends within its header"));
}

TEST(StateFormat, AFileUnderTheNameOfAnotherGenerationIsRefused) {
  EXPECT_THAT(parseSnapshot(viewOf(snapshotFile(1, "state")), 2).fault->reason, HasSubstr("of generation 1"));
  const std::string log = logFile(3, {"record"});
  EXPECT_EQ(parseLog(viewOf(log), 2).whole_bytes, 0U);
}

}  // namespace
}  // namespace spindrift::state
