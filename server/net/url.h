// Request targets, as bytes from strangers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace spindrift::net {

struct Target {
  std::string path;   ///< percent-decoded, starts with '/', no control characters, no backslash
  std::string query;  ///< as sent, without '?'
};

/// nullopt if the target does not start with '/', an escape is broken, or the decoded path holds a control character
/// (NUL among them) or a backslash.
std::optional<Target> parseTarget(std::string_view target);

/// The room of a WebSocket path: "" for /ws and /ws/, NAME for /ws/NAME; nullopt for any other path.
std::optional<std::string> roomOfPath(std::string_view path);

}  // namespace spindrift::net
