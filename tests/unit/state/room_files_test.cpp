#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include <gmock/gmock.h>

#include <spindrift/state/room_files.h>

#include "state_fixture.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;
using core::ErrorCode;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using RoomFilesTest = StateTest;

TEST_F(RoomFilesTest, ANewRoomHasNoState) {
  const auto found = recovered();
  EXPECT_EQ(summary(found), "0=");
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST_F(RoomFilesTest, FindsTheNewestSnapshotAndItsLog) {
  writeTwoGenerations();
  const auto found = recovered();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, IsEmpty());
  EXPECT_THAT(names(), ElementsAre(kLog1, kSnapshot1, kLog2, kSnapshot2));
}

TEST_F(RoomFilesTest, UnwrittenSnapshotLeavesTheOlderOneAndBothLogs) {
  {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    append(*files, "a");
    begin(*files);
    append(*files, "b");
  }
  EXPECT_EQ(summary(recovered()), "1=one | 1: a | 2: b");
}

TEST_F(RoomFilesTest, BeforeTheFirstSnapshotTheLogsBeginWithTheNewRoom) {
  for (const char* record : {"a", "b"}) {
    const auto files = openRecovered();
    begin(*files);
    append(*files, record);
  }
  EXPECT_EQ(summary(recovered()), "0= | 1: a | 2: b");
}

TEST_F(RoomFilesTest, ARestartedRoomContinuesWithTheNextGeneration) {
  writeTwoGenerations();
  {
    const auto files = openRecovered();
    EXPECT_EQ(begin(*files).generation, 3U);
    append(*files, "after");
  }
  EXPECT_EQ(summary(recovered()), "2=two | 2: ccc d | 3: after");
}

TEST_F(RoomFilesTest, KeepsExactlyTheGenerationsThatItShall) {
  for (const std::uint32_t kept : {1U, 2U, 3U}) {
    fs::remove_all(room);
    const auto files = openRecovered({.sync = Sync::kNever, .kept_generation_count = kept});
    std::vector<std::string> expected;
    for (std::uint64_t generation = 1; generation <= 6; ++generation) {
      writeSnapshot(*files, begin(*files), "state");
      append(*files, "record");
      if (generation + kept <= 6) continue;
      const std::string digits = "00000000000" + std::to_string(generation);
      expected.insert(expected.end(), {digits + ".log", digits + ".snapshot"});
    }
    EXPECT_EQ(names(), expected) << kept;
    EXPECT_EQ(summary(recovered()), "6=state | 6: record");
  }
}

TEST_F(RoomFilesTest, KeepsEachLogThatAKeptSnapshotNeeds) {
  for (const char* state : {"one", "", "three", "", "", "six"}) {
    const auto files = openRecovered();  // a restart begins a log, whatever the snapshot does
    const StatePoint point = begin(*files);
    append(*files, "r" + std::to_string(point.generation));
    if (*state != '\0') writeSnapshot(*files, {point.generation, point.next_number + 1}, state);
  }
  setContent("000000000006.snapshot", "damaged");
  EXPECT_EQ(summary(recovered()), "3=three | 3: | 4: r4 | 5: r5 | 6: r6");
  EXPECT_FALSE(fs::exists(room / kLog2));
}

TEST_F(RoomFilesTest, FailedSnapshotIsRetriedInItsGeneration) {
  const auto files = openRecovered();
  writeSnapshot(*files, begin(*files), "one");
  append(*files, "a");
  for (int k = 0; k < 200; ++k) {
    EXPECT_EQ(begin(*files).generation, 2U) << "its snapshot could not be written so far";
    append(*files, "b" + std::to_string(k));
  }
  const StatePoint point = begin(*files);
  append(*files, "after");
  writeSnapshot(*files, point, "two");
  EXPECT_THAT(names(), ElementsAre(kLog1, kSnapshot1, kLog2, kSnapshot2));
  EXPECT_EQ(summary(recovered()), "2=two | 2: after") << "the records before it are in it";
  setContent(kSnapshot2, "damaged");
  const auto older = recovered();
  ASSERT_EQ(older.logs.size(), 2U);
  EXPECT_EQ(older.logs[1].records.size(), 201U) << "the older snapshot needs them all";
  EXPECT_EQ(begin(*files).generation, 3U);
}

TEST_F(RoomFilesTest, OnlyItsOwnerMayReadItsFiles) {
  writeTwoGenerations();
  EXPECT_EQ(fs::status(room).permissions(), fs::perms::owner_all);
  for (const std::string& name : names())
    EXPECT_EQ(fs::status(room / name).permissions(), fs::perms::owner_read | fs::perms::owner_write) << name;
}

TEST_F(RoomFilesTest, ItsStatusNamesGenerationsAndSizes) {
  const auto files = openRecovered();
  EXPECT_EQ(files->status().generation, 0U);
  begin(*files);
  append(*files, "four");
  EXPECT_EQ(files->status().generation, 1U);
  EXPECT_EQ(files->status().log_bytes, fs::file_size(room / kLog1));
  EXPECT_EQ(files->status().snapshot_generation, 0U);
  writeSnapshot(*files, {1, 2}, "state");
  EXPECT_EQ(files->status().snapshot_generation, 1U);
  EXPECT_EQ(files->status().snapshot_bytes, fs::file_size(room / kSnapshot1));
  const auto again = openRecovered();
  EXPECT_EQ(again->status().snapshot_generation, 1U);
  EXPECT_EQ(again->status().snapshot_bytes, fs::file_size(room / kSnapshot1));
}

