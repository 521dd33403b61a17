// Series of files: names, bounds, new files, and disks that break.
#include <csignal>

#include <sys/resource.h>

#include <spindrift/recording/recording_files.h>

#include "recording_test.h"
#include "temporary_folder.h"

namespace spindrift::recording {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Outcome = RecordingFiles::Outcome;

struct RecordingFilesTest : testing::Test {
  static FilesSetup setup(std::optional<std::uint64_t> file_max_bytes, std::uint64_t max_bytes) {
    return {.folder = "/", .name = "run", .file_max_bytes = file_max_bytes, .max_bytes = max_bytes};
  }
  RecordingFiles begin(std::optional<std::uint64_t> file_max_bytes, std::uint64_t max_bytes) {
    auto files = RecordingFiles::begin(setup(file_max_bytes, max_bytes), disk.opener());
    EXPECT_TRUE(files);
    return *std::move(files);
  }
  core::Result<Outcome> add(RecordingFiles& files, const Topic& topic, bool is_whole, std::size_t bytes = 100'000) {
    const std::string data = noise(bytes, static_cast<std::uint32_t>(++now_ns));
    return files.add({.topic = topic, .data = core::viewOf(data), .is_whole = is_whole, .log_time_ns = now_ns});
  }
  static Topic topic(const std::string& name) {
    return {.name = name, .schema_name = "x.Y", .descriptor_set = core::share({1, 2, 3})};
  }

  MemoryDisk disk;
  Topic surface = topic("/surface");
  Topic foam = topic("/foam");
  std::uint64_t now_ns = 0;
};

TEST_F(RecordingFilesTest, NamesAreNotPaths) {
  for (const char* const good : {"a", "run_1", "2026-11-28"}) EXPECT_TRUE(isRecordingName(good)) << good;
  for (const char* const bad : {"", ".", "..", "../x", "a/b", "a.mcap", "a b", "\xc3\xa4"})
    EXPECT_FALSE(isRecordingName(bad)) << bad;
  EXPECT_TRUE(isRecordingName(std::string(kNameMaxBytes, 'a')));
  EXPECT_FALSE(isRecordingName(std::string(kNameMaxBytes + 1, 'a')));
  EXPECT_FALSE(isRecordingName(std::string_view("a\0b", 3)));
}

TEST_F(RecordingFilesTest, BoundsOutOfRangeAreRefused) {
  EXPECT_TRUE(checkBounds(setup(kMiB, 10 * kMiB)));
  EXPECT_THAT(checkBounds(setup(kMiB - 1, 10 * kMiB)).error().message, HasSubstr("1048575 bytes"));
  EXPECT_THAT(checkBounds(setup(kMiB, kMiB - 1)).error().message, HasSubstr("from 1048576 to"));
  EXPECT_FALSE(checkBounds(setup(std::nullopt, kRecordingMaxBytes + 1)));
  EXPECT_FALSE(checkBounds(setup(kMiB, 1001 * kMiB))) << "more than 1000 files";
}

TEST_F(RecordingFilesTest, FileThatExistsIsNotReplaced) {
  const test::TemporaryFolder folder;
  folder.write("run.mcap", "precious");
  FilesSetup wanted = setup(std::nullopt, kMiB);
  wanted.folder = folder.path();
  const auto files = RecordingFiles::begin(wanted);
  ASSERT_FALSE(files);
  EXPECT_THAT(files.error().message, HasSubstr("run.mcap exists already"));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "run.mcap"), 8u);
}

TEST_F(RecordingFilesTest, DeltasStayInTheirFileUntilEachTopicHasAKeyframeInTheNext) {
  RecordingFiles files = begin(kMiB, 10 * kMiB);
  ASSERT_EQ(*add(files, surface, true), Outcome::kWritten);
  ASSERT_EQ(*add(files, foam, true), Outcome::kWritten);
  auto outcome = add(files, surface, false);
  int delta_count = 0;
  for (; *outcome == Outcome::kWritten; ++delta_count) outcome = add(files, surface, false);
  EXPECT_EQ(*outcome, Outcome::kNewFile);
  EXPECT_EQ(delta_count, 7) << "of 100 kB each, in 7/8 of a file";
  EXPECT_THAT(files.names(), ElementsAre("run_0001.mcap", "run_0002.mcap"));
  ASSERT_EQ(*add(files, surface, false, 1000), Outcome::kWritten);
  EXPECT_FALSE(disk.contains("run_0002.mcap", "/surface"));
  ASSERT_EQ(*add(files, surface, true), Outcome::kWritten);
  ASSERT_EQ(*add(files, foam, false, 1000), Outcome::kWritten) << "still the first file's";
  ASSERT_EQ(*add(files, foam, true, 1000), Outcome::kWritten);
  ASSERT_EQ(*add(files, surface, false), Outcome::kWritten);
  // The first file is finished; the second has both topics.
  EXPECT_EQ(disk.files["run_0001.mcap"].back(), '\n');
  ASSERT_TRUE(files.finish());
  for (const auto& [name, content] : disk.files) {
    EXPECT_LE(content.size(), kMiB) << name;
    EXPECT_TRUE(disk.contains(name, "/surface")) << name;
    EXPECT_TRUE(disk.contains(name, "/foam")) << name;
  }
}

