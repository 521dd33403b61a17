// Files and folders through POSIX calls: interrupted and short calls continue, and an error names the file, the reason
// and what to do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::state {

/// Returns "could not VERB PATH (reason): what to do" for a value of errno.
core::Error systemError(std::string_view verb, const std::filesystem::path& path, int errno_value);

/// An open file descriptor. Files are made with mode 0600 and are not inherited by child processes.
class File {
 public:
  /// `flags`: those of POSIX open(). Symbolic links are not followed.
  static core::Result<File> open(const std::filesystem::path& path, int flags);
  File(File&& other) noexcept : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  ~File();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }

  [[nodiscard]] core::Result<std::uint64_t> size_bytes() const;
  /// Returns the bytes from the start of the file, at most `max_bytes`.
  [[nodiscard]] core::Result<core::Bytes> read(std::uint64_t max_bytes) const;
  /// Writes both parts one after the other at byte `at`. After an error any number of the bytes may be there.
  [[nodiscard]] core::Result<void> writeAt(std::uint64_t at, core::ByteView first, core::ByteView second = {}) const;
  /// Cuts or extends the file to `size_bytes`.
  [[nodiscard]] core::Result<void> resize(std::uint64_t size_bytes) const;
  /// Forces the content to the disk.
  [[nodiscard]] core::Result<void> sync() const;

 private:
  File(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::filesystem::path path_;
  int descriptor_;
};

/// One entry of a folder.
struct FolderEntry {
  std::string name;
  bool is_regular_file;  ///< false for folders, links and everything else
  bool is_folder;        ///< true for folders, not for links to them
};

/// Returns the entries, sorted by name.
core::Result<std::vector<FolderEntry>> listFolder(const std::filesystem::path& folder);
/// Makes the folder with mode 0700, and those above it, if they are not there. Returns the folders that have new names
/// in them, innermost last, which syncFolder() forces to the disk.
core::Result<std::vector<std::filesystem::path>> makeFolder(const std::filesystem::path& folder);
/// Forces the names in the folder to the disk: files that were made, renamed and removed.
core::Result<void> syncFolder(const std::filesystem::path& folder);
/// Replaces `to` if it exists.
core::Result<void> renameFile(const std::filesystem::path& from, const std::filesystem::path& to);
/// Gives the file a second name; an error if that exists.
core::Result<void> linkFile(const std::filesystem::path& from, const std::filesystem::path& to);
/// Writes both parts under PATH.tmp and renames the file when it is whole, so that PATH is never a part of it. With
/// `is_forced` its content is forced to the disk before; syncFolder() does so with its name. After an error PATH is
/// what it was.
core::Result<void> writeWhole(const std::filesystem::path& path, core::ByteView first, core::ByteView second,
                              bool is_forced);
/// No error if there is no such file.
core::Result<void> removeFile(const std::filesystem::path& path);
/// Returns PATH.damaged, or PATH.damaged.2 and so on: the first that is not there. kUnavailable when there are
/// kSetAsideMaxCount of them.
core::Result<std::filesystem::path> nameToSetAside(const std::filesystem::path& path);
/// Renames the file to that name, which it returns.
core::Result<std::filesystem::path> setAside(const std::filesystem::path& path);
inline constexpr std::string_view kTemporarySuffix = ".tmp";
inline constexpr int kSetAsideMaxCount = 100;

}  // namespace spindrift::state
