// The audit log: JSON objects, one event per line, in a file that a thread of its own appends to: a slow disk delays
// nobody.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include <spindrift/core/result.h>
#include <spindrift/core/sender.h>

namespace spindrift::access {

/// One event. Fields that are empty or 0 are left out of the line.
struct AuditEvent {
  std::string_view event;      ///< "command", "room_opened", "room_closed", "snapshot_asked", "refused"
  std::string_view kind{};     ///< "set_parameter"; of "command"
  std::string content{};       ///< JSON object: the fields of the command or of the request
  std::string_view outcome{};  ///< "applied", "rejected"
  std::string reason{};        ///< "out_of_range": RejectReason in small letters
  std::string message{};       ///< one line: why
  std::uint64_t tick = 0;      ///< at which it was applied
  bool has_tick = false;
  core::SenderDetails who{};
  std::string_view role{};
  std::uint32_t person_id = 0;
  std::uint64_t session_id = 0;
  std::uint64_t left_out_count = 0;  ///< events of this kind that the rate limit left out before this one
};

/// Returns the line, with its line break. Text is escaped, so that no value can end the line or forge a field; bytes
/// that are not UTF-8 are removed; long values are cut.
std::string auditLine(const AuditEvent& event, std::chrono::system_clock::time_point now);

/// Any thread. What cannot be written is counted and never repeated; the server continues without it.
class AuditFile {
 public:
  /// Lines that wait for the disk; further ones are lost.
  static constexpr std::size_t kWaitingMaxCount = 4096;

  /// Opens the file for appending, or creates it with mode 0600. Error kUnavailable names it and the reason.
  static core::Result<std::unique_ptr<AuditFile>> open(std::filesystem::path file);
  /// Does what finish() does.
  ~AuditFile();
  AuditFile(const AuditFile&) = delete;
  AuditFile& operator=(const AuditFile&) = delete;

  /// Adds a line, which ends with its line break. Never blocks for the disk.
  void add(std::string line);
  /// Closes the file after the lines that were added before, and opens (or creates) the one of this name: for programs
  /// that rename logs. If that fails, the old one stays in use and the log of the program says so.
  void reopen();

  /// Writes what still waits, and nothing afterwards. Idempotent; one thread.
  void finish();

  [[nodiscard]] std::uint64_t writtenCount() const;
  [[nodiscard]] std::uint64_t lostCount() const;

 private:
  AuditFile(std::filesystem::path file, int descriptor);
  void run();
  /// Writes a line as a whole or not at all.
  bool write(const std::string& line);
  void noteFailure(int error_number);

  const std::filesystem::path file_;
  int descriptor_;  ///< used by the thread only
  std::chrono::steady_clock::time_point complained_{};
  bool has_complained_ = false;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::string> lines_;  ///< an empty one asks for reopening
  std::uint64_t written_count_ = 0;
  std::uint64_t lost_count_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::access
