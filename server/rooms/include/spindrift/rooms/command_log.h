// The log of a room (record.proto): written while it runs, read by `replay`.
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

namespace spindrift::rooms {

/// A log that has grown to this size ends there.
inline constexpr std::uint64_t kLogMaxBytes = 1ull << 30;

/// Notes the device and its driver, on which the states of a run depend.
void describeDevice(v1::RecordHeader& header, const gpu::DeviceInfo& device);
/// Why states may differ although everything else is the same: one line that names the recorded device or driver and
/// the one here. Nothing when they are the same.
std::optional<std::string> deviceDifference(const v1::RecordHeader& header, const gpu::DeviceInfo& device);

/// Appends records; each is with the system when the call returns. What cannot be written ends the log with a line in
/// the program's own log, not the room.
class CommandLogWriter {
 public:
  /// A new file ROOM-UTC.spinrec in the folder, which is made if need be. Error: kUnavailable.
  static core::Result<std::unique_ptr<CommandLogWriter>> create(const std::filesystem::path& folder,
                                                                const v1::RecordHeader& header);

  void write(const v1::Record& record);
  /// Nothing more is written.
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::uint32_t hashInterval_ticks() const { return hash_interval_ticks_; }

 private:
  explicit CommandLogWriter(std::filesystem::path file) : file_(std::move(file)) {}

  std::filesystem::path file_;
  std::ofstream out_;
  std::uint64_t size_bytes_ = 0;
  std::uint32_t hash_interval_ticks_ = 0;
  bool ended_ = false;
};

class CommandLogReader {
 public:
  /// kUnavailable for a file that cannot be read, kInvalidInput for one that is no log or has no whole header.
  static core::Result<std::unique_ptr<CommandLogReader>> open(const std::filesystem::path& file);

  [[nodiscard]] const v1::RecordHeader& header() const { return header_; }
  /// The next whole record; nullopt at the end, whole or not: truncation() tells.
  std::optional<v1::Record> next();
  /// Why reading ended before the end of the file, where it did: "... at byte 1234".
  [[nodiscard]] const std::optional<std::string>& truncation() const { return truncation_; }

 private:
  CommandLogReader() = default;

  std::ifstream in_;
  std::uint64_t offset_bytes_ = 0;
  v1::RecordHeader header_;
  std::optional<std::string> truncation_;
};

}  // namespace spindrift::rooms
