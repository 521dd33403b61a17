// The one rule for names of rooms, for every way in: requests, flags, files, folders, NATS, tokens.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace spindrift::core {

/// The default room of a cluster, and of a server that is started by itself.
inline constexpr const char* kDefaultRoom = "main";
inline constexpr std::size_t kRoomNameMaxBytes = 32;
/// The rule in words, for messages.
inline constexpr std::string_view kRoomNameRule = "1 to 32 letters, digits, '_' or '-'";

/// Returns whether the name has 1 to kRoomNameMaxBytes ASCII letters, digits, '_' or '-'.
constexpr bool isRoomName(std::string_view name) {
  return !name.empty() && name.size() <= kRoomNameMaxBytes && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace spindrift::core
