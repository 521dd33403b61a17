// The lines of the audit log: JSON objects, one event each.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace spindrift::access {

/// One event. Fields that are empty or 0 are left out of the line.
struct AuditEvent {
  std::string_view event;  ///< "command", "room_opened", "room_closed", "snapshot_asked", "refused"
  std::string room{};
  std::string_view kind{};     ///< "set_parameter"; of "command"
  std::string content{};       ///< JSON object: the fields of the command or of the request
  std::string_view outcome{};  ///< "applied", "rejected"
  std::string reason{};        ///< "out_of_range": RejectReason in small letters
  std::string message{};       ///< one line: why
  std::uint64_t tick = 0;      ///< at which it was applied
  bool has_tick = false;
  std::string_view role{};
  std::string subject{};  ///< Grant::subject
  std::string name{};     ///< what the person is called in the room
  std::uint32_t person_id = 0;
  std::uint64_t session_id = 0;
  std::string peer{};                ///< address and port
  std::uint64_t left_out_count = 0;  ///< events of this kind that the rate limit left out before this one
};

/// Returns the line, with its line break. Text is escaped, so that no value can end the line or forge a field; bytes
/// that are not UTF-8 are removed; long values are cut.
std::string auditLine(const AuditEvent& event, std::chrono::system_clock::time_point now);

}  // namespace spindrift::access
