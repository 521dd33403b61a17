// Disks that are full or refuse, and killed processes. A limit for the size of files makes writes short and then fail,
// as a full disk does; calls that rarely fail are replaced by ones that fail on request.
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <spindrift/state/room_files.h>

#include "state_fixture.h"

namespace {
std::atomic<bool> is_sync_refused = false;
std::atomic<bool> is_cut_refused = false;
std::atomic<int> folder_sync_count = 0;
}  // namespace

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): C library
extern "C" int fsync(int descriptor) {
  ++folder_sync_count;
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): C library
extern "C" int fdatasync(int descriptor) {
  if (is_sync_refused) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): C library
extern "C" int ftruncate(int descriptor, off_t size) noexcept {
  if (is_cut_refused) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size));
}

namespace spindrift::state {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// Limits the size of files that this process writes while it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uint64_t size_bytes) : action_(std::signal(SIGXFSZ, SIG_IGN)) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before_), 0);
    const rlimit limit{size_bytes, before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before_), 0);
    std::signal(SIGXFSZ, action_);
  }

 private:
  rlimit before_{};
  void (*action_)(int);
};

struct RoomFailuresTest : StateTest {
  void TearDown() override { is_sync_refused = is_cut_refused = false; }
};

TEST_F(RoomFailuresTest, AFailedAppendLeavesWholeRecords) {
  for (std::uint64_t room_bytes = 0; room_bytes < 20 + 6; ++room_bytes) {
    std::filesystem::remove_all(room);
    const auto files = openRecovered();
    begin(*files);
    append(*files, "first");
    const std::string whole = content(kLog1);
    {
      const FileSizeLimit limit(whole.size() + room_bytes);
      const auto done = files->append(viewOf("second"));
      ASSERT_FALSE(done);
      EXPECT_THAT(done.error().message, AllOf(HasSubstr(kLog1), HasSubstr("File too large"), HasSubstr("ulimit -f")));
    }
    ASSERT_EQ(content(kLog1), whole) << room_bytes;
    append(*files, "third");
    EXPECT_EQ(summary(recovered()), "0= | 1: first third");
  }
}

