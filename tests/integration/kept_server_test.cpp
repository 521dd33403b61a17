// A whole server whose rooms are kept on disk: files that are damaged, of other rooms, too many, or on a full disk.
#include <spindrift/history/state_store.h>

#include "full_disk.h"
#include "server_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The whole server, with rooms that are opened and closed.
class KeptServerTest : public ServerTest {
 protected:
  void adjust(service::WaterServerOptions& options) const override {
    auto store = history::StateStore::open({.folder = folder_.path()});
    ASSERT_TRUE(store) << store.error().message;
    options.rules.states = *std::move(store);
    options.max_room_count = max_room_count_;
  }
  water::SceneCatalog scenes() const override {
    scenes_.write("pond.textproto", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }");
    return water::SceneCatalog(scenes_.path());
  }
  void TearDown() override { stop(); }  // while the folder is there

  unsigned openRoom(const std::string& name) {
    return httpRequest(server().port(), "POST", "/api/v1/rooms", "Content-Type: application/json\r\n",
                       R"({"name": ")" + name + R"(", "scene": "pond"})")
        .status;
  }
  std::vector<std::string> roomNames() {
    std::vector<std::string> out;
    for (const auto& room : server().simulation().rooms()) out.push_back(room->name());
    return out;
  }
  [[nodiscard]] std::filesystem::path roomFolder(const std::string& name) const {
    return folder_.path() / "rooms" / name;
  }

  TemporaryFolder folder_;
  TemporaryFolder scenes_;
  std::size_t max_room_count_ = 8;
};

TEST_F(KeptServerTest, KeepsItsFolderForItself) {
  const auto second = history::StateStore::open({.folder = folder_.path()});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("in use by process"));
}

TEST_F(KeptServerTest, StartOnAFullDiskIsRefusedWithoutLoss) {
  ASSERT_TRUE(client().apply(setSpeed(0.5)));
  stop();
  {
    const FullDisk full(10);  // room for the process id in the lock file
    const auto started = tryToStart();
    ASSERT_FALSE(started);
    EXPECT_THAT(started.error().message, HasSubstr("cannot be written"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "aside"));
  SetUp();
  EXPECT_EQ(client().greeting().room_state().speed(), 0.5) << "the room continues where it was";
}

/// Writes a snapshot of the room that is newer than all others. What it says is `content`, or, if that is empty, what
/// the newest one says after `change`.
template <typename Change>
void writeNewerSnapshot(const std::filesystem::path& folder, const std::string& room, std::string content,
                        Change change) {
  auto files = state::RoomFiles::open(folder / "rooms" / room, room, {});
  ASSERT_TRUE(files);
  auto recovered = (*files)->recover();
  ASSERT_TRUE(recovered);
  if (content.empty()) {
    v1::KeptState kept;
    ASSERT_TRUE(kept.ParseFromArray(recovered->snapshot.data(), static_cast<int>(recovered->snapshot.size())));
    change(kept);
    content = kept.SerializeAsString();
  }
  const auto point = (*files)->beginGeneration();
  ASSERT_TRUE(point);
  ASSERT_TRUE((*files)->writeSnapshot(*point, {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()}));
}
void keepAsItIs(v1::KeptState&) {}

TEST_F(KeptServerTest, SnapshotWithoutARoomStateFallsBackToTheOneBefore) {
  ASSERT_TRUE(client().apply(setSpeed(0.5)));
  stop();
  writeNewerSnapshot(folder_.path(), "main", std::string(100, '\xff'), keepAsItIs);
  SetUp();
  EXPECT_EQ(client().greeting().room_state().speed(), 0.5);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "aside"));
}

TEST_F(KeptServerTest, SnapshotOfAnotherRoomFallsBackToTheOneBefore) {
  ASSERT_TRUE(client().apply(setSpeed(0.5)));
  stop();
  writeNewerSnapshot(folder_.path(), "main", "", [](v1::KeptState& kept) {
    kept.set_room("quay");
    kept.set_speed(2);
  });
  SetUp();
  EXPECT_EQ(client().greeting().room_state().speed(), 0.5);
}

TEST_F(KeptServerTest, SnapshotWithAWrongHashFallsBackToTheOneBefore) {
  ASSERT_TRUE(client().apply(setSpeed(0.5)));
  stop();
  writeNewerSnapshot(folder_.path(), "main", "",
                     [](v1::KeptState& kept) { kept.set_state_hash(kept.state_hash() ^ 1); });
  SetUp();
  EXPECT_EQ(client().greeting().room_state().speed(), 0.5) << "nothing is lost";
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "aside"));
  std::size_t damaged_count = 0;
  for (const auto& file : std::filesystem::directory_iterator(roomFolder("main")))
    damaged_count += file.path().extension() == ".damaged" ? 1 : 0;
  EXPECT_EQ(damaged_count, 1u) << "and it is still there";
}

TEST_F(KeptServerTest, SnapshotsOfAnotherProgramAreSetAside) {
  ASSERT_TRUE(client().apply(splash()));
  stop();
  const auto room = roomFolder("main");
  for (int k = 0; k < 2; ++k) {
    writeNewerSnapshot(folder_.path(), "main", "", [](v1::KeptState& kept) {
      kept.mutable_water()->mutable_buffers(0)->mutable_words()->resize(8);
    });
  }
  std::vector<std::filesystem::path> snapshots;
  for (const auto& file : std::filesystem::directory_iterator(room)) {
    if (file.path().extension() == ".snapshot") snapshots.push_back(file.path());
  }
  std::ranges::sort(snapshots);
  while (snapshots.size() > 2) {
    std::filesystem::remove(snapshots.front());
    snapshots.erase(snapshots.begin());
  }
  SetUp();
  EXPECT_TRUE(client().apply(splash())) << "the room is there, from its start";
  for (const auto& snapshot : snapshots)
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "aside" / "main" / snapshot.filename())) << "under its name";
}

TEST_F(KeptServerTest, CopiedRoomFolderIsRefused) {
  ASSERT_TRUE(client().apply(splash()));
  stop();
  const auto rooms = folder_.path() / "rooms";
  for (const char* name : {"copy", "quay (copy)", "q\"} 1", "two\nlines"})
    std::filesystem::copy(rooms / "main", rooms / name);
  SetUp();
  EXPECT_THAT(roomNames(), ElementsAre("main"));
  EXPECT_TRUE(std::filesystem::exists(rooms / "quay (copy)")) << "what is not opened stays";
}

TEST_F(KeptServerTest, RoomRefusedOnAFullDiskLeavesNoFiles) {
  {
    const FullDisk full(kLogsOnly);
    EXPECT_EQ(openRoom("quay"), 503u);
  }
  EXPECT_FALSE(std::filesystem::exists(roomFolder("quay")));
  EXPECT_EQ(openRoom("quay"), 201u);
  EXPECT_TRUE(std::filesystem::exists(roomFolder("quay")));
}

TEST_F(KeptServerTest, StartWithTooManyKeptRoomsIsRefused) {
  ASSERT_EQ(openRoom("dock"), 201u);
  ASSERT_EQ(openRoom("quay"), 201u);
  stop();
  max_room_count_ = 2;
  const auto refused = tryToStart();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::AllOf(HasSubstr("3 rooms would be opened (dock, main, quay)"),
                                                      HasSubstr("--max-rooms is 2: start with --max-rooms 3")));
  max_room_count_ = 3;
  SetUp();
  EXPECT_THAT(roomNames(), ElementsAre("main", "dock", "quay")) << "nothing of them was lost";
}

}  // namespace
}  // namespace spindrift::test
