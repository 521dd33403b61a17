#include <filesystem>

#include <gmock/gmock.h>

#include <spindrift/state/room_files.h>

#include "state_fixture.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

struct RoomRecoveryTest : StateTest {
  /// Recovers, goes on with a new generation, and checks that the next recovery finds both. Returns what was found.
  RoomFiles::Recovered recoverAndGoOn() const {
    RoomFiles::Recovered found;
    std::uint64_t next = 0;
    {
      const auto files = open();
      found = recover(*files);
      next = begin(*files);
      append(*files, "new");
    }
    const auto again = recovered();
    EXPECT_EQ(summary(again), summary(found) + " | " + std::to_string(next) + ": new");
    EXPECT_THAT(again.notes, IsEmpty());
    return found;
  }
};

TEST_F(RoomRecoveryTest, ALogCutAnywhereGivesItsWholeRecords) {
  const std::vector<std::string> records{"a", std::string(300, 'b'), "ccccccc", std::string(20, 'd')};
  {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    for (const std::string& record : records) append(*files, record);
  }
  const auto whole = allFiles();
  const std::string log = content(kLog1);
  for (std::size_t size = 0; size <= log.size(); ++size) {
    setFiles(whole);
    setContent(kLog1, log.substr(0, size));
    std::string expected = "1=one | 1:";
    std::size_t end = 16;
    for (const std::string& record : records) {
      end += 8 + record.size();
      if (end <= size) expected += " " + record;
    }
    auto found = recoverAndGoOn();
    const std::string text = summary(found);
    ASSERT_EQ(text, expected) << "cut to " << size << " bytes";
    ASSERT_EQ(found.notes.empty(), size == log.size() || content(kLog1).size() == size) << size;
  }
}

TEST_F(RoomRecoveryTest, ASnapshotCutAnywhereGivesTheOneBeforeAndBothLogs) {
  writeTwoGenerations();
  const auto whole = allFiles();
  const std::string snapshot = content(kSnapshot2);
  for (std::size_t size = 0; size < snapshot.size(); ++size) {
    setFiles(whole);
    setContent(kSnapshot2, snapshot.substr(0, size));
    const auto found = recoverAndGoOn();
    ASSERT_EQ(summary(found), "1=one | 1: a bb | 2: ccc d") << "cut to " << size << " bytes";
    ASSERT_THAT(found.notes, ElementsAre(AllOf(HasSubstr(kSnapshot2), HasSubstr("at byte"))));
    ASSERT_EQ(content(kSnapshot2 + ".damaged"), snapshot.substr(0, size));
  }
}

TEST_F(RoomRecoveryTest, AFlippedBitNeverGivesAWrongState) {
  writeTwoGenerations();
  const auto whole = allFiles();
  for (const auto& [name, bytes] : whole) {
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      std::string flipped = bytes;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      setFiles(whole);
      setContent(name, flipped);
      const auto found = recoverAndGoOn();
      const std::string text = summary(found);
      const auto place = name + ", bit " + std::to_string(bit);
      if (name == kSnapshot2) {
        ASSERT_EQ(text, "1=one | 1: a bb | 2: ccc d") << place;
      } else if (name == kLog2) {
        ASSERT_THAT(text, AnyOf("2=two | 2:", "2=two | 2: ccc")) << place;
      } else {
        ASSERT_EQ(text, "2=two | 2: ccc d") << place;
      }
      ASSERT_EQ(found.notes.empty(), name != kSnapshot2 && name != kLog2) << place;
    }
  }
}

TEST_F(RoomRecoveryTest, ADamagedLogIsKeptAsAWhole) {
  writeTwoGenerations();
  std::string damaged = content(kLog2);
  damaged[16 + 8] = 'x';  // in the first record
  setContent(kLog2, damaged);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=two | 2:");
  EXPECT_EQ(content(kLog2 + ".damaged"), damaged);
  EXPECT_THAT(found.notes, ElementsAre(kLog2 +
                                       ": record 1 does not match its checksum, at byte 16; its 0 records before "
                                       "are used, the whole file is kept as " +
                                       kLog2 + ".damaged"));
}

TEST_F(RoomRecoveryTest, ATornEndIsCutWithoutACopy) {
  writeTwoGenerations();
  setContent(kLog2, content(kLog2) + std::string("\x05\0\0\0....ab", 10));
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, ElementsAre(StartsWith(kLog2 + ": record 3 is not whole, at byte 36")));
  EXPECT_FALSE(fs::exists(room / (kLog2 + ".damaged")));
}

TEST_F(RoomRecoveryTest, LogsAfterADamagedOneAreSetAside) {
  {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    append(*files, "a");
    append(*files, "b");
    begin(*files);
    append(*files, "c");
    begin(*files);
    append(*files, "d");
  }
  const std::string log = content(kLog1), later = content(kLog2);
  setContent(kLog1, log.substr(0, log.size() - 1));
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a");
  EXPECT_THAT(found.notes, SizeIs(3));
  EXPECT_EQ(content(kLog2 + ".damaged"), later);
  EXPECT_TRUE(fs::exists(room / (kLog3 + ".damaged")));
}

TEST_F(RoomRecoveryTest, AMissingLogEndsWhatIsUsed) {
  {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    for (const char* record : {"a", "b", "c"}) {
      append(*files, record);
      begin(*files);
    }
  }
  const auto whole = allFiles();
  fs::remove(room / kLog2);
  EXPECT_EQ(summary(recoverAndGoOn()), "1=one | 1: a");

  setFiles(whole);
  fs::remove(room / kLog1);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1:");
  EXPECT_THAT(found.notes, Contains(HasSubstr("what happened after the snapshot of generation 1 is lost")));
}

