// Finds a room's state in its folder, and leaves the folder so that the next generation continues what was found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include <spindrift/core/result.h>
#include <spindrift/state/room_files.h>

#include "file_format.h"

namespace spindrift::state {

struct RecoveredFolder {
  RoomFiles::Recovered content;
  std::uint64_t last_generation = 0;  ///< of the newest log; the next one continues it
  std::uint64_t next_number = 1;      ///< of the next record
  std::uint64_t snapshot_bytes = 0;   ///< of the snapshot's file
};

/// As RoomFiles::recover(). `is_forced`: what is changed in the folder is forced to the disk.
core::Result<RecoveredFolder> recoverFolder(const std::filesystem::path& folder, std::string_view room,
                                            std::uint64_t before, bool is_forced);

/// Makes the log of a generation, with its header alone. The file appears under its name when it is whole.
core::Result<void> makeEmptyLog(const std::filesystem::path& folder, const FileOwner& owner, std::uint64_t first_number,
                                bool is_forced);

}  // namespace spindrift::state
