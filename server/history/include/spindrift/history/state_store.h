// The state of all rooms of a server on disk: what was found there at the start, and who keeps it from now on.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/worker.h>
#include <spindrift/history/state_keeper.h>
#include <spindrift/state/folders.h>
#include <spindrift/state/room_files.h>

namespace spindrift::history {

struct StateOptions {
  std::filesystem::path folder;
  state::Sync sync = state::Sync::kSnapshots;
  std::chrono::milliseconds snapshot_interval{10'000};
  std::uint32_t kept_generation_count = 2;  ///< snapshots per room that stay on disk
  /// Several servers use the folder: each room is locked by the one that runs it, instead of the folder.
  bool is_shared = false;
};

/// A room's place on disk.
struct RoomPlace {
  std::optional<KeptRoom> kept;         ///< nullopt: nothing usable was there
  std::uint64_t generation = 0;         ///< of the snapshot in `kept`
  std::unique_ptr<StateKeeper> keeper;  ///< null: the state is not kept
};

class StateStore {
 public:
  /// Takes the folder for this server unless it is shared. Errors: kUnavailable when another server uses it, or it
  /// cannot be written.
  static core::Result<std::shared_ptr<StateStore>> open(const StateOptions& options);
  StateStore(const StateStore&) = delete;
  StateStore& operator=(const StateStore&) = delete;

  /// Returns the names of the rooms that have files, sorted. Folders whose names no room can have are left out.
  [[nodiscard]] core::Result<std::vector<std::string>> rooms() const;
  /// Reads what there is of a room and logs what cannot be used: from the newest snapshot that is whole and of this
  /// room, and older than generation `before`, which a caller gives that could not continue from that one. If there are
  /// snapshots and none can be used, all files of the room are moved out of the way. One place per room at a time.
  /// Error kUnavailable when another server runs the room, in a shared folder.
  core::Result<RoomPlace> place(const std::string& room, std::uint64_t before = state::RoomFiles::kNewest);
  /// Moves the files of a room out of the way; returns where to.
  core::Result<std::filesystem::path> setAside(const std::string& room) const;
  /// Removes the files of a closed room.
  core::Result<void> remove(const std::string& room) const;
  /// Removes what a room leaves that was not opened: a folder with nothing but logs.
  core::Result<void> removeUnused(const std::string& room) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return options_.folder; }

 private:
  StateStore(StateOptions options, state::FolderLock lock);
  /// In a shared folder, takes a room for this server. Error kUnavailable when another one has it.
  [[nodiscard]] core::Result<state::FolderLock> lockRoom(const std::string& room) const;

  const StateOptions options_;
  state::FolderLock lock_;  ///< of the whole folder; null if it is shared
  core::Worker writer_;
};

}  // namespace spindrift::history
