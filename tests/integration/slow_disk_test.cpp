// A disk that takes long to be forced: start and end of a server wait for it only as long as they may.
#include <atomic>
#include <chrono>
#include <thread>

#include <sys/syscall.h>
#include <unistd.h>

#include <spindrift/history/state_store.h>

#include "server_fixture.h"
#include "temporary_folder.h"

namespace {
std::atomic<bool> is_disk_standing = false;
std::atomic<int> sync_ms = 0;
std::atomic<int> sync_count = 0;

void waitForDisk() {
  ++sync_count;
  std::this_thread::sleep_for(std::chrono::milliseconds(sync_ms));
  while (is_disk_standing) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}
}  // namespace

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): C library
extern "C" int fdatasync(int descriptor) {
  waitForDisk();
  return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): C library
extern "C" int fsync(int descriptor) {
  waitForDisk();
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class SlowDisk : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", kStillWave}, {"dock", kStillWave}, {"quay", kStillWave}};
  }
  void adjust(service::WaterServerOptions& options) const override {
    auto store = history::StateStore::open(
        {.folder = folder_.path(), .sync = state::Sync::kAlways, .snapshot_interval = std::chrono::hours(1)});
    ASSERT_TRUE(store) << store.error().message;
    options.rules.states = *std::move(store);
    options.rules.disk_patience = patience_;
  }
  void TearDown() override {
    is_disk_standing = false;
    sync_ms = 0;
    stop();  // while the folder is there
  }
  std::uint64_t snapshotCount(const std::string& room) {
    return server().simulation().find(room)->keptStatus()->snapshot_count;
  }
  bool areOnDisk() {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      if (snapshotCount("main") > 0 && snapshotCount("dock") > 0 && snapshotCount("quay") > 0) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }

  TemporaryFolder folder_;
  std::chrono::milliseconds patience_{200};
};

TEST_F(SlowDisk, NewRoomRefusesCommandsUntilTheDiskAnswers) {
  ASSERT_TRUE(areOnDisk());
  stop();
  std::filesystem::remove_all(folder_.path() / "rooms");
  is_disk_standing = true;
  SetUp();
  EXPECT_EQ(snapshotCount("main"), 0u);
  ScriptedClient player = client();
  EXPECT_THAT(player.rejected(splash()).message(), HasSubstr("its first snapshot is not on the disk yet"))
      << "nothing is acknowledged that a power failure could take away";
  is_disk_standing = false;
  ASSERT_TRUE(areOnDisk());
  EXPECT_TRUE(player.apply(splash()));
}

TEST_F(SlowDisk, KeptRoomsStartOnABlockedDisk) {
  ASSERT_TRUE(client("quay").apply(setSpeed(0.5)));
  stop();
  is_disk_standing = true;
  SetUp();
  EXPECT_EQ(client("quay").greeting().room_state().speed(), 0.5);
  is_disk_standing = false;
}

TEST_F(SlowDisk, StopGivesUpItsLastSnapshotWithoutLoss) {
  for (const char* room : {"main", "dock", "quay"}) ASSERT_TRUE(client(room).apply(setSpeed(0.5)));
  ASSERT_TRUE(areOnDisk());
  sync_ms = static_cast<int>(2 * patience_.count());
  const int before = sync_count;
  stop();
  EXPECT_LE(sync_count - before, 2) << "one snapshot, of the first room: its content and its name";
  sync_ms = 0;
  SetUp();
  for (const char* room : {"main", "dock", "quay"})
    EXPECT_EQ(client(room).greeting().room_state().speed(), 0.5) << room;
}

}  // namespace
}  // namespace spindrift::test
