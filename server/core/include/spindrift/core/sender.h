// The sender of a command and its permissions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace spindrift::core {

/// Permissions of a sender; each role includes the ones before.
enum class Role { kViewer, kPlayer, kOperator };

inline constexpr std::array<std::string_view, 3> kRoleNames{"viewer", "player", "operator"};  ///< indexed by Role

constexpr std::string_view roleName(Role role) {
  return kRoleNames[static_cast<std::size_t>(role)];
}
/// Returns nullopt for a name that is not a role.
constexpr std::optional<Role> parseRole(std::string_view name) {
  for (std::size_t k = 0; k < kRoleNames.size(); ++k) {
    if (kRoleNames[k] == name) return static_cast<Role>(k);
  }
  return std::nullopt;
}

/// Identifies one connection for the life of the process; never 0, never reused.
using SessionId = std::uint64_t;

/// Sender of a command in words, for the audit log.
struct SenderDetails {
  std::string room{};
  std::string subject{};  ///< the token's; empty: a guest
  std::string name{};     ///< what the client calls itself; empty for requests
  std::string peer{};     ///< address and port
};

/// The sender of a command: a session or an HTTP request. Exactly one id is not 0, unless the room itself is the
/// sender.
struct Sender {
  SessionId session_id = 0;
  std::uint64_t request_id = 0;
  std::uint32_t person_id = 0;  ///< the session's person in its room; 0: none
  Role role = Role::kOperator;
  std::shared_ptr<const SenderDetails> details{};  ///< null: the room itself
};

}  // namespace spindrift::core
