#include <filesystem>
#include <sstream>

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
  /// Snapshot 1 and then logs with these records, as restarts make them whose snapshots could not be written.
  void writeLogs(const std::vector<std::string>& logs) const {
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto files = openRecovered();
      const StatePoint point = begin(*files);
      if (k == 0) writeSnapshot(*files, point, "one");
      std::istringstream words(logs[k]);
      for (std::string word; words >> word;) append(*files, word);
    }
  }
  /// Recovers, continues with a new generation, and checks that the next recovery finds both. Returns what was found.
  RoomFiles::Recovered recoverAndGoOn() const {
    RoomFiles::Recovered found;
    std::uint64_t next = 0;
    {
      const auto files = open();
      found = recover(*files);
      next = begin(*files).generation;
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
    std::size_t end = kPoolLogBytes;
    for (const std::string& record : records) {
      end += 20 + record.size();
      if (end <= size) expected += " " + record;
    }
    auto found = recoverAndGoOn();
    const std::string text = summary(found);
    ASSERT_EQ(text, expected) << "cut to " << size << " bytes";
    ASSERT_EQ(found.notes.empty(), size == log.size() || content(kLog1).size() == size) << size;
  }
}

TEST_F(RoomRecoveryTest, CutSnapshotGivesTheOneBeforeAndBothLogs) {
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
  damaged[kPoolLogBytes + 20] = 'x';  // in the first record
  setContent(kLog2, damaged);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=two | 2:");
  EXPECT_EQ(content(kLog2 + ".damaged"), damaged);
  EXPECT_THAT(found.notes, ElementsAre(kLog2 +
                                       ": record 3 does not match its checksum, at byte 36; its 0 records before "
                                       "are used, the whole file is kept as " +
                                       kLog2 + ".damaged"));
}

TEST_F(RoomRecoveryTest, ATornEndIsCutWithoutACopy) {
  writeTwoGenerations();
  setContent(kLog2, content(kLog2) + std::string(21, 'x').substr(0, 10));
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, ElementsAre(StartsWith(kLog2 + ": record 5 is not whole, at byte 80")));
  EXPECT_FALSE(fs::exists(room / (kLog2 + ".damaged")));
}

TEST_F(RoomRecoveryTest, LogsAfterADamagedOneAreSetAside) {
  writeLogs({"a b", "c", "d"});
  const std::string log = content(kLog1), later = content(kLog2);
  setContent(kLog1, log.substr(0, log.size() - 1));
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a");
  EXPECT_THAT(found.notes, SizeIs(3));
  EXPECT_EQ(content(kLog2 + ".damaged"), later);
  EXPECT_TRUE(fs::exists(room / (kLog3 + ".damaged")));
}

TEST_F(RoomRecoveryTest, AMissingLogEndsWhatIsUsed) {
  writeLogs({"a", "b", "c"});
  const auto whole = allFiles();
  fs::remove(room / kLog2);
  EXPECT_EQ(summary(recoverAndGoOn()), "1=one | 1: a");

  setFiles(whole);
  fs::remove(room / kLog1);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1:");
  EXPECT_THAT(found.notes, Contains(HasSubstr("what happened after the snapshot of generation 1 is lost")));
}

TEST_F(RoomRecoveryTest, LogsWithoutASnapshotAreSetAside) {
  writeTwoGenerations();
  setContent(kSnapshot1, "x");
  setContent(kSnapshot2, "y");
  fs::remove(room / kLog1);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "0=");
  EXPECT_THAT(found.notes, SizeIs(3));
  EXPECT_THAT(names(), ElementsAre(kLog1, kSnapshot1 + ".damaged", kLog2 + ".damaged", kSnapshot2 + ".damaged"));
}

