// Request targets, as bytes from strangers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::net {

struct Target {
  std::string path;   ///< percent-decoded, starts with '/', no control characters, no backslash
  std::string query;  ///< as sent, without '?'
};

/// nullopt if the target does not start with '/', an escape is broken, or the decoded path holds a control character
/// (NUL among them) or a backslash.
std::optional<Target> parseTarget(std::string_view target);

/// The values of the parameter `name` in a query ("room=pool&x=1"), percent-decoded, '+' as a space, in their order;
/// nullopt if an escape in one of them is broken or gives a control character. Other parameters are not looked at.
std::optional<std::vector<std::string>> queryValues(std::string_view query, std::string_view name);

/// The text with everything but printable ASCII percent-encoded, cut to 200 bytes: a stranger's path in a line of ours.
std::string printable(std::string_view text);

/// The room of a WebSocket path: "" for /ws and /ws/, NAME for /ws/NAME; nullopt for any other path.
std::optional<std::string> roomOfPath(std::string_view path);

}  // namespace spindrift::net
