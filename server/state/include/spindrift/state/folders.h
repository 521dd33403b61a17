// The folder of a server's state: its lock, and the folders of all rooms, FOLDER/rooms/NAME.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/core/result.h>

namespace spindrift::state {

class File;

/// Holds FOLDER/lock, in which the process id of the holder stands, until its last copy ends. The operating system
/// releases it when the process ends, however it ends; the file stays.
using FolderLock = std::shared_ptr<const File>;

/// Makes the folder, with mode 0700, if necessary. kUnavailable, with the folder and the holder's process id, when the
/// lock is taken, also by this process.
core::Result<FolderLock> lockFolder(const std::filesystem::path& folder);

/// Returns the folder of a room, which need not exist. kInvalidInput for what is not a name of a room
/// (core::isRoomName).
core::Result<std::filesystem::path> roomFolder(const std::filesystem::path& folder, const std::string& name);

/// The folders in FOLDER/rooms, sorted; those that begin with a dot are this program's own.
struct RoomList {
  std::vector<std::string> names;          ///< of rooms
  std::vector<std::string> refused_names;  ///< that no room can have: any bytes
};
core::Result<RoomList> listRooms(const std::filesystem::path& folder);

/// Moves the folder of a room whose files cannot be used to FOLDER/aside/NAME, NAME.2 and so on; returns the new path.
core::Result<std::filesystem::path> setRoomAside(const std::filesystem::path& folder, const std::string& name);

/// Removes the files of a closed room; no error if it has none. The folder is renamed first, so that a room is there as
/// a whole or not at all.
core::Result<void> removeRoom(const std::filesystem::path& folder, const std::string& name);

/// Returns whether the room's folder holds more than logs: a room without a snapshot cannot continue, and has not been
/// open. No error if it has none.
core::Result<bool> hasState(const std::filesystem::path& folder, const std::string& name);

/// Removes what is left of rooms whose removal was interrupted. Call it at the start, while the FolderLock is held.
core::Result<void> finishRemovals(const std::filesystem::path& folder);

}  // namespace spindrift::state
