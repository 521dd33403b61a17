// A room's folder for the tests of server/state, and its state as one line of text.
#pragma once

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/state/room_files.h>

#include "file_format.h"
#include "temporary_folder.h"

namespace spindrift::state {

inline core::ByteView viewOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline std::string textOf(core::ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// "2=state | 2: a b | 3: c": the snapshot's generation and content, then each log's generation and records.
inline std::string summary(const RoomFiles::Recovered& found) {
  std::string text = std::to_string(found.generation) + "=" + textOf(found.snapshot);
  for (const RoomFiles::Log& log : found.logs) {
    text += " | " + std::to_string(log.generation) + ":";
    for (const core::ByteView record : log.records) text += " " + textOf(record);
  }
  return text;
}

inline constexpr const char* kRoom = "pool";
/// Sizes of the headers in the files of that room.
inline constexpr std::size_t kPoolLogBytes = kStartBytes + 4, kPoolSnapshotBytes = kSnapshotHeaderBytes + 4;

struct StateTest : testing::Test {
  test::TemporaryFolder folder;
  const std::filesystem::path room = folder.path() / "room";

  /// The room's files before recover().
  std::unique_ptr<RoomFiles> open(RoomFiles::Options options = {.sync = Sync::kNever}) const {
    auto files = RoomFiles::open(room, kRoom, options);
    EXPECT_TRUE(files) << files.error().message;
    return std::move(*files);
  }
  std::unique_ptr<RoomFiles> openRecovered(RoomFiles::Options options = {.sync = Sync::kNever}) const {
    auto files = open(options);
    (void)recover(*files);
    return files;
  }
  static RoomFiles::Recovered recover(RoomFiles& files) {
    auto found = files.recover();
    EXPECT_TRUE(found) << found.error().message;
    return found ? std::move(*found) : RoomFiles::Recovered();
  }
  /// What a restarted server finds.
  RoomFiles::Recovered recovered() const { return recover(*open()); }

  static StatePoint begin(RoomFiles& files) {
    const auto point = files.beginGeneration();
    EXPECT_TRUE(point) << point.error().message;
    return point ? *point : StatePoint();
  }
  static void append(RoomFiles& files, std::string_view record) {
    const auto done = files.append(viewOf(record));
    EXPECT_TRUE(done) << done.error().message;
  }
  static void writeSnapshot(RoomFiles& files, const StatePoint& point, std::string_view payload) {
    const auto done = files.writeSnapshot(point, viewOf(payload));
    EXPECT_TRUE(done) << done.error().message;
    const auto removed = files.removeOldGenerations();
    EXPECT_TRUE(removed) << removed.error().message;
  }
  /// Generations 1 and 2, each with a snapshot: "1=one | 1: a bb" and "2=two | 2: ccc d".
  void writeTwoGenerations() const {
    const auto files = openRecovered();
    writeSnapshot(*files, begin(*files), "one");
    append(*files, "a");
    append(*files, "bb");
    writeSnapshot(*files, begin(*files), "two");
    append(*files, "ccc");
    append(*files, "d");
  }

  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(room)) out.push_back(entry.path().filename().string());
    std::ranges::sort(out);
    return out;
  }
  std::string content(const std::string& name) const { return contentOf(room / name); }
  static std::string contentOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void setContent(const std::string& name, std::string_view content) const {
    std::filesystem::remove(room / name);  // ext4 flushes a file that is emptied and written again, which takes long
    folder.write("room/" + name, content);
  }
  /// Leaves exactly these files in the folder.
  void setFiles(const std::vector<std::pair<std::string, std::string>>& files) const {
    std::filesystem::remove_all(room);
    std::filesystem::create_directory(room);
    for (const auto& [name, bytes] : files) setContent(name, bytes);
  }
  std::vector<std::pair<std::string, std::string>> allFiles() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const std::string& name : names()) out.emplace_back(name, content(name));
    return out;
  }
};

inline const std::string kLog1 = "000000000001.log", kLog2 = "000000000002.log", kLog3 = "000000000003.log";
inline const std::string kSnapshot1 = "000000000001.snapshot", kSnapshot2 = "000000000002.snapshot";

}  // namespace spindrift::state