TEST_F(RoomRecoveryTest, LogsWithoutAnySnapshotBeforeThemAreSetAside) {
  writeTwoGenerations();
  setContent(kSnapshot1, "x");
  setContent(kSnapshot2, "y");
  fs::remove(room / kLog1);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "0=");
  EXPECT_THAT(found.notes, SizeIs(3));
  EXPECT_THAT(names(), ElementsAre(kLog1, kSnapshot1 + ".damaged", kLog2 + ".damaged", kSnapshot2 + ".damaged"));
}

TEST_F(RoomRecoveryTest, FilesThatAreNotItsOwnAreLeftAlone) {
  writeTwoGenerations();
  const std::vector<std::string> foreign{"000000000000.log", "000000000001.snapshot.bak", "1.log", "notes.txt"};
  for (const std::string& name : foreign) setContent(name, "mine");
  fs::create_directory(room / "pictures");
  const auto found = recovered();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, SizeIs(foreign.size() + 1));
  for (const std::string& name : foreign) {
    EXPECT_EQ(content(name), "mine");
    EXPECT_THAT(found.notes, Contains(name + ": it is none of the room's files; left alone"));
  }
  EXPECT_TRUE(fs::is_directory(room / "pictures"));
}

TEST_F(RoomRecoveryTest, TheNumberOfNotesAboutForeignFilesIsBounded) {
  for (int k = 0; k < 40; ++k) setContent("file" + std::to_string(k), "");
  const auto found = recovered();
  EXPECT_THAT(found.notes, SizeIs(17));
  EXPECT_THAT(found.notes, Contains(HasSubstr("24 more files")));
}

TEST_F(RoomRecoveryTest, FoldersAndLinksInThePlaceOfItsFilesAreSetAside) {
  writeTwoGenerations();
  folder.write("elsewhere", content(kSnapshot2));
  fs::create_directory(room / "000000000007.snapshot");
  fs::create_directory(room / kLog3);
  fs::create_symlink(folder.path() / "elsewhere", room / "000000000006.snapshot");
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, SizeIs(3));
  EXPECT_TRUE(fs::is_directory(room / (kLog3 + ".damaged")));
  EXPECT_TRUE(fs::exists(folder.path() / "elsewhere"));
}

TEST_F(RoomRecoveryTest, FilesOfANewerVersionAreKeptForIt) {
  writeTwoGenerations();
  std::string newer = content(kSnapshot2);
  newer[7] = '2';
  setContent(kSnapshot2, newer);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a bb | 2: ccc d");
  EXPECT_THAT(found.notes, ElementsAre(AllOf(HasSubstr("a newer version"), HasSubstr(kSnapshot2 + ".damaged"))));
  EXPECT_EQ(content(kSnapshot2 + ".damaged"), newer);
}

TEST_F(RoomRecoveryTest, WhatIsSetAsideNeverReplacesWhatWasSetAsideBefore) {
  writeTwoGenerations();
  const auto whole = allFiles();
  setContent(kSnapshot2 + ".damaged", "first");
  setContent(kSnapshot2, "second");
  EXPECT_THAT(recovered().notes, SizeIs(1));
  setContent(kSnapshot2, "third");
  EXPECT_THAT(recovered().notes, SizeIs(1));
  EXPECT_EQ(content(kSnapshot2 + ".damaged"), "first");
  EXPECT_EQ(content(kSnapshot2 + ".damaged.2"), "second");
  EXPECT_EQ(content(kSnapshot2 + ".damaged.3"), "third");
}

TEST_F(RoomRecoveryTest, TheNumberOfFilesSetAsideIsBounded) {
  for (int k = 0; k < 100; ++k) {
    setContent(kSnapshot1, "damaged");
    (void)recovered();
  }
  setContent(kSnapshot1, "damaged");
  const auto found = open()->recover();
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("look at them and remove them"));
  EXPECT_EQ(content(kSnapshot1), "damaged");
}

TEST_F(RoomRecoveryTest, WhatAnInterruptedWriteLeftIsRemoved) {
  writeTwoGenerations();
  const auto before = names();
  setContent("000000000003.log.tmp", "spin");
  setContent("000000000003.snapshot.tmp", "spinsnp1...");
  EXPECT_THAT(recovered().notes, IsEmpty());
  EXPECT_EQ(names(), before);
}

TEST_F(RoomRecoveryTest, FilesThatAreTooLongAreNotRead) {
  writeTwoGenerations();
  fs::resize_file(room / kSnapshot2, kSnapshotMaxBytes + 29);
  fs::resize_file(room / kLog2, kLogMaxBytes + 1);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a bb");
  EXPECT_THAT(found.notes, SizeIs(2));
  EXPECT_THAT(found.notes, Contains(HasSubstr("it has 1073741825 bytes (at most 1073741824 are possible)")));
}

TEST_F(RoomRecoveryTest, AFolderThatCannotBeReadIsAnError) {
  writeTwoGenerations();
  const auto files = open();
  fs::remove_all(room);
  const auto found = files->recover();
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, AllOf(HasSubstr(room.string()), HasSubstr("No such file or directory")));
}

}  // namespace
}  // namespace spindrift::state
