// The log of `serve --record` (record.proto): written while a room runs, read by `replay`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/v1/record.pb.h>

namespace spindrift::history {

/// A log ends when it has reached this size.
inline constexpr std::uint64_t kLogMaxBytes = 1ull << 30;

/// Writes the device and its driver into the header, because the states of a run depend on them.
void describeDevice(v1::RecordHeader& header, const gpu::DeviceInfo& device);
/// Returns one line with the recorded device or driver and the present one if they differ: then states may differ with
/// everything else equal. Returns nullopt when they are the same.
std::optional<std::string> deviceDifference(const v1::RecordHeader& header, const gpu::DeviceInfo& device);

/// Appends records; each has been passed to the operating system when the call returns. A write error ends the log, not
/// the room, with a line in the program's own log.
class CommandLogWriter {
 public:
  /// Creates the file ROOM-UTC.spinrec in the folder, which is made if necessary. Error: kUnavailable.
  static core::Result<std::unique_ptr<CommandLogWriter>> create(const std::filesystem::path& folder,
                                                                const v1::RecordHeader& header);

  void write(v1::Record record);
  /// Returns true when nothing more is written.
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::uint32_t hashInterval_ticks() const { return hash_interval_ticks_; }

 private:
  explicit CommandLogWriter(std::filesystem::path file) : file_(std::move(file)) {}

  std::filesystem::path file_;
  std::ofstream out_;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t record_count_ = 0;
  std::uint32_t hash_interval_ticks_ = 0;
  bool ended_ = false;
};

/// Also reads files of the format before ("spinrec1").
class CommandLogReader {
 public:
  /// Errors: kUnavailable for a file that cannot be read, kInvalidInput for one that is not a log or has no complete
  /// header.
  static core::Result<std::unique_ptr<CommandLogReader>> open(const std::filesystem::path& file);

  [[nodiscard]] const v1::RecordHeader& header() const { return header_; }
  /// Returns the next complete record; nullopt at the end or where the log is damaged, see truncation().
  std::optional<v1::Record> next();
  /// The reason why reading stopped before the end of the file, if it did: "... at byte 1234".
  [[nodiscard]] const std::optional<std::string>& truncation() const { return truncation_; }

 private:
  CommandLogReader() = default;

  std::ifstream in_;
  bool is_v1_ = false;
  std::uint64_t offset_bytes_ = 0;
  std::uint64_t record_count_ = 0;
  v1::RecordHeader header_;
  std::optional<std::string> truncation_;
};

}  // namespace spindrift::history
