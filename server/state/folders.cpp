#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <spindrift/core/room_name.h>
#include <spindrift/core/text.h>
#include <spindrift/state/folders.h>
#include <spindrift/state/posix_file.h>

#include "file_format.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPidMaxBytes = 20;

/// Returns "process 123" from the text of a lock file, "another process" if it has none.
std::string holderOf(const core::Bytes& text) {
  std::string digits;
  for (const std::uint8_t byte : text) {
    if (byte < '0' || byte > '9') break;
    digits += static_cast<char>(byte);
  }
  return digits.empty() ? "another process" : "process " + digits;
}

/// The name of a room never begins with a dot.
constexpr std::string_view kRemovedPrefix = ".removed.";

fs::path roomsOf(const fs::path& folder) {
  return folder / "rooms";
}

/// Returns the entries of FOLDER/rooms; none if it does not exist.
core::Result<std::vector<FolderEntry>> entriesOf(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(roomsOf(folder), error) && !error) return std::vector<FolderEntry>();
  return listFolder(roomsOf(folder));
}

core::Result<void> removeTree(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) return systemError("remove", path, error.value());
  return {};
}

}  // namespace

core::Result<FolderLock> lockFolder(const fs::path& folder) {
  const auto made = makeFolder(folder);
  if (!made) return made.error();
  for (const fs::path& parent : *made) {
    if (auto synced = syncFolder(parent); !synced) return synced.error();
  }
  auto file = File::open(folder / "lock", O_RDWR | O_CREAT);
  if (!file) return file.error();
  while (::flock(file->descriptor(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return systemError("lock", file->path(), errno);
    const auto text = file->read(kPidMaxBytes);
    return core::unavailable(fmt::format("the folder {} is in use by {}: end that server, or choose another folder",
                                         folder.string(), holderOf(text ? *text : core::Bytes())));
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (auto cut = file->resize(0); !cut) return cut.error();
  if (auto written = file->writeAt(0, core::viewOf(pid)); !written) return written.error();
  return FolderLock(std::make_shared<const File>(*std::move(file)));
}

core::Result<fs::path> roomFolder(const fs::path& folder, const std::string& name) {
  if (core::isRoomName(name)) return roomsOf(folder) / name;
  return core::invalid(fmt::format("'{}' is not a name of a room: it has {}",
                                   core::cleanText(name, 4 * core::kRoomNameMaxBytes), core::kRoomNameRule));
}

core::Result<RoomList> listRooms(const fs::path& folder) {
  const auto entries = entriesOf(folder);
  if (!entries) return entries.error();
  RoomList out;
  for (const FolderEntry& entry : *entries) {
    if (!entry.is_folder || entry.name.front() == '.') continue;
    (core::isRoomName(entry.name) ? out.names : out.refused_names).push_back(entry.name);
  }
  return out;
}

core::Result<fs::path> setRoomAside(const fs::path& folder, const std::string& name) {
  const auto room = roomFolder(folder, name);
  if (!room) return room.error();
  const fs::path aside = folder / "aside";
  std::error_code error;
  fs::create_directories(aside, error);
  if (error) return systemError("make", aside, error.value());
  fs::path target = aside / name;
  for (int k = 2; fs::exists(target, error); ++k) target = aside / (name + "." + std::to_string(k));
  if (auto renamed = renameFile(*room, target); !renamed) return renamed.error();
  if (auto synced = syncFolder(roomsOf(folder)); !synced) return synced.error();
  return target;
}

core::Result<void> removeRoom(const fs::path& folder, const std::string& name) {
  const auto room = roomFolder(folder, name);
  if (!room) return room.error();
  std::error_code error;
  if (!fs::exists(*room, error) && !error) return {};
  const fs::path removed = roomsOf(folder) / (std::string(kRemovedPrefix) + name);
  // Left by a removal of an earlier room of this name.
  if (auto cleared = removeTree(removed); !cleared) return cleared;
  if (auto renamed = renameFile(*room, removed); !renamed) return renamed;
  if (auto synced = syncFolder(roomsOf(folder)); !synced) return synced;
  return removeTree(removed);
}

core::Result<bool> hasState(const fs::path& folder, const std::string& name) {
  const auto room = roomFolder(folder, name);
  if (!room) return room.error();
  std::error_code error;
  if (!fs::exists(*room, error) && !error) return false;
  const auto entries = listFolder(*room);
  if (!entries) return entries.error();
  return std::ranges::any_of(*entries, [](const FolderEntry& entry) {
    const FileKind kind = parseFileName(entry.name).kind;
    return kind != FileKind::kLog && kind != FileKind::kTemporary;
  });
}

core::Result<void> finishRemovals(const fs::path& folder) {
  const auto entries = entriesOf(folder);
  if (!entries) return entries.error();
  for (const FolderEntry& entry : *entries) {
    if (!entry.name.starts_with(kRemovedPrefix)) continue;
    if (auto removed = removeTree(roomsOf(folder) / entry.name); !removed) return removed;
  }
  return {};
}

}  // namespace spindrift::state
