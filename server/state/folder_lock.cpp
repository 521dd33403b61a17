#include <cerrno>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
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

core::Result<FolderLock> lockFolder(const std::filesystem::path& folder) {
  const auto made = makeFolder(folder);
  if (!made) return made.error();
  for (const std::filesystem::path& parent : *made) {
    if (auto synced = syncFolder(parent); !synced) return synced.error();
  }
  auto file = File::open(folder / "lock", O_RDWR | O_CREAT);
  if (!file) return file.error();
  while (::flock(file->descriptor(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK) return systemError("lock", file->path(), errno);
    const auto text = file->read(kPidMaxBytes);
    return core::Error{core::ErrorCode::kUnavailable,
                       fmt::format("the folder {} is in use by {}: end that server, or choose another folder",
                                   folder.string(), holderOf(text ? *text : core::Bytes()))};
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (auto cut = file->resize(0); !cut) return cut.error();
  if (auto written = file->writeAt(0, core::viewOf(pid)); !written) return written.error();
  return FolderLock(std::make_shared<const File>(*std::move(file)));
}

}  // namespace spindrift::state