TEST_F(RoomFailuresTest, PartOfARecordIsCutBeforeTheNext) {
  const auto files = openRecovered();
  begin(*files);
  append(*files, "first");
  const std::string whole = content(kLog1);
  is_cut_refused = true;
  {
    const FileSizeLimit limit(whole.size() + 24);
    EXPECT_FALSE(files->append(viewOf("second")));
  }
  EXPECT_EQ(content(kLog1).size(), whole.size() + 24);
  EXPECT_THAT(files->append(viewOf("x")).error().message, HasSubstr("could not cut"));
  EXPECT_FALSE(files->beginGeneration());
  is_cut_refused = false;
  append(*files, "x");
  writeSnapshot(*files, {1, 1}, "one");
  begin(*files);
  append(*files, "y");
  const auto found = recovered();
  EXPECT_EQ(summary(found), "1=one | 1: first x | 2: y");
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST_F(RoomFailuresTest, FailedSnapshotChangesNoFile) {
  const auto files = openRecovered();
  writeSnapshot(*files, begin(*files), "one");
  append(*files, "a");
  const StatePoint point = begin(*files);
  append(*files, "b");
  const auto before = allFiles();
  for (const std::uint64_t size_bytes : {0, 20, 48, 100}) {
    const FileSizeLimit limit(size_bytes);
    EXPECT_FALSE(files->writeSnapshot(point, core::Bytes(1000, 's')));
  }
  EXPECT_EQ(allFiles(), before);
  EXPECT_EQ(files->status().snapshot_generation, 1U);
  EXPECT_EQ(summary(recovered()), "1=one | 1: a | 2: b");
  writeSnapshot(*files, point, "two");
  EXPECT_EQ(summary(recovered()), "2=two | 2: b");
}

TEST_F(RoomFailuresTest, RefusedSnapshotDoesNotReplaceTheOlderOne) {
  const auto files = openRecovered({.sync = Sync::kSnapshots, .kept_generation_count = 1});
  writeSnapshot(*files, begin(*files), "one");
  const StatePoint point = begin(*files);
  const auto before = allFiles();
  is_sync_refused = true;
  EXPECT_THAT(files->writeSnapshot(point, viewOf("two")).error().message, HasSubstr("check the disk"));
  EXPECT_EQ(allFiles(), before);
}

TEST_F(RoomFailuresTest, FailedGenerationKeepsThePresentLog) {
  const auto files = openRecovered();
  writeSnapshot(*files, begin(*files), "one");
  append(*files, "a");
  {
    const FileSizeLimit limit(8);
    EXPECT_FALSE(files->beginGeneration());
  }
  append(*files, "b");
  EXPECT_EQ(files->status().generation, 1U);
  EXPECT_EQ(summary(recovered()), "1=one | 1: a b");
  EXPECT_EQ(begin(*files).generation, 2U);
}

TEST_F(RoomFailuresTest, FlushFailsAfterALostRecordUntilASnapshot) {
  const auto files = openRecovered({.sync = Sync::kAlways});
  writeSnapshot(*files, begin(*files), "one");
  append(*files, "a");
  EXPECT_TRUE(files->flush());
  is_sync_refused = true;
  EXPECT_THAT(files->flush().error().message, AllOf(HasSubstr("force to the disk"), HasSubstr(kLog1)));
  is_sync_refused = false;
  EXPECT_THAT(files->flush().error().message, HasSubstr("a snapshot of generation 2 makes up for it"));
  const StatePoint point = begin(*files);
  EXPECT_FALSE(files->flush());
  writeSnapshot(*files, point, "two");
  EXPECT_TRUE(files->flush());
}

TEST_F(RoomFailuresTest, FlushForcesTheOlderLogToo) {
  const auto files = openRecovered({.sync = Sync::kAlways});
  writeSnapshot(*files, begin(*files), "one");
  append(*files, "a");
  is_sync_refused = true;
  const StatePoint point = begin(*files);
  EXPECT_EQ(point.generation, 2U) << "a new log does not wait for the disk";
  EXPECT_THAT(files->flush().error().message, HasSubstr(kLog1));
  is_sync_refused = false;
  EXPECT_THAT(files->flush().error().message, HasSubstr("a snapshot of generation 3 makes up for it"));
  const StatePoint next = begin(*files);
  EXPECT_EQ(next.generation, 3U) << "the operating system has dropped what it could not write to the one before";
  writeSnapshot(*files, next, "three");
  EXPECT_TRUE(files->flush());
}

TEST_F(RoomFailuresTest, NameOfASnapshotIsForcedBeforeOlderFilesGo) {
  const auto files = openRecovered({.sync = Sync::kAlways});
  const StatePoint point = begin(*files);
  append(*files, "a");
  EXPECT_TRUE(files->flush()) << "which forces the name of the log";
  const int before = folder_sync_count;
  ASSERT_TRUE(files->writeSnapshot(point, viewOf("one")));
  EXPECT_EQ(folder_sync_count, before + 1);
}

TEST_F(RoomFailuresTest, LostRecordIsReportedAsMissing) {
  {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    append(*files, "a");
    files->skipRecord();
    append(*files, "c");
    writeSnapshot(*files, begin(*files), "two");
    append(*files, "d");
  }
  const auto whole = allFiles();
  EXPECT_EQ(summary(recovered()), "2=two | 2: d");
  setFiles(whole);
  setContent(kSnapshot2, "damaged");
  const auto found = recovered();
  EXPECT_EQ(summary(found), "1=one | 1: a");
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("the records 2 to 2 are missing")));
}

/// Appends 1, 2, 3, ... to the room until it is killed. The content of a snapshot is the number before it. `appended`
/// is the last number whose append() has returned.
[[noreturn]] void appendUntilKilled(RoomFiles& files, int last, std::atomic<int>& appended) {
  for (int k = last + 1;; ++k) {
    if (k % 20 == 0 || k == last + 1) {
      const auto point = files.beginGeneration();
      if (!point || !files.writeSnapshot(*point, viewOf(std::to_string(k - 1))) || !files.removeOldGenerations())
        ::_exit(1);
    }
    if (!files.append(viewOf(std::to_string(k) + std::string(100, '.')))) ::_exit(1);
    appended = k;
  }
}

TEST_F(RoomFailuresTest, KilledProcessLosesNoAppendedRecord) {
  void* shared = ::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto& appended = *new (shared) std::atomic<int>(0);
  std::mt19937 random(7);
  int last = 0;
  for (int round = 0; round < 40; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const auto files = RoomFiles::open(room, kRoom, {.sync = Sync::kNever});
      if (!files || !(*files)->recover()) ::_exit(1);
      appendUntilKilled(**files, last, appended);
    }
    while (appended == last) {
      ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0) << "the child ended by itself, round " << round;
      std::this_thread::yield();
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself, round " << round;
    const auto found = recovered();
    int next = found.generation == 0 ? 0 : std::stoi(textOf(found.snapshot));
    for (const auto& log : found.logs) {
      for (const core::ByteView record : log.records) ASSERT_EQ(std::stoi(textOf(record)), ++next);
    }
    ASSERT_GE(next, appended);
    ASSERT_LE(next, appended + 1);
    last = next;
    appended = next;
  }
  ::munmap(shared, sizeof(std::atomic<int>));
}

}  // namespace
}  // namespace spindrift::state
