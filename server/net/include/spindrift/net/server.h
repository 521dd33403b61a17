// The network module: one port for HTTP and WebSocket. It moves bytes and never parses a message; what they mean is the
// Application's business (service implements it). Threads: Server runs `thread_count` I/O threads; every Application
// call comes from one of them, for one session never two at a time.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/command.h>
#include <spindrift/core/level.h>
#include <spindrift/core/level_demand.h>
#include <spindrift/core/result.h>

namespace spindrift::net {

using core::SessionId;

/// Data-plane layers; the number indexes the newest-frame slots of an outbox.
using LayerIndex = std::uint32_t;
inline constexpr LayerIndex kMaxLayerCount = 16;

/// One frame of a layer in the forms that its watchers need; either may be null, not both.
struct LayerBytes {
  core::SharedBytes keyframe;  ///< stands by itself
  core::SharedBytes delta;     ///< needs the frame of this level that was published before it
  core::Level level = core::Level::kFull;
  std::uint32_t reduced_count = 0;  ///< levels of the layer from this one on are all kFull
};

/// What a state message is about: of messages with the same name only the newest is worth sending.
struct StateTopic {
  enum class Scope : std::uint8_t {
    kAlone,  ///< replaces its own name only
    kPart,   ///< likewise; and kWhole says it as well
    kWhole,  ///< replaces every waiting kPart besides its own name
  };
  std::string name;  ///< "people", "parameter:wave.depth_m"; the number of names bounds what waits for a session
  Scope scope = Scope::kAlone;
};

/// What a session watches of a layer.
struct Watch {
  double max_rate_hz = 0.0;  ///< 0 stops the layer
  core::Level level = core::Level::kFull;
  bool adapts = false;  ///< it may be given a lower level while its link cannot carry this one
};

/// WebSocket close codes that this server sends (RFC 6455 section 7.4).
enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,        ///< the server shuts down
  kUnsupportedData = 1003,  ///< a text message
  kPolicy = 1008,           ///< protocol misuse, flood
  kTooBig = 1009,           ///< message over read_message_max_bytes
  kInternalError = 1011,    ///< an Application callback threw for this session
  kTryAgainLater = 1013,    ///< too many answers waited for a client that does not read
  kUnauthorized = 4401,     ///< a token that is unknown or has expired, or none where one is needed
  kRoomClosed = 4404,       ///< the room is no more
  kResumedElsewhere = 4409  ///< another connection goes on as this person
};

/// What a plain HTTP request to a path under /api/ or a probe gets.
struct HttpReply {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers{};  ///< beyond Content-Type: "Allow", ...
};

struct HttpRequest {
  std::string method;           ///< "GET", "POST", ...; a HEAD request arrives as "GET" and its body is left out
  std::string path;             ///< percent-decoded, without the query
  std::string query;            ///< as sent, without the question mark
  core::ByteView body;          ///< at most ServerOptions::request_body_max_bytes; valid during the call
  std::string authorization{};  ///< the header of that name, as sent
  std::string content_type{};   ///< likewise
};

/// Answers one request; nullopt = 404. Callable once, from any thread; dropping every copy uncalled answers 500. An
/// answer that comes after ServerOptions::answer_timeout is too late: 504 went out.
using HttpResponder = std::function<void(std::optional<HttpReply>)>;

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

  /// Control plane, answers to what this session asked: ordered, never dropped. The session is not read from while
  /// ServerOptions::answer_pause_count of them wait; beyond answer_max_count it is closed with kTryAgainLater.
  virtual void sendAnswer(SessionId session, core::SharedBytes message) = 0;

  /// Control plane, state: only the newest message of a topic waits, in the place of the older one. Never closes a
  /// session.
  virtual void sendState(SessionId session, const StateTopic& topic, core::SharedBytes message) = 0;

  /// The same to every session of the room.
  virtual void broadcastState(const std::string& room, const StateTopic& topic, core::SharedBytes message) = 0;

  /// Data plane: one write in flight and one newest slot per layer; an unsent older frame in the slot is dropped and
  /// counted. `room` is the group the sessions joined; only sessions that watch `layer` get it, no faster than the rate
  /// they asked for (with 10 % tolerance; a frame that comes too early for a session is skipped and not counted). A
  /// session that has the frame before gets the delta where there is one, any other the keyframe; where that
  /// is missing it gets nothing, and demand() says so. Levels are published one by one; a session gets its own.
  virtual void publish(const std::string& room, LayerIndex layer, const LayerBytes& frame) = 0;

  /// Which levels of the layer somebody watches now, in which form: what nobody watches, nobody makes. Of
  /// `reduced_count` levels that leave something out; who asked for one beyond them is counted at kFull.
  virtual core::LayerDemand demand(const std::string& room, LayerIndex layer, std::uint32_t reduced_count) const = 0;

  /// Puts the session into a room (it leaves the one before; its watches follow, unsent frames do not).
  virtual void join(SessionId session, const std::string& room) = 0;

  /// How many sessions are in the room.
  virtual std::size_t sessionCount(const std::string& room) const = 0;
  /// How many sessions are in any room.
  virtual std::size_t sessionCount() const = 0;

  /// Starts, changes or stops a layer for a session.
  virtual void watch(SessionId session, LayerIndex layer, const Watch& watch) = 0;

  /// Sends everything queued on the control plane, then closes; the socket is cut after close_timeout in any case.
  virtual void close(SessionId session, CloseCode code, std::string reason) = 0;

  /// The same at a later time; the latest call counts. time_point::max() is never.
  virtual void closeAt(SessionId session, std::chrono::steady_clock::time_point when, CloseCode code,
                       std::string reason) = 0;
};

