// The network room: one port for HTTP and WebSocket. It moves bytes and never parses a message; what they mean is the
// Application's business (implemented in app). Threads: Server runs `thread_count` I/O threads; every Application call
// comes from one of them, for one session never two at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::net {

/// Identifies one WebSocket session for the life of the process; never 0, never reused.
using SessionId = std::uint64_t;

/// Data-plane layers; the number indexes the newest-frame slots of an outbox.
using LayerIndex = std::uint32_t;
inline constexpr LayerIndex kMaxLayerCount = 16;

/// One frame of a layer in the forms that its watchers need; either may be null, not both.
struct LayerBytes {
  core::SharedBytes whole;       ///< stands by itself
  core::SharedBytes continuing;  ///< needs the frame that was published before it
};

/// WebSocket close codes that this server sends (RFC 6455 section 7.4).
enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,        ///< the server shuts down
  kUnsupportedData = 1003,  ///< a text message
  kPolicy = 1008,           ///< protocol misuse, flood
  kTooBig = 1009,           ///< message over read_message_max_bytes
  kInternalError = 1011,    ///< an Application callback threw for this session
  kTryAgainLater = 1013,    ///< the control queue overflowed
};

/// What a plain HTTP request to a path under /api/ or a probe gets.
struct HttpReply {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
};

struct HttpRequest {
  std::string method;   ///< "GET", "POST", ...; a HEAD request arrives as "GET" and its body is left out
  std::string path;     ///< percent-decoded, without the query
  std::string query;    ///< as sent, without the question mark
  core::ByteView body;  ///< at most ServerOptions::request_body_max_bytes
};

/// Why a session ended, for the log: code (0 if the peer vanished) and one line.
struct SessionEnd {
  std::uint16_t code = 0;
  std::string reason;
};

/// Sends to sessions; thread-safe, never blocks, callable from any thread. Unknown session ids are ignored (the session
/// just ended). One instance per Server.
class Hub {
 public:
  virtual ~Hub() = default;

  /// Control plane: ordered, never dropped; the bounded queue (ServerOptions::control_queue_count) overflowing closes
  /// the session with kTryAgainLater.
  virtual void sendControl(SessionId session, core::SharedBytes message) = 0;

  /// The same to every session of the room.
  virtual void broadcastControl(const std::string& room, core::SharedBytes message) = 0;

  /// Data plane: one write in flight and one newest slot per layer; an unsent older frame in the slot is dropped and
  /// counted. `room` is the group the sessions joined; only sessions that watch `layer` get it, no faster than the rate
  /// they asked for (with 10 % tolerance; a frame that comes too early for a session is skipped and not counted). A
  /// session that has the frame before gets the continuing form where there is one, any other the whole one; where that
  /// is missing it gets nothing, and wantsWhole() says so.
  virtual void publish(const std::string& room, LayerIndex layer, const LayerBytes& frame) = 0;

  /// Whether a session that could take the next frame needs it whole: it just came, lost one, or takes only some.
  virtual bool wantsWhole(const std::string& room, LayerIndex layer) const = 0;

  /// Puts the session into a room (it leaves the one before; its watches follow, unsent frames do not).
  virtual void join(SessionId session, const std::string& room) = 0;

  /// Starts (or, with max_rate_hz 0, stops) a layer for a session.
  virtual void watch(SessionId session, LayerIndex layer, double max_rate_hz) = 0;

  /// How many sessions of the room watch the layer: nobody watches, nobody encodes.
  virtual std::size_t watcherCount(const std::string& room, LayerIndex layer) const = 0;

  /// Sends everything queued on the control plane, then closes; the socket is cut after close_timeout in any case.
  virtual void close(SessionId session, CloseCode code, std::string reason) = 0;
};

/// What the server does for: implemented by app, outlives the Server. An exception from a callback is logged and ends
/// that session (kInternalError) or request (HTTP 500), nothing else.
class Application {
 public:
  virtual ~Application() = default;

  /// Once, from Server::start(), before any other call: the hub to send through, valid as long as the Server.
  virtual void serverStarts(Hub& /*hub*/) {}
  /// A WebSocket handshake on `/ws/{room}` (or `/ws` = the default room, empty name). An Error refuses the upgrade with
  /// HTTP 404 and the error's line as the body.
  virtual core::Result<void> acceptSession(const std::string& room) = 0;
  /// The session is open; the application greets it.
  virtual void sessionOpened(SessionId session, const std::string& room, const std::string& peer) = 0;
  /// One whole binary message.
  virtual void sessionMessage(SessionId session, core::ByteView message) = 0;
  /// The session is gone; last call for this id.
  virtual void sessionClosed(SessionId session, const SessionEnd& end) = 0;
  /// A request under /api/, or /healthz, /readyz, /metrics; nullopt = 404.
  virtual std::optional<HttpReply> httpRequest(const HttpRequest& request) = 0;
};

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0 = any free port; read the real one from Server::port()
  std::string web_root{};     ///< folder with the built web client; empty = no page is served
  std::size_t thread_count = 1;
  std::size_t max_session_count = 256;
  std::size_t read_message_max_bytes = 16 * 1024;  ///< client messages are small
  std::size_t request_body_max_bytes = 64 * 1024;
  std::size_t control_queue_count = 256;
  double messages_per_s = 200.0;  ///< token bucket per session; sustained excess closes with kPolicy
  double message_burst_count = 400.0;
  std::chrono::milliseconds write_stall_timeout{10'000};  ///< a write that takes longer evicts the session
  std::chrono::milliseconds handshake_timeout{10'000};
  std::chrono::milliseconds idle_timeout{60'000};  ///< pings half-way; silence beyond closes
  std::chrono::milliseconds close_timeout{2'000};  ///< patience for the peer's close frame
};

/// Counters since the start (open_session_count: now).
struct ServerStats {
  std::uint64_t open_session_count = 0;
  std::uint64_t accepted_session_count = 0;
  std::uint64_t sent_bytes_count = 0;       ///< message bytes of both planes, without WebSocket headers
  std::uint64_t sent_frame_count = 0;       ///< data plane only
  std::uint64_t dropped_frame_count = 0;    ///< replaced in their slot before they were sent
  std::uint64_t evicted_session_count = 0;  ///< sessions that did not read: write stall or control overflow
};

/// Listens, serves, stops. Construct through start(); the destructor stops.
class Server {
 public:
  /// Binds and starts the I/O threads. Errors: kUnavailable with address, port and what to do (port in use, bad
  /// address).
  static core::Result<std::unique_ptr<Server>> start(const ServerOptions& options, Application& application);
  virtual ~Server() = default;

  virtual std::uint16_t port() const = 0;
  virtual Hub& hub() = 0;
  virtual ServerStats stats() const = 0;
  /// Stops accepting, closes every session with 1001, waits at most close_timeout + 1 s, cuts what is left, joins the
  /// threads. Every open session has had its sessionClosed when it returns. Idempotent; not from an I/O thread.
  virtual void stop() = 0;
};

}  // namespace spindrift::net
