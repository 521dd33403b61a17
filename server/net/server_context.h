// What every connection of one server shares. It outlives them all.
#pragma once

#include <atomic>
#include <cstdint>

#include <spindrift/net/server.h>

#include "connection_set.h"
#include "room_hub.h"
#include "static_files.h"

namespace spindrift::net {

struct Counters {
  std::atomic<std::uint64_t> open_session_count{0};
  std::atomic<std::uint64_t> accepted_session_count{0};
  std::atomic<std::uint64_t> sent_bytes_count{0};
  std::atomic<std::uint64_t> sent_frame_count{0};
  std::atomic<std::uint64_t> dropped_frame_count{0};
  std::atomic<std::uint64_t> evicted_session_count{0};
};

/// TCP connections beyond the sessions: pages being loaded, probes, strangers. More are closed unheard.
inline constexpr std::size_t kSpareConnectionCount = 512;

/// The subprotocol of proto/spindrift/v1.
inline constexpr const char* kSubprotocol = "spindrift.v1";

struct ServerContext {
  ServerContext(const ServerOptions& chosen, Application& served)
      : options(chosen),
        application(served),
        files(chosen.web_root),
        connections(chosen.max_session_count + kSpareConnectionCount) {}

  const ServerOptions options;
  Application& application;
  RoomHub hub;
  StaticFiles files;
  ConnectionSet connections;
  Counters counters;
  std::atomic<std::uint64_t> last_session_id{0};
  /// Sessions open or in their handshake, against max_session_count.
  std::atomic<std::size_t> reserved_session_count{0};
};

}  // namespace spindrift::net
