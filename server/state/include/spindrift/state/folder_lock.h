// Keeps two servers from using one folder.
#pragma once

#include <filesystem>
#include <memory>

#include <spindrift/core/result.h>

namespace spindrift::state {

class File;

/// Holds FOLDER/lock, in which the process id of the holder stands. The operating system releases it when the process
/// ends, however it ends; the file stays.
class FolderLock {
 public:
  /// Makes the folder, with mode 0700, if necessary. kUnavailable, with the folder and the holder's process id, when
  /// it is taken, also by this process.
  static core::Result<FolderLock> take(const std::filesystem::path& folder);
  FolderLock(FolderLock&&) noexcept;
  FolderLock& operator=(FolderLock&&) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
};

}  // namespace spindrift::state