/// What the server does for: implemented by service, outlives the Server. An exception from a callback is logged and
/// ends that session (kInternalError) or request (HTTP 500), nothing else.
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
  /// The session's adapting watches get at most this level from now on: its link could not carry more, or may again.
  virtual void sessionLevelChanged(SessionId /*session*/, core::Level /*level*/) {}
  /// One whole binary message.
  virtual void sessionMessage(SessionId session, core::ByteView message) = 0;
  /// The session is gone; last call for this id.
  virtual void sessionClosed(SessionId session, const SessionEnd& end) = 0;
  /// A request under /api/, or /healthz, /readyz, /metrics. Answers at once or later through `respond`.
  virtual void httpRequest(const HttpRequest& request, HttpResponder respond) = 0;
};

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0 = any free port; read the real one from Server::port()
  std::string web_root{};     ///< folder with the built web client; empty = no page is served
  std::size_t thread_count = 1;
  std::size_t max_session_count = 256;
  /// Share of max_session_count that one address may hold (IPv6: one /64), at least one session. 1 behind a proxy,
  /// whose clients all come from its address.
  double address_session_share = 0.5;
  std::size_t read_message_max_bytes = 16 * 1024;  ///< client messages are small
  std::size_t request_body_max_bytes = 64 * 1024;
  std::size_t answer_pause_count = 128;  ///< answers waiting for a session from which on it is not read from
  std::size_t answer_max_count = 2048;   ///< beyond: the session is closed; above what can be on its way to it
  /// Token bucket per session over messages of every kind, pings included: sustained excess closes with kPolicy. The
  /// application has a lower one for commands, which it answers.
  double messages_per_s = 500.0;
  double message_burst_count = 1000.0;
  std::chrono::milliseconds write_stall_timeout{10'000};  ///< a write that takes longer evicts the session
  std::chrono::milliseconds handshake_timeout{10'000};
  std::chrono::milliseconds idle_timeout{60'000};    ///< pings half-way; silence beyond closes
  std::chrono::milliseconds close_timeout{2'000};    ///< patience for the peer's close frame
  std::chrono::milliseconds answer_timeout{30'000};  ///< patience for the application's answer to a request
  /// Pages that may talk to this server ("https://water.example") besides its own; "*" = any. Programs send no Origin
  /// and are not asked.
  std::vector<std::string> allowed_origins{};
  /// Token buckets for everybody behind one address (IPv6: one /64): requests beyond get 429, messages wait unread.
  double address_requests_per_s = 50.0;
  double address_request_burst_count = 1000.0;
  double address_messages_per_s = 4000.0;
  double address_message_burst_count = 8000.0;
};

/// Why a request or an upgrade was refused before the application saw it.
enum class Refused : std::uint8_t {
  kOrigin,      ///< 403: a page that is not on the list
  kRate,        ///< 429: too many requests from one address
  kFull,        ///< 503: max_session_count sessions are open, or too many of them by one address
  kRoom,        ///< 404: acceptSession said no
  kHandshake,   ///< 400, 404, 426: no WebSocket upgrade that this server knows
  kRequest,     ///< 400, 411, 413, 431: no HTTP request, one without a length, or too large a one
  kConnection,  ///< closed unheard: too many connections
};
inline constexpr std::size_t kRefusedCount = 7;
/// "origin", "rate", ... by Refused.
inline constexpr std::array<std::string_view, kRefusedCount> kRefusedNames{"origin",    "rate",    "full",      "room",
                                                                           "handshake", "request", "connection"};

/// Counters since the start (open_session_count: now).
struct ServerStats {
  std::uint64_t open_session_count = 0;
  std::uint64_t accepted_session_count = 0;
  std::uint64_t sent_bytes_count = 0;       ///< message bytes of both planes, without WebSocket headers
  std::uint64_t sent_frame_count = 0;       ///< data plane only
  std::uint64_t dropped_frame_count = 0;    ///< replaced in their slot before they were sent
  std::uint64_t lowered_level_count = 0;    ///< times a session was given a lower level
  std::uint64_t raised_level_count = 0;     ///< and a higher one again
  std::uint64_t evicted_session_count = 0;  ///< sessions that did not read: write stall or too many answers
  std::uint64_t waiting_control_count = 0;  ///< answers and state, now, over all sessions
  std::uint64_t waiting_frame_count = 0;    ///< now, over all sessions
  std::uint64_t delayed_message_count = 0;  ///< messages that waited for their address's bucket
  std::array<std::uint64_t, kRefusedCount> refused_count{};  ///< by Refused
  std::map<std::uint16_t, std::uint64_t> closed_by_code{};   ///< sessions that ended; 0: the connection broke
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
