// Keeps two servers from using one folder.
#pragma once

#include <filesystem>
#include <memory>

#include <spindrift/core/result.h>

namespace spindrift::state {

class File;

/// Holds FOLDER/lock, in which the process id of the holder stands, until its last copy ends. The operating system
/// releases it when the process ends, however it ends; the file stays.
using FolderLock = std::shared_ptr<const File>;

/// Makes the folder, with mode 0700, if necessary. kUnavailable, with the folder and the holder's process id, when the
/// lock is taken, also by this process.
core::Result<FolderLock> lockFolder(const std::filesystem::path& folder);

}  // namespace spindrift::state