TEST_F(RecordingFilesTest, DeltaWithoutItsPredecessorIsSkipped) {
  RecordingFiles files = begin(kMiB, 10 * kMiB);
  EXPECT_EQ(*add(files, surface, false), Outcome::kSkipped);
  EXPECT_EQ(*add(files, surface, true), Outcome::kWritten);
  EXPECT_EQ(*add(files, surface, false), Outcome::kWritten);
  EXPECT_EQ(*add(files, surface, false, kMiB / 2 + 1), Outcome::kSkipped) << "over half of a file";
  EXPECT_EQ(*add(files, surface, false), Outcome::kSkipped) << "builds on the one before";
  EXPECT_EQ(*add(files, surface, true), Outcome::kWritten);
}

TEST_F(RecordingFilesTest, FileBeforeIsFinishedAfterItsTimeWithoutKeyframes) {
  RecordingFiles files = begin(kMiB, 10 * kMiB);
  ASSERT_EQ(*add(files, surface, true), Outcome::kWritten);
  while (*add(files, surface, false) == Outcome::kWritten) {
  }
  ASSERT_EQ(*add(files, surface, false, 10), Outcome::kWritten);
  const std::chrono::nanoseconds more = RecordingFiles::kHandoverMax + std::chrono::seconds(1);
  ASSERT_TRUE(files.review(now_ns + static_cast<std::uint64_t>(more.count())));
  EXPECT_EQ(*add(files, surface, false, 10), Outcome::kSkipped);
  EXPECT_EQ(*add(files, surface, true, 10), Outcome::kWritten);
}

TEST_F(RecordingFilesTest, OpenChunkIsWrittenAfterASecond) {
  RecordingFiles files = begin(std::nullopt, 10 * kMiB);
  ASSERT_EQ(*add(files, surface, true), Outcome::kWritten);
  ASSERT_TRUE(files.review(now_ns + 999'000'000));
  EXPECT_LT(files.writtenBytes(), 1000u);
  ASSERT_TRUE(files.review(now_ns + 1'000'000'000));
  EXPECT_GT(files.writtenBytes(), 100'000u);
}

TEST_F(RecordingFilesTest, BoundOfAllFilesHolds) {
  for (const auto file_max_bytes : {std::optional<std::uint64_t>(kMiB), std::optional<std::uint64_t>()}) {
    disk.files.clear();
    RecordingFiles files = begin(file_max_bytes, 5 * kMiB / 2);
    int count = 0;
    auto outcome = add(files, surface, true);
    for (; *outcome != Outcome::kFull; outcome = add(files, surface, true)) count += *outcome == Outcome::kWritten;
    ASSERT_TRUE(files.finish());
    std::uint64_t total_bytes = 0;
    for (const auto& [name, content] : disk.files) total_bytes += content.size();
    EXPECT_LE(total_bytes, 5 * kMiB / 2);
    EXPECT_GT(count, 20);
    EXPECT_EQ(files.writtenBytes(), total_bytes);
  }
}

TEST_F(RecordingFilesTest, FullDiskIsReportedAndTheFilesAreFinished) {
  disk.max_bytes = 3 * kMiB;
  RecordingFiles files = begin(kMiB, 100 * kMiB);
  core::Result<Outcome> outcome = add(files, surface, true);
  for (int k = 0; k < 100 && outcome; ++k) outcome = add(files, surface, true);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().message, "the disk is full");
  (void)files.finish();
  for (const auto& [name, content] : disk.files) {
    EXPECT_TRUE(content.empty() || content.back() == '\n') << name;
  }
}

TEST_F(RecordingFilesTest, NextFileThatExistsEndsTheRecording) {
  disk.files["run_0002.mcap"] = {1};
  RecordingFiles files = begin(kMiB, 100 * kMiB);
  core::Result<Outcome> outcome = add(files, surface, true);
  while (outcome) outcome = add(files, surface, true);
  EXPECT_THAT(outcome.error().message, HasSubstr("run_0002.mcap exists"));
  EXPECT_TRUE(files.finish());
  EXPECT_EQ(disk.files["run_0002.mcap"].size(), 1u);
}

TEST_F(RecordingFilesTest, PartThatADiskTookOfAChunkIsCutOff) {
  const test::TemporaryFolder folder;
  FilesSetup wanted = setup(std::nullopt, 10 * kMiB);
  wanted.folder = folder.path();
  auto files = RecordingFiles::begin(wanted);
  ASSERT_TRUE(files);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto action = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{3 * kMiB / 2, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  core::Result<Outcome> outcome = add(*files, surface, true);
  while (outcome) outcome = add(*files, surface, true);
  const auto finished = files->finish();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, action);
  EXPECT_THAT(outcome.error().message, HasSubstr("ulimit -f"));
  EXPECT_TRUE(finished) << "there is room for the summary";
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "run.mcap"), files->writtenBytes());
}

}  // namespace
}  // namespace spindrift::recording
