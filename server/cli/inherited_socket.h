// A listening socket that another program opened before it started this one (socket activation).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::cli {

struct InheritedSocket {
  int descriptor = -1;
  std::string address;  ///< IP address that it is bound to
  std::uint16_t port = 0;
};

/// Takes the TCP socket that systemd passes on by the protocol of sd_listen_fds(3): LISTEN_PID is this process,
/// LISTEN_FDS is 1, and the socket is descriptor 3. nullopt if LISTEN_PID is unset or another process. Removes the
/// variables, so that no child takes them for its own; call it before other threads start. Error kInvalidInput: the
/// number of sockets is not 1, or the descriptor is not a TCP socket that listens.
core::Result<std::optional<InheritedSocket>> takeInheritedSocket();

}  // namespace spindrift::cli
