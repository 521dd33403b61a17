#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <spindrift/state/posix_file.h>

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;
using core::Error;
using core::ErrorCode;

constexpr mode_t kFileMode = 0600;
constexpr fs::perms kFolderMode = fs::perms::owner_all;

std::string_view adviceFor(int errno_value) {
  switch (errno_value) {
    case ENOSPC:
    case EDQUOT:
      return "free space on its file system";
    case EFBIG:
      return "raise the process's limit for the size of files (ulimit -f)";
    case EACCES:
    case EPERM:
    case EROFS:
      return "give the user of this process the right to write there, or choose another folder";
    case EMFILE:
    case ENFILE:
      return "raise the limit for open files (ulimit -n)";
    case EIO:
      return "check the disk";
    case ENOTDIR:
    case ELOOP:
    case EISDIR:
      return "remove what is in the way, or choose another folder";
    default:
      return "check its folder and file system";
  }
}

/// Repeats a call while signals interrupt it.
template <typename Call>
auto uninterrupted(Call call) {
  while (true) {
    const auto result = call();
    if (result != -1 || errno != EINTR) return result;
  }
}

iovec partOf(core::ByteView bytes) {
  return {const_cast<std::uint8_t*>(bytes.data()),
          bytes.size()};  // NOLINT(cppcoreguidelines-pro-type-const-cast): POSIX
}

}  // namespace

Error systemError(std::string_view verb, const fs::path& path, int errno_value) {
  return {ErrorCode::kUnavailable, fmt::format("could not {} {} ({}): {}", verb, path.string(),
                                               std::generic_category().message(errno_value), adviceFor(errno_value))};
}

core::Result<File> File::open(const fs::path& path, int flags) {
  const int descriptor = uninterrupted([&] { return ::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, kFileMode); });
  if (descriptor < 0) return systemError(flags & O_TRUNC ? "make" : "open", path, errno);
  return File(path, descriptor);
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

core::Result<std::uint64_t> File::size_bytes() const {
  struct stat about {};
  if (::fstat(descriptor_, &about) != 0) return systemError("read", path_, errno);
  return static_cast<std::uint64_t>(about.st_size);
}

core::Result<core::Bytes> File::read(std::uint64_t max_bytes) const {
  const auto size = size_bytes();
  if (!size) return size.error();
  core::Bytes bytes(std::min(*size, max_bytes));
  std::size_t at = 0;
  while (at < bytes.size()) {
    const ssize_t count = uninterrupted(
        [&] { return ::pread(descriptor_, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at)); });
    if (count < 0) return systemError("read", path_, errno);
    if (count == 0) break;  // the file became shorter meanwhile
    at += static_cast<std::size_t>(count);
  }
  bytes.resize(at);
  return bytes;
}

core::Result<void> File::writeAt(std::uint64_t at, core::ByteView first, core::ByteView second) const {
  while (!first.empty() || !second.empty()) {
    const std::array<iovec, 2> parts{partOf(first), partOf(second)};
    const ssize_t count = uninterrupted(
        [&] { return ::pwritev(descriptor_, parts.data(), static_cast<int>(parts.size()), static_cast<off_t>(at)); });
    if (count < 0) return systemError("write", path_, errno);
    if (count == 0) return systemError("write", path_, EIO);  // never, for regular files
    const auto written = static_cast<std::size_t>(count);
    at += written;
    const std::size_t of_first = std::min(written, first.size());
    first = first.subspan(of_first);
    second = second.subspan(written - of_first);
  }
  return {};
}

core::Result<void> File::resize(std::uint64_t size_bytes) const {
  if (uninterrupted([&] { return ::ftruncate(descriptor_, static_cast<off_t>(size_bytes)); }) != 0)
    return systemError("cut", path_, errno);
  return {};
}

core::Result<void> File::sync() const {
  if (uninterrupted([&] { return ::fdatasync(descriptor_); }) != 0)
    return systemError("force to the disk", path_, errno);
  return {};
}

core::Result<std::vector<FolderEntry>> listFolder(const fs::path& folder) {
  std::vector<FolderEntry> entries;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    const fs::file_status status = entry->symlink_status(unknown);
    entries.push_back({entry->path().filename().string(), fs::is_regular_file(status), fs::is_directory(status)});
  }
  if (error) return systemError("list", folder, error.value());
  std::ranges::sort(entries, {}, &FolderEntry::name);
  return entries;
}

core::Result<std::vector<fs::path>> makeFolder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return std::vector<fs::path>();
  const fs::path parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  std::vector<fs::path> changed;
  if (parent != folder) {
    auto made = makeFolder(parent);
    if (!made) return made;
    changed = *std::move(made);
  }
  // Another process may have been faster.
  if (::mkdir(folder.c_str(), static_cast<mode_t>(kFolderMode)) != 0 && errno != EEXIST)
    return systemError("make the folder", folder, errno);
  changed.push_back(parent);
  return changed;
}

core::Result<void> syncFolder(const fs::path& folder) {
  const int descriptor = uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) return systemError("open the folder", folder, errno);
  const bool ok = uninterrupted([&] { return ::fsync(descriptor); }) == 0;
  const int errno_value = errno;
  ::close(descriptor);
  if (!ok) return systemError("force to the disk the folder", folder, errno_value);
  return {};
}

core::Result<void> renameFile(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return systemError("rename to " + to.filename().string(), from, errno);
  return {};
}

core::Result<void> linkFile(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) != 0)
    return systemError("make the second name " + to.filename().string() + " of", from, errno);
  return {};
}

core::Result<void> writeWhole(const fs::path& path, core::ByteView first, core::ByteView second, bool is_forced) {
  fs::path temporary = path;
  temporary += kTemporarySuffix;
  const auto write = [&]() -> core::Result<void> {
    const auto file = File::open(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file) return file.error();
    if (auto written = file->writeAt(0, first, second); !written) return written;
    if (is_forced) {
      if (auto synced = file->sync(); !synced) return synced;
    }
    return renameFile(temporary, path);
  };
  auto written = write();
  if (!written) (void)removeFile(temporary);  // the first error says more
  return written;
}

core::Result<void> removeFile(const fs::path& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return systemError("remove", path, errno);
  return {};
}

core::Result<fs::path> nameToSetAside(const fs::path& path) {
  for (int number = 1; number <= kSetAsideMaxCount; ++number) {
    fs::path name = path;
    name += number == 1 ? std::string(".damaged") : ".damaged." + std::to_string(number);
    std::error_code error;
    if (fs::symlink_status(name, error).type() == fs::file_type::not_found) return name;
  }
  return core::unavailable(fmt::format("there are {} files {}.damaged already: look at them and remove them",
                                       kSetAsideMaxCount, path.string()));
}

core::Result<fs::path> setAside(const fs::path& path) {
  auto aside = nameToSetAside(path);
  if (!aside) return aside;
  if (auto renamed = renameFile(path, *aside); !renamed) return renamed.error();
  return aside;
}

}  // namespace spindrift::state
