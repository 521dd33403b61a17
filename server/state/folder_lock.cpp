#include <cerrno>
#include <string>
#include <utility>

#include <sys/file.h>
#include <unistd.h>

#include <spindrift/state/folder_lock.h>

#include "posix_file.h"

namespace spindrift::state {
namespace {

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

}  // namespace

FolderLock::FolderLock(std::unique_ptr<File> file) : file_(std::move(file)) {}
FolderLock::FolderLock(FolderLock&&) noexcept = default;
FolderLock& FolderLock::operator=(FolderLock&&) noexcept = default;
FolderLock::~FolderLock() = default;

core::Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  const auto made = makeFolder(folder);
  if (!made) return made.error();
  for (const std::filesystem::path& parent : *made) {
    if (auto synced = syncFolder(parent); !synced) return synced.error();
  }
  auto file = File::openOrCreate(folder / "lock");
  if (!file) return file.error();
  while (::flock(file->descriptor(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return systemError("lock", file->path(), errno);
    const auto text = file->read(kPidMaxBytes);
    return core::Error{core::ErrorCode::kUnavailable, "the folder " + folder.string() + " is in use by " +
                                                          (text ? holderOf(*text) : std::string("another process")) +
                                                          ": end that server, or choose another folder"};
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (auto cut = file->resize(0); !cut) return cut.error();
  const core::ByteView bytes(reinterpret_cast<const std::uint8_t*>(pid.data()), pid.size());
  if (auto written = file->writeAt(0, bytes); !written) return written.error();
  return FolderLock(std::make_unique<File>(std::move(*file)));
}

}  // namespace spindrift::state