TEST_F(RoomFilesTest, RecordsOfAnImpossibleSizeAreRefused) {
  const auto files = openRecovered();
  begin(*files);
  EXPECT_EQ(files->append({}).error().code, ErrorCode::kInvalidInput);
  const core::Bytes most(kRecordMaxBytes, 'x'), more(kRecordMaxBytes + 1, 'x');
  EXPECT_TRUE(files->append(most));
  EXPECT_THAT(files->append(more).error().message, HasSubstr("8388609 bytes"));
  const auto found = recovered();
  ASSERT_EQ(found.logs.size(), 1U);
  ASSERT_EQ(found.logs[0].records.size(), 1U);
  EXPECT_EQ(found.logs[0].records[0].size(), kRecordMaxBytes);
}

TEST_F(RoomFilesTest, AFullLogAsksForASnapshot) {
  const auto files = openRecovered({.sync = Sync::kNever, .log_max_bytes = kPoolLogBytes + 2 * (20 + 4)});
  begin(*files);
  append(*files, "four");
  append(*files, "more");
  EXPECT_THAT(files->append(viewOf("x")).error().message, HasSubstr("a snapshot is due"));
  begin(*files);
  append(*files, "x");
  EXPECT_EQ(summary(recovered()), "0= | 1: four more | 2: x");
}

TEST_F(RoomFilesTest, LogsWithoutASnapshotAreBounded) {
  const auto files = openRecovered({.sync = Sync::kNever, .log_max_bytes = kPoolLogBytes + 20 + 4});
  const std::uint64_t most = kLogsWithoutSnapshotMaxCount;
  for (std::uint64_t k = 1; k <= most; ++k) {
    EXPECT_EQ(begin(*files).generation, k);
    append(*files, "four");
    EXPECT_FALSE(files->append(viewOf("more"))) << "the log is full";
  }
  const StatePoint point = begin(*files);
  EXPECT_EQ(point.generation, most) << "no further log";
  writeSnapshot(*files, point, "state");
  EXPECT_EQ(begin(*files).generation, most + 1) << "a snapshot makes place";
}

TEST_F(RoomFilesTest, CallsInTheWrongOrderAreRefused) {
  const auto files = open({.sync = Sync::kAlways});
  EXPECT_EQ(files->beginGeneration().error().code, ErrorCode::kInternal);
  EXPECT_EQ(files->append(viewOf("x")).error().code, ErrorCode::kInternal);
  EXPECT_EQ(files->flush().error().code, ErrorCode::kInternal);
  (void)recover(*files);
  EXPECT_EQ(files->writeSnapshot({1, 1}, {}).error().code, ErrorCode::kInternal);
  begin(*files);
  EXPECT_EQ(files->writeSnapshot({2, 1}, {}).error().code, ErrorCode::kInternal);
  EXPECT_EQ(files->recover().error().code, ErrorCode::kInternal);
}

TEST_F(RoomFilesTest, OptionsOutOfRangeAreRefused) {
  EXPECT_EQ(RoomFiles::open(room, kRoom, {.kept_generation_count = 0}).error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(RoomFiles::open(room, std::string(256, 'x'), {}).error().message, HasSubstr("256 bytes"));
  EXPECT_EQ(RoomFiles::open(room, kRoom, {.log_max_bytes = kLogMaxBytes + 1}).error().code, ErrorCode::kInvalidInput);
}

TEST_F(RoomFilesTest, AFolderThatCannotBeMadeIsNamed) {
  folder.write("file", "");
  const auto files = RoomFiles::open(folder.path() / "file" / "room", kRoom, {});
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(files.error().message, HasSubstr("file"));
}

/// Appends while snapshots are written and flushes run. The snapshot's content is the number of records before it.
TEST_F(RoomFilesTest, LosesNoRecordWhileSnapshotsAreWritten) {
  for (const Sync sync : {Sync::kNever, Sync::kSnapshots, Sync::kAlways}) {
    fs::remove_all(room);
    const int record_count = sync == Sync::kNever ? 4000 : 400;
    {
      const auto files = openRecovered({.sync = sync});
      std::atomic<int> count_before = 0;
      std::mutex mutex;
      std::optional<StatePoint> due = begin(*files);
      std::atomic<bool> ended = false;
      std::thread snapshots([&] {
        while (!ended) {
          std::unique_lock lock(mutex);
          if (!due) continue;
          const StatePoint point = *due;
          lock.unlock();
          writeSnapshot(*files, point, std::to_string(count_before));
          lock.lock();
          due.reset();
        }
      });
      std::thread flushes([&] {
        while (!ended) {
          if (const auto flushed = files->flush(); !flushed) ADD_FAILURE() << flushed.error().message;
          (void)files->status();
          std::this_thread::yield();
        }
      });
      for (int k = 0; k < record_count; ++k) {
        if (const std::lock_guard lock(mutex); k % 50 == 49 && !due) {
          count_before = k;
          due = begin(*files);
        }
        append(*files, std::to_string(k));
      }
      ended = true;
      snapshots.join();
      flushes.join();
    }
    const auto found = recovered();
    EXPECT_THAT(found.notes, IsEmpty());
    int next = found.generation == 0 ? 0 : std::stoi(textOf(found.snapshot));
    for (const auto& log : found.logs) {
      for (const core::ByteView record : log.records) ASSERT_EQ(textOf(record), std::to_string(next++));
    }
    EXPECT_EQ(next, record_count);
  }
}

}  // namespace
}  // namespace spindrift::state