TEST_F(RoomRecoveryTest, ForeignFilesAreLeftAlone) {
  writeTwoGenerations();
  const std::vector<std::string> foreign{"000000000000.log", "000000000001.snapshot.bak", "1.log", "notes.txt"};
  for (const std::string& name : foreign) setContent(name, "mine");
  fs::create_directory(room / "pictures");
  const auto found = recovered();
  EXPECT_EQ(summary(found), "2=two | 2: ccc d");
  EXPECT_THAT(found.notes, SizeIs(foreign.size() + 1));
  for (const std::string& name : foreign) {
    EXPECT_EQ(content(name), "mine");
    EXPECT_THAT(found.notes, Contains(name + ": not one of the room's files; left alone"));
  }
  EXPECT_TRUE(fs::is_directory(room / "pictures"));
}

TEST_F(RoomRecoveryTest, TheNumberOfNotesAboutForeignFilesIsBounded) {
  for (int k = 0; k < 40; ++k) setContent("file" + std::to_string(k), "");
  const auto found = recovered();
  EXPECT_THAT(found.notes, SizeIs(17));
  EXPECT_THAT(found.notes, Contains(HasSubstr("24 more files")));
}

TEST_F(RoomRecoveryTest, FoldersAndLinksUnderItsNamesAreSetAside) {
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
  newer[7] = '3';
  setContent(kSnapshot2, newer);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a bb | 2: ccc d");
  EXPECT_THAT(found.notes, ElementsAre(AllOf(HasSubstr("a newer version"), HasSubstr(kSnapshot2 + ".damaged"))));
  EXPECT_EQ(content(kSnapshot2 + ".damaged"), newer);
}

/// Returns the records of a log file, each with its header.
std::vector<std::string> recordsOf(const std::string& file) {
  std::vector<std::string> out;
  const ParsedLog log = parseLog(viewOf(file), {kRoom, 1});
  for (const core::ByteView record : log.records) {
    const auto at = static_cast<std::size_t>(reinterpret_cast<const char*>(record.data()) - file.data());
    out.push_back(file.substr(at - kRecordHeaderBytes, kRecordHeaderBytes + record.size()));
  }
  return out;
}

TEST_F(RoomRecoveryTest, WrongRecordNumberEndsTheUsedPart) {
  writeLogs({"a b c"});
  const std::string log = content(kLog1), start = log.substr(0, kPoolLogBytes);
  const auto record = recordsOf(log);
  const auto whole = allFiles();
  const auto recoverWith = [&](const std::string& records) {
    setFiles(whole);
    setContent(kLog1, start + records);
    const auto found = recoverAndGoOn();
    EXPECT_THAT(found.notes, SizeIs(1));
    EXPECT_EQ(content(kLog1 + ".damaged"), start + records) << "all of it is kept";
    return summary(found);
  };
  EXPECT_EQ(recoverWith(record[0] + record[0] + record[1] + record[2]), "1=one | 1: a");
  EXPECT_EQ(recoverWith(record[0] + record[2]), "1=one | 1: a");
  EXPECT_EQ(recoverWith(record[0] + record[2] + record[1]), "1=one | 1: a");
  EXPECT_EQ(recoverWith(record[1] + record[2]), "1=one | 1:");
}

TEST_F(RoomRecoveryTest, OlderLogCutBetweenRecordsIsReported) {
  writeLogs({"a b c", "d e"});
  const std::string log = content(kLog1), later = content(kLog2);
  setContent(kLog1, log.substr(0, log.size() - 2 * (kRecordHeaderBytes + 1)));
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a");
  EXPECT_THAT(found.notes, ElementsAre(AllOf(HasSubstr(kLog2), HasSubstr("the records 2 to 3 before it are missing"),
                                             HasSubstr("set aside"))));
  EXPECT_EQ(content(kLog2 + ".damaged"), later);
}

TEST_F(RoomRecoveryTest, UnusedLogsAreReportedWithTheirRecords) {
  writeLogs({"a", "b c", "d e f"});
  fs::remove(room / kLog2);
  EXPECT_THAT(recoverAndGoOn().notes, ElementsAre(AllOf(HasSubstr(kLog3), HasSubstr("its 3 records are not used"))));
}

