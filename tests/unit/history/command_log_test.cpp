#include <fstream>

#include <gmock/gmock.h>

#include <spindrift/history/command_log.h>

#include "temporary_folder.h"

namespace spindrift::history {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

struct CommandLogTest : testing::Test {
  test::TemporaryFolder folder;

  v1::RecordHeader header() const {
    v1::RecordHeader out;
    out.set_room("main");
    out.mutable_scene()->set_name("pond");
    out.set_hash_interval_ticks(60);
    return out;
  }

  static gpu::DeviceInfo device(std::string name, std::string gl_version) {
    gpu::DeviceInfo out;
    out.name = std::move(name);
    out.gl_version = std::move(gl_version);
    return out;
  }

  /// A log of `count` splashes at ticks 0, 1, 2, ...
  fs::path written(std::uint64_t count) const {
    auto log = CommandLogWriter::create(folder.path(), header());
    EXPECT_TRUE(log) << log.error().message;
    for (std::uint64_t tick = 0; tick < count; ++tick) {
      v1::Record record;
      record.set_tick(tick);
      record.mutable_command()->mutable_splash()->set_x_m(0.5);
      (*log)->write(record);
    }
    return (*log)->file();
  }

  static std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path withBytes(const std::string& bytes) const {
    fs::path file = folder.path() / "other.spinrec";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  static std::size_t recordCount(CommandLogReader& log) {
    std::size_t count = 0;
    while (log.next()) ++count;
    return count;
  }
};

TEST_F(CommandLogTest, ReadsWhatWasWritten) {
  const auto log = CommandLogReader::open(written(5));
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ((*log)->header().room(), "main");
  EXPECT_EQ((*log)->header().scene().name(), "pond");
  const auto first = (*log)->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->command().splash().x_m(), 0.5);
  EXPECT_EQ(recordCount(**log), 4U);
  EXPECT_FALSE((*log)->truncation());
}

TEST_F(CommandLogTest, RecordsThatAreDroppedDoubledOrExchangedEndTheLog) {
  const std::string whole = bytesOf(written(3));
  std::vector<std::string> records;
  for (std::size_t at = 8; at < whole.size(); at += records.back().size())
    records.push_back(whole.substr(at, 8 + static_cast<unsigned char>(whole[at])));
  ASSERT_EQ(records.size(), 4U) << "the header and three splashes";
  for (const std::vector<std::size_t>& order :
       std::vector<std::vector<std::size_t>>{{0, 1, 3}, {0, 1, 1, 2, 3}, {0, 1, 3, 2}}) {
    std::string bytes = whole.substr(0, 8);
    for (const std::size_t k : order) bytes += records[k];
    const auto log = CommandLogReader::open(withBytes(bytes));
    ASSERT_TRUE(log);
    EXPECT_EQ(recordCount(**log), 1U);
    ASSERT_TRUE((*log)->truncation());
    EXPECT_THAT(*(*log)->truncation(), HasSubstr("stands where record 3 follows"));
  }
}

TEST_F(CommandLogTest, ATruncatedLogGivesItsWholeRecordsAndThePlaceOfItsEnd) {
  const std::string whole = bytesOf(written(3));
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto log = CommandLogReader::open(withBytes(whole.substr(0, size)));
    if (!log) continue;  // not even a header
    const std::size_t count = recordCount(**log);
    EXPECT_GE(count, most);
    most = std::max(most, count);
    EXPECT_LT(count, 3U);
    EXPECT_THAT((*log)->truncation().value_or("at byte"), HasSubstr("at byte"));
  }
  EXPECT_EQ(most, 2U);
}

TEST_F(CommandLogTest, ADamagedRecordEndsIt) {
  const std::string whole = bytesOf(written(3));
  for (const std::size_t from_end : {1U, 5U, 20U}) {
    std::string damaged = whole;
    damaged[damaged.size() - from_end] ^= 0x20;
    const auto log = CommandLogReader::open(withBytes(damaged));
    ASSERT_TRUE(log);
    EXPECT_LT(recordCount(**log), 3U);
    EXPECT_TRUE((*log)->truncation()) << from_end;
  }
}

TEST_F(CommandLogTest, OtherFilesAreRefusedWithTheReason) {
  EXPECT_THAT(CommandLogReader::open(folder.path() / "none").error().message, HasSubstr("there is no log"));
  EXPECT_THAT(CommandLogReader::open(folder.path()).error().message, HasSubstr("there is no log"));
  EXPECT_THAT(CommandLogReader::open(withBytes("")).error().message, HasSubstr("spinrec1"));
  EXPECT_THAT(CommandLogReader::open(withBytes("spinrec1")).error().message, HasSubstr("no header"));
  EXPECT_THAT(CommandLogReader::open(withBytes("spinrec1\xff\xff\xff\xff....")).error().message,
              HasSubstr("no header"));
}

TEST_F(CommandLogTest, AFolderThatCannotBeWrittenIsNamed) {
  folder.write("file", "not a folder");
  const auto log = CommandLogWriter::create(folder.path() / "file", header());
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, HasSubstr("--record"));
  EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
}

TEST_F(CommandLogTest, KnowsTheDeviceAndDriverThatItWasRecordedWith) {
  v1::RecordHeader recorded = header();
  const gpu::DeviceInfo here = device("llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6");
  describeDevice(recorded, here);
  EXPECT_FALSE(deviceDifference(recorded, here));
  const auto other_driver = deviceDifference(recorded, device(here.name, "4.5 (Core Profile) Mesa 24.0.1"));
  ASSERT_TRUE(other_driver) << "the same renderer with another driver";
  EXPECT_THAT(*other_driver, AllOf(HasSubstr("Mesa 22.3.6"), HasSubstr("Mesa 24.0.1")));
  const auto other_device = deviceDifference(recorded, device("NVIDIA H100", "4.6.0 NVIDIA 550.54"));
  ASSERT_TRUE(other_device);
  EXPECT_THAT(*other_device, AllOf(HasSubstr("llvmpipe"), HasSubstr("NVIDIA H100")));
}

TEST_F(CommandLogTest, OlderLogsWithoutADriverVersionAreReadAndSaySo) {
  v1::RecordHeader older = header();
  older.set_device("llvmpipe");
  auto written = CommandLogWriter::create(folder.path() / "older", older);
  ASSERT_TRUE(written);
  const auto log = CommandLogReader::open((*written)->file());
  ASSERT_TRUE(log) << log.error().message;
  const auto difference = deviceDifference((*log)->header(), device("llvmpipe", "4.5 Mesa 22.3.6"));
  ASSERT_TRUE(difference);
  EXPECT_THAT(*difference, HasSubstr("does not say"));
}

}  // namespace
}  // namespace spindrift::history
