#include <string>

#include <gmock/gmock.h>

#include <spindrift/state/folders.h>

#include "temporary_folder.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

struct RoomFoldersTest : testing::Test {
  test::TemporaryFolder folder;

  std::vector<std::string> rooms() const {
    const auto names = listRooms(folder.path());
    EXPECT_TRUE(names) << names.error().message;
    return names ? names->names : std::vector<std::string>();
  }
};

TEST_F(RoomFoldersTest, AServerWithoutStateHasNoRooms) {
  EXPECT_THAT(rooms(), IsEmpty());
  EXPECT_TRUE(finishRemovals(folder.path()));
}

TEST_F(RoomFoldersTest, ListsRoomsInOrder) {
  folder.write("rooms/pool/000000000001.log", "x");
  folder.write("rooms/harbor/000000000001.log", "x");
  folder.write("rooms/notes.txt", "no room");
  EXPECT_THAT(rooms(), ElementsAre("harbor", "pool"));
  EXPECT_EQ(*roomFolder(folder.path(), "pool"), folder.path() / "rooms" / "pool");
}

TEST_F(RoomFoldersTest, InvalidFolderNamesAreListedApart) {
  for (const char* name : {"quay", "quay (copy)", "q\"} 1", "two\nlines", ".removed.pool"})
    folder.write(std::string("rooms/") + name + "/000000000001.log", "x");
  const auto listed = listRooms(folder.path());
  ASSERT_TRUE(listed);
  EXPECT_THAT(listed->names, ElementsAre("quay"));
  EXPECT_THAT(listed->refused_names, ElementsAre("q\"} 1", "quay (copy)", "two\nlines"));
}

TEST_F(RoomFoldersTest, OnlyLogsAreNoState) {
  EXPECT_FALSE(*hasState(folder.path(), "pool"));
  folder.write("rooms/pool/000000000001.log", "x");
  folder.write("rooms/pool/000000000001.snapshot.tmp", "x");
  EXPECT_FALSE(*hasState(folder.path(), "pool"));
  for (const char* name : {"000000000001.snapshot", "000000000001.log.damaged", "notes.txt"}) {
    folder.write(std::string("rooms/pool/") + name, "x");
    EXPECT_TRUE(*hasState(folder.path(), "pool")) << name;
    std::filesystem::remove(folder.path() / "rooms/pool" / name);
  }
}

TEST_F(RoomFoldersTest, RemovesARoomAsAWhole) {
  folder.write("rooms/pool/000000000001.log", "x");
  folder.write("rooms/harbor/000000000001.log", "x");
  EXPECT_TRUE(removeRoom(folder.path(), "pool"));
  EXPECT_THAT(rooms(), ElementsAre("harbor"));
  EXPECT_TRUE(removeRoom(folder.path(), "pool"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "rooms"), {}), 1);
}

TEST_F(RoomFoldersTest, ARemovalThatWasInterruptedIsFinished) {
  folder.write("rooms/pool/000000000001.log", "new");
  folder.write("rooms/.removed.pool/000000000001.log", "old");
  EXPECT_THAT(rooms(), ElementsAre("pool"));
  EXPECT_TRUE(finishRemovals(folder.path()));
  EXPECT_FALSE(fs::exists(folder.path() / "rooms/.removed.pool"));
  EXPECT_TRUE(fs::exists(folder.path() / "rooms/pool/000000000001.log"));

  folder.write("rooms/.removed.pool/000000000001.log", "old");
  EXPECT_TRUE(removeRoom(folder.path(), "pool"));
  EXPECT_TRUE(fs::is_empty(folder.path() / "rooms"));
}

TEST_F(RoomFoldersTest, NamesThatLeadElsewhereAreRefused) {
  folder.write("precious", "x");
  for (const std::string& name :
       {std::string(), std::string("."), std::string(".."), std::string("../precious"), std::string("a/b"),
        std::string(".hidden"), std::string("a\0b", 3), std::string("quay (copy)"), std::string("q\"} 1"),
        std::string("a\nb"), std::string(33, 'a')}) {
    EXPECT_FALSE(roomFolder(folder.path(), name)) << name;
    EXPECT_FALSE(removeRoom(folder.path(), name)) << name;
  }
  EXPECT_TRUE(fs::exists(folder.path() / "precious"));
}

}  // namespace
}  // namespace spindrift::state
