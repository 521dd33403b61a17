// Parses request targets, which are untrusted bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::net {

struct RequestTarget {
  std::string path;   ///< percent-decoded, starts with '/', no control characters, no backslash
  std::string query;  ///< undecoded, without '?'
};

/// Returns nullopt if the target does not start with '/', an escape is broken, or the decoded path contains a control
/// character (NUL included) or a backslash.
std::optional<RequestTarget> parseTarget(std::string_view target);

/// Returns the values of the parameter `name` in a query ("room=pool&x=1"), in order: percent-decoded, '+' as a space.
/// Returns nullopt if an escape in one of them is broken or gives a control character. Other parameters are not
/// checked.
std::optional<std::vector<std::string>> queryValues(std::string_view query, std::string_view name);

/// Returns the text with all but printable ASCII percent-encoded, cut to 200 bytes: an untrusted path for use in a log
/// line.
std::string printable(std::string_view text);

/// Returns the room of a WebSocket path for Foxglove: "" for /foxglove, NAME for /foxglove/NAME; nullopt for any other
/// path.
std::optional<std::string> foxgloveRoomOfPath(std::string_view path);

/// Returns the room of a WebSocket path: "" for /ws and /ws/, NAME for /ws/NAME; nullopt for any other path.
std::optional<std::string> roomOfPath(std::string_view path);

}  // namespace spindrift::net
