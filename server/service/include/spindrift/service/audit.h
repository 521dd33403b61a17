// The audit log: what operators do, and who is refused. Without a file it does nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <spindrift/access/audit_log.h>
#include <spindrift/core/token_bucket.h>
#include <spindrift/rooms/command.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::service {

/// Any thread. Never waits for the disk.
class Audit {
 public:
  explicit Audit(std::shared_ptr<access::AuditFile> file);

  /// Notes the outcome of a command. Written are the commands that take the role of operator, and the boats that an
  /// operator takes or removes; of those who may not send them, and of those that are BUSY, only as many as the rate
  /// allows.
  void applied(const rooms::Command& command, std::uint64_t tick);
  void rejected(const rooms::Command& command, const wire::CommandRejection& rejection);

  /// Notes a request that changes the server: "room_opened", "room_closed", "snapshot_asked". `content` is a JSON
  /// object or empty, `error` why it failed or empty.
  void request(std::string_view event, const core::SenderDetails& who, core::Role role, std::string content,
               const std::string& error);
  /// Notes that a token was refused; as many lines as the rate allows.
  void refused(const core::SenderDetails& who, const std::string& why);

  /// Returns null without an audit log.
  [[nodiscard]] access::AuditFile* file() const { return file_.get(); }
  /// Lines that the rate left out since the start.
  [[nodiscard]] std::uint64_t leftOutCount() const { return left_out_count_; }

 private:
  void command(const rooms::Command& command, access::AuditEvent event);
  void write(const access::AuditEvent& event);
  /// Writes the event, or counts it for the next line if the rate is used up.
  void writeRarely(access::AuditEvent event);

  const std::shared_ptr<access::AuditFile> file_;
  std::atomic<std::uint64_t> left_out_count_{0};
  std::mutex mutex_;
  core::TokenBucket rare_;
  std::uint64_t left_out_since_ = 0;  ///< since the last line of writeRarely()
};

}  // namespace spindrift::service
