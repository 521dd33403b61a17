// Finds a room's state in its folder, and leaves the folder so that the next generation continues what was found.
#pragma once

#include <cstdint>
#include <filesystem>

#include <spindrift/core/result.h>
#include <spindrift/state/room_files.h>

namespace spindrift::state {

struct RecoveredFolder {
  RoomFiles::Recovered content;
  std::uint64_t last_generation = 0;  ///< of the newest log; the next one continues it
  std::uint64_t snapshot_bytes = 0;   ///< of the snapshot's file
};

/// `is_forced`: what is changed in the folder is forced to the disk.
core::Result<RecoveredFolder> recoverFolder(const std::filesystem::path& folder, bool is_forced);

/// Makes the log of a generation, with its header alone. The file appears under its name when it is whole.
core::Result<void> makeEmptyLog(const std::filesystem::path& folder, std::uint64_t generation, bool is_forced);

}  // namespace spindrift::state
