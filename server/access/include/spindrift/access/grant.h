// What a token allows.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/sender.h>

namespace spindrift::access {

/// Minimum length of a token; shorter ones could be guessed.
inline constexpr std::size_t kTokenMinBytes = 16;
/// Maximum length of a token of any kind.
inline constexpr std::size_t kTokenMaxBytes = 8 * 1024;
/// Number of rooms that one token can name.
inline constexpr std::size_t kTokenRoomMaxCount = 64;
inline constexpr std::size_t kSubjectMaxBytes = 128;
inline constexpr std::size_t kNameMaxBytes = 256;  ///< of a JWT; the room cuts names to its own length

struct Grant {
  core::Role role = core::Role::kViewer;
  std::optional<std::chrono::system_clock::time_point> expires{};  ///< never if not set
  /// The person in the audit log: `sub` of a JWT or of a line of the token file, else the location of the token, as
  /// "tokens:3". Empty: a guest. Arbitrary UTF-8 of at most kSubjectMaxBytes.
  std::string subject{};
  /// The subject is one person: all sessions and requests of it share one limit. False for guests and for tokens that
  /// name nobody, which several people may use.
  bool is_person = false;
  std::optional<std::vector<std::string>> rooms{};  ///< names; not set: all rooms
  std::string name{};                               ///< what the person is called; empty: what the client says

  [[nodiscard]] bool allows(std::string_view room) const {
    return !rooms || std::ranges::find(*rooms, room) != rooms->end();
  }
};

}  // namespace spindrift::access
