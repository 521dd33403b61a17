// Compiled programs on disk, so that the next start does not compile them again. Private to this module; knows no
// OpenGL.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace spindrift::gpu {

/// A folder with one file per program. Any thread; several processes may use one folder at a time: files appear whole
/// under their names, and one that is not whole, or belongs to another program, is not used. Failures are logged; the
/// caller then compiles.
class ProgramStore {
 public:
  static constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20;  ///< all scenes of a driver take about 10 MB

  /// A compiled program as its driver gives it and takes it back.
  struct Binary {
    std::uint32_t format = 0;  ///< the driver's number for what the bytes are
    std::vector<std::byte> bytes;
  };

  /// `folder`: made when the first program is saved; empty: nothing is kept. `max_bytes`: of all files; when they are
  /// more, the oldest are removed.
  explicit ProgramStore(std::filesystem::path folder, std::uintmax_t max_bytes = kMaxBytes);

  /// Returns the folder spindrift/NAME in $XDG_CACHE_HOME, or in ~/.cache; empty where neither is known, which the log
  /// says once.
  static std::filesystem::path userFolder(std::string_view name);

  /// Returns what was saved under this key: all that the program depends on (driver, text, defines). Nothing if there
  /// is no such file, or it is broken or foreign, which is logged.
  [[nodiscard]] std::optional<Binary> load(std::string_view key) const;

  /// Saves a program, in place of an earlier one of this key, and removes the oldest files over the bound.
  void save(std::string_view key, const Binary& binary);

  [[nodiscard]] bool isOn() const { return !folder_.empty(); }
  [[nodiscard]] std::filesystem::path fileOf(std::string_view key) const;

 private:
  void removeOldest() const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
  std::atomic<bool> is_writable_ = true;
};

}  // namespace spindrift::gpu
