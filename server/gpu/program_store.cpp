#include "program_store.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/core/crc32c.h>

namespace spindrift::gpu {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kMagic = {'S', 'p', 'i', 'n', 'P', 'r', 'o', '1'};
/// Larger than any program; a broken size must not take memory.
constexpr std::uint64_t kMaxBinaryBytes = 16u << 20;

using Digest = std::array<std::uint64_t, 2>;

/// The start of a file. Numbers are those of the machine: no other one can use the program anyway.
struct Head {
  std::array<char, 8> magic{};
  Digest key{};
  std::uint64_t size_bytes = 0;
  std::uint32_t format = 0;
  std::uint32_t crc32c = 0;  ///< of the program
};
static_assert(sizeof(Head) == 40);

/// FNV-1a with two starts (Fowler, Noll, Vo; draft-eastlake-fnv): tells keys apart, and keeps no secret.
Digest digestOf(std::string_view key) {
  Digest out{0xcbf29ce484222325, 0x84222325cbf29ce4};
  for (const char c : key) {
    for (std::uint64_t& part : out) part = (part ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return out;
}

std::uint32_t checksumOf(const std::vector<std::byte>& bytes) {
  return core::crc32c({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// Returns why a file that could be opened cannot be used, or an empty text and the program in `out`.
std::string read(std::ifstream& file, const Digest& key, ProgramStore::Binary& out) {
  Head head;
  if (!file.read(reinterpret_cast<char*>(&head), sizeof head)) return "it is truncated";
  if (head.magic != kMagic) return "it is not such a file, or one of another version";
  if (head.key != key) return "it belongs to another program or driver";
  if (head.size_bytes > kMaxBinaryBytes) return fmt::format("its size of {} bytes is not possible", head.size_bytes);
  out.format = head.format;
  out.bytes.resize(head.size_bytes);
  if (!file.read(reinterpret_cast<char*>(out.bytes.data()), static_cast<std::streamsize>(head.size_bytes)))
    return "it is truncated";
  return checksumOf(out.bytes) == head.crc32c ? "" : "its checksum is wrong";
}

}  // namespace

ProgramStore::ProgramStore(fs::path folder, std::uintmax_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {}

fs::path ProgramStore::userFolder(std::string_view name) {
  // A relative path counts as not set (XDG Base Directory Specification).
  for (const auto& [variable, below] : {std::pair{"XDG_CACHE_HOME", ""}, std::pair{"HOME", ".cache"}}) {
    const char* const value = std::getenv(variable);
    if (value && fs::path(value).is_absolute()) return fs::path(value) / below / "spindrift" / name;
  }
  static std::atomic<bool> is_said = false;
  if (!is_said.exchange(true))
    spdlog::info("compiled programs are not kept: neither XDG_CACHE_HOME nor HOME is an absolute path");
  return {};
}

fs::path ProgramStore::fileOf(std::string_view key) const {
  const Digest digest = digestOf(key);
  return folder_ / fmt::format("{:016x}{:016x}.program", digest[0], digest[1]);
}

std::optional<ProgramStore::Binary> ProgramStore::load(std::string_view key) const {
  if (!isOn()) return std::nullopt;
  const fs::path path = fileOf(key);
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  Binary out;
  const std::string fault = read(file, digestOf(key), out);
  if (fault.empty()) return out;
  spdlog::warn("compiled program {} is not used: {}; the program is compiled and the file replaced", path.string(),
               fault);
  return std::nullopt;
}

void ProgramStore::save(std::string_view key, const Binary& binary) {
  if (!isOn() || !is_writable_ || binary.bytes.empty() || binary.bytes.size() > kMaxBinaryBytes) return;
  static std::atomic<std::uint64_t> number = 0;
  std::error_code error;
  fs::create_directories(folder_, error);
  const Head head{.magic = kMagic,
                  .key = digestOf(key),
                  .size_bytes = binary.bytes.size(),
                  .format = binary.format,
                  .crc32c = checksumOf(binary.bytes)};
  const fs::path fresh = folder_ / fmt::format("{}-{}.new", ::getpid(), ++number);
  std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&head), sizeof head);
  file.write(reinterpret_cast<const char*>(binary.bytes.data()), static_cast<std::streamsize>(binary.bytes.size()));
  file.close();
  if (!file) error = std::make_error_code(std::errc::io_error);
  if (!error) fs::rename(fresh, fileOf(key), error);
  if (!error) return removeOldest();
  std::error_code ignored;
  fs::remove(fresh, ignored);
  if (is_writable_.exchange(false))
    spdlog::warn("compiled programs are not kept: {} cannot be written ({})", folder_.string(), error.message());
}

void ProgramStore::removeOldest() const {
  struct Kept {
    fs::file_time_type written;
    std::uintmax_t bytes;
    fs::path path;
  };
  std::vector<Kept> files;
  std::uintmax_t bytes = 0;
  // Another process may remove files at the same time.
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const std::uintmax_t size_bytes = entry->file_size(gone);
    if (gone) continue;
    const auto written = entry->last_write_time(gone);
    if (gone) continue;
    files.push_back({written, size_bytes, entry->path()});
    bytes += size_bytes;
  }
  std::ranges::sort(files, {}, &Kept::written);
  for (const Kept& oldest : files) {
    if (bytes <= max_bytes_) return;
    fs::remove(oldest.path, error);
    bytes -= oldest.bytes;
  }
}

}  // namespace spindrift::gpu