TEST_F(RoomRecoveryTest, FilesOfAnotherRoomAreNotUsed) {
  writeTwoGenerations();
  const auto other = folder.path() / "other";
  {
    auto files = RoomFiles::open(other, "other", {.sync = Sync::kNever});
    ASSERT_TRUE(files && (*files)->recover());
    for (const char* state : {"theirs", "theirs as well"}) {
      writeSnapshot(**files, begin(**files), state);
      append(**files, "their record");
    }
  }
  const auto whole = allFiles();
  setContent(kSnapshot2, contentOf(other / kSnapshot2));
  auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "1=one | 1: a bb | 2: ccc d") << "the snapshot before, with both logs";
  EXPECT_THAT(found.notes, ElementsAre(AllOf(HasSubstr("it is of the room 'other'"), HasSubstr("set aside"))));

  setFiles(whole);
  setContent(kLog2, contentOf(other / kLog2));
  EXPECT_EQ(summary(recoverAndGoOn()), "2=two | 2:");

  fs::remove_all(room);
  fs::copy(other, room);
  found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "0=") << "a folder under another name";
  EXPECT_THAT(found.notes, testing::Each(HasSubstr("it is of the room 'other'")));
  EXPECT_EQ(content(kSnapshot1 + ".damaged"), contentOf(other / kSnapshot1)) << "it can be used under its old name";
}

TEST_F(RoomRecoveryTest, RefusedSnapshotGivesTheOneBefore) {
  writeTwoGenerations();
  const auto before = allFiles();
  {
    const auto files = open();
    EXPECT_EQ(summary(recover(*files)), "2=two | 2: ccc d");
    const auto older = files->recover(2);
    ASSERT_TRUE(older);
    EXPECT_EQ(summary(*older), "1=one | 1: a bb | 2: ccc d");
    const auto none = files->recover(1);
    ASSERT_TRUE(none);
    EXPECT_EQ(none->generation, 0U);
  }
  EXPECT_EQ(allFiles(), before) << "nothing is changed before it is known what can be used";
  {
    const auto files = open();
    ASSERT_TRUE(files->recover(2));
    writeSnapshot(*files, begin(*files), "three");
  }
  EXPECT_EQ(summary(recovered()), "3=three | 3:");
  EXPECT_TRUE(fs::exists(room / (kSnapshot2 + ".damaged")));
}

TEST_F(RoomRecoveryTest, FilesOfTheVersionBeforeAreRead) {
  const auto old = [](const char* magic, char generation, const std::string& rest) {
    return magic + std::string(1, generation) + std::string(7, '\0') + rest;
  };
  const std::string state = std::string("\x09\0\0\0\0\0\0\0", 8) + "\x83\x92\x06\xE3" + "123456789";
  const std::string record = std::string("\x09\0\0\0", 4) + "\x83\x92\x06\xE3" + "123456789";
  const std::vector<std::pair<std::string, std::string>> files{{kLog1, old("spinlog1", 1, record)},
                                                               {kSnapshot1, old("spinsnp1", 1, state)},
                                                               {kLog2, old("spinlog1", 2, record + record)},
                                                               {kSnapshot2, old("spinsnp1", 2, state)}};
  setFiles(files);
  const auto found = recoverAndGoOn();
  EXPECT_EQ(summary(found), "2=123456789 | 2: 123456789 123456789");
  EXPECT_THAT(found.notes, IsEmpty());
  // The newest one of that version is lost after all, when this version has continued from it.
  fs::remove(room / kSnapshot2);
  EXPECT_EQ(summary(recovered()), "1=123456789 | 1: 123456789 | 2: 123456789 123456789 | 3: new");
}

TEST_F(RoomRecoveryTest, FilesSetAsideNeverReplaceEarlierOnes) {
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

TEST_F(RoomRecoveryTest, TemporaryFilesAreRemoved) {
  writeTwoGenerations();
  const auto before = names();
  setContent("000000000003.log.tmp", "spin");
  setContent("000000000003.snapshot.tmp", "spinsnp2...");
  EXPECT_THAT(recovered().notes, IsEmpty());
  EXPECT_EQ(names(), before);
}

TEST_F(RoomRecoveryTest, FilesThatAreTooLongAreNotRead) {
  writeTwoGenerations();
  fs::resize_file(room / kSnapshot2, kSnapshotMaxBytes + 400);
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
