// The network module: one port for HTTP and WebSocket. It moves bytes and never parses a message; the Application does
// (implemented by service). Threads: Server runs `thread_count` I/O threads. Every Application call comes from one of
// them, and calls for the same session come one at a time.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/demand_table.h>
#include <spindrift/core/level.h>
#include <spindrift/core/result.h>
#include <spindrift/core/sender.h>
#include <spindrift/core/translator.h>
#include <spindrift/http/message.h>

namespace spindrift::net {

using core::SessionId;

/// A stream of frames: one layer in one packing. The number indexes the newest-frame slots of an outbox.
using StreamIndex = std::uint32_t;
inline constexpr StreamIndex kMaxStreamCount = core::DemandTable::kStreamMaxCount;

/// One frame of a stream in the forms that its sessions need; one of the two may be null.
struct FrameBytes {
  core::SharedBytes keyframe;  ///< can be decoded alone
  core::SharedBytes delta;     ///< needs the previous frame of this level
  core::FrameLevels levels{};
};

/// Topic of a state message: among waiting messages with the same name only the newest is sent.
struct StateTopic {
  enum class Scope : std::uint8_t {
    kAlone,  ///< replaces its own name only
    kPart,   ///< replaces its own name; is replaced by kWhole, which repeats its content
    kWhole,  ///< replaces its own name and every waiting kPart
  };
  std::string name;  ///< "people", "parameter:wave.depth_m"; the number of names bounds what waits for a session
  Scope scope = Scope::kAlone;
};

/// A session's way of watching a stream.
struct Watch {
  double max_rate_hz = 0.0;  ///< 0 stops the stream
  core::Level level = core::Level::kFull;
  bool adapts = false;  ///< the server may lower the level while the link cannot carry this one
  /// The session has watched nothing of the layer before, so a frame that others have already cannot be older than one
  /// it has: Hub::offerNewest().
  bool is_first = false;
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
  kRoomClosed = 4404,       ///< the room was closed
  kResumedElsewhere = 4409  ///< another connection resumed this person
};

/// Reason of the end of a session, for the log: code (0 if the connection broke) and one line.
struct SessionEnd {
  std::uint16_t code = 0;
  std::string reason;
};

/// Messages that wait to be sent.
struct Waiting {
  std::size_t answer_count = 0;
  std::size_t state_count = 0;
  std::size_t frame_count = 0;
};

/// The sending side of one session.
class SessionLink;

/// Sends to sessions. Thread-safe, never blocks, callable from any thread. Unknown session ids are ignored, because the
/// session may have just ended. One instance per Server, with one mutex; publish() visits only the sessions that watch
/// that room and stream. A session keeps its watches when it changes the room.
class Hub {
 public:
  /// Sends an answer to the session's own request. Control plane: ordered, never dropped. While
  /// ServerOptions::answer_pause_count of them wait, the session is not read; beyond answer_max_count it is closed with
  /// kTryAgainLater.
  void sendAnswer(SessionId session, core::SharedBytes message);

  /// Sends a state message. Control plane: only the newest message of a topic waits; it takes the place of the older
  /// one. Never closes a session.
  void sendState(SessionId session, const StateTopic& topic, core::SharedBytes message);

  /// Sends a state message to every session of the room.
  void broadcastState(const std::string& room, const StateTopic& topic, core::SharedBytes message);

  /// Publishes a frame. Data plane: one write in flight and one newest slot per stream; an unsent older frame in the
  /// slot is dropped and counted. `room` is the group that the sessions joined. Only sessions that watch `stream` get
  /// the frame, at most at their requested rate (with 10 % tolerance; a frame that comes too early for a session is
  /// skipped and not counted). A session that has the previous frame gets the delta if there is one, any other session
  /// the keyframe. If the keyframe is missing, it gets nothing, and its DemandTable has the need. Each level is
  /// published by itself; a session gets its own level.
  void publish(const std::string& room, StreamIndex stream, const FrameBytes& frame);

  /// Gives the newest frame of the stream at this level, as a keyframe, to the sessions that have just begun to watch
  /// it (Watch::is_first) and have had no frame yet. They continue with the delta of the next frame, so no other frame
  /// may be published between that one and this call. It does not count for the rate.
  void offerNewest(const std::string& room, StreamIndex stream, const FrameBytes& frame);

  /// Moves the session into a room. It leaves its previous room; its watches stay, unsent frames are dropped. While it
  /// is there, `demand` says what it needs of the room's frames.
  void join(SessionId session, const std::string& room, std::shared_ptr<core::DemandTable> demand);

  /// Starts, changes or stops a stream for a session.
  void watch(SessionId session, StreamIndex stream, const Watch& watch);

  /// Sends all queued control messages, then closes. The socket is closed after close_timeout in any case.
  void close(SessionId session, CloseCode code, std::string reason);

  /// Closes the session as close() does, at a later time; the latest call counts. time_point::max() means never.
  void closeAt(SessionId session, std::chrono::steady_clock::time_point when, CloseCode code, std::string reason);

  // For the Server and its sessions.

  /// In a room with this many sessions or more, sessions are woken once for all frames of the next moment, because most
  /// of the cost of a frame is the write, and a write takes all frames along that wait.
  static constexpr std::size_t kGatherSessionCount = 64;
  /// So many of them are woken by one task.
  static constexpr std::size_t kWokenTogetherCount = 16;
  /// Calls its argument once on an I/O thread, without the hub's lock.
  using Call = std::function<void(std::function<void()>)>;
  /// `later` calls about a millisecond later, `soon` as soon as a thread is free. Without this every frame wakes its
  /// sessions at once. Call it before the first session.
  void gatherFrames(Call later, Call soon) {
    later_ = std::move(later);
    soon_ = std::move(soon);
  }

  void add(SessionId session, std::shared_ptr<SessionLink> link);
  /// Removes the session; no call reaches its link afterwards.
  void remove(SessionId session);

  /// Sum over all sessions.
  Waiting waiting() const;
  /// Number of rooms with at least one session.
  std::size_t roomCount() const;

 private:
  struct Member {
    std::shared_ptr<SessionLink> link;
    std::optional<std::string> room;
    std::array<bool, kMaxStreamCount> watches{};
  };
  struct Watcher {
    SessionId session = 0;
    std::shared_ptr<SessionLink> link;
  };
  struct Group {
    std::vector<Watcher> sessions;
    bool will_wake = false;  ///< wakeRoom() comes
    std::array<std::vector<Watcher>, kMaxStreamCount> watchers;
  };

  void enterRoom(SessionId session, Member& member, const std::string& room);
  void leaveRoom(SessionId session, Member& member);
  void wakeRoom(const std::string& room);

  Call later_;
  Call soon_;
  mutable std::mutex mutex_;
  std::unordered_map<SessionId, Member> members_;
  std::map<std::string, Group> rooms_;
};

/// A new session: the parts of its WebSocket's address, and the client that opens it.
struct SessionOpening {
  std::string room;  ///< "" is the default room
  std::string peer;
  /// `?onlooker`: a picture among others, such as the front page's, which nobody takes part through.
  bool is_onlooker = false;
  std::string subprotocol{};  ///< that the client offered; "": none
  std::string token{};        ///< secret: UpgradeDecision::token
};

/// The user of a Server: implemented by service, outlives the Server. An exception from a callback is logged and ends
/// only that session (kInternalError) or request (HTTP 500).
class Application {
 public:
  virtual ~Application() = default;

  /// Takes the hub. Called once by Server::start(), before any other call. The hub is valid as long as the Server.
  virtual void serverStarts(Hub& /*hub*/) {}
  /// Checks a WebSocket handshake on `/ws/{room}` (or `/ws` = the default room, empty name). An Error refuses the
  /// upgrade with the error's line as the body: kUnavailable with HTTP 503 and Retry-After, all others with 404.
  virtual core::Result<void> acceptSession(const std::string& room) = 0;
  /// Returns the protocol of a session that is about to open; null: the application's own, in binary messages. What
  /// the client sends and gets passes through it, on the session's strand.
  virtual std::unique_ptr<core::Translator> translatorFor(const SessionOpening& /*opening*/) { return nullptr; }
  /// Takes a session that was opened; the application sends the greeting.
  virtual void sessionOpened(SessionId session, const SessionOpening& opening) = 0;
  /// Takes a change of the highest level for the session's adapting watches, down or up, to what its link can carry.
  virtual void sessionLevelChanged(SessionId /*session*/, core::Level /*level*/) {}
  /// Takes one whole binary message.
  virtual void sessionMessage(SessionId session, core::ByteView message) = 0;
  /// Takes the end of a session; last call for this id.
  virtual void sessionClosed(SessionId session, const SessionEnd& end) = 0;
  /// Takes a request under /api/, or /healthz, /readyz, /metrics. Call `respond` at once or later.
  virtual void httpRequest(const HttpRequest& request, HttpResponder respond) = 0;
};

/// PEM files: the chain of certificates, the server's own first, and its private key without a passphrase.
struct TlsFiles {
  std::string certificate_file;
  std::string key_file;
};

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0 = any free port; read the real one from Server::port()
  /// Descriptor of a TCP socket that listens already, bound to `address` and `port`: used instead of a new one. The
  /// Server takes it over and closes it.
  std::optional<int> listening_socket{};
  /// If set, the port speaks TLS only. The files are read again when they change.
  std::optional<TlsFiles> tls{};
  std::chrono::milliseconds tls_watch_interval{2'000};  ///< between two looks at the files
  std::string web_root{};                               ///< folder of the built web client; empty = no page is served
  std::size_t thread_count = 1;
  std::size_t max_session_count = 256;
  /// Share of max_session_count that one address may use (IPv6: one /64), at least one session. Use 1 behind a proxy
  /// that is not in trusted_proxies: all its clients have its address.
  double address_session_share = 0.5;
  /// File descriptors that connections leave to the rest of the program, for its state on disk, devices and logs.
  std::size_t reserved_descriptor_count = 64;
  std::size_t read_message_max_bytes = 16 * 1024;  ///< client messages are small
  std::size_t request_body_max_bytes = 64 * 1024;
  std::size_t answer_pause_count = 128;  ///< number of waiting answers from which the session is not read
  std::size_t answer_max_count = 2048;   ///< beyond it the session is closed; more than can be in flight
  /// Token bucket per session over messages of every kind, pings included: sustained excess closes the session with
  /// kPolicy. The application has a lower limit for commands, whose excess it rejects one by one.
  double messages_per_s = 500.0;
  double message_burst_count = 1000.0;
  std::chrono::milliseconds write_stall_timeout{10'000};  ///< a write that takes longer evicts the session
  std::chrono::milliseconds handshake_timeout{10'000};
  std::chrono::milliseconds idle_timeout{60'000};    ///< silence that closes a session; a ping is sent at half of it
  std::chrono::milliseconds close_timeout{2'000};    ///< longest wait for the peer's close frame
  std::chrono::milliseconds answer_timeout{30'000};  ///< longest wait for the application's answer to a request
  /// Additional allowed Origins ("https://water.example"); "*" = any. Clients that are not browsers send no Origin and
  /// are not checked.
  std::vector<std::string> allowed_origins{};
  /// Sessions at /foxglove at a time: there each one costs the translation of its frames. 0: there is no such address.
  std::size_t foxglove_session_max_count = 0;
  /// Origins whose pages may show `/?embed` in a frame (checkParentOrigin()). No page may show anything else in one.
  std::vector<std::string> embedding_origins{};
  /// Networks of proxies (checkNetwork()). Where the TCP peer is in one of them, the client's address, for all limits
  /// and logs, is the one in X-Forwarded-For; from any other peer that header is ignored.
  std::vector<std::string> trusted_proxies{};
  /// Token buckets per address (IPv6: one /64): excess requests get 429, excess messages wait unread.
  double address_requests_per_s = 50.0;
  double address_request_burst_count = 1000.0;
  double address_messages_per_s = 4000.0;
  double address_message_burst_count = 8000.0;
};

/// Reason for which a request or an upgrade was refused before the application saw it.
enum class Refused : std::uint8_t {
  kOrigin,      ///< 403: the page's Origin is not allowed
  kRate,        ///< 429: too many requests from one address
  kFull,        ///< 503: max_session_count sessions are open, or too many of them from one address
  kRoom,        ///< 404, 503: acceptSession refused
  kHandshake,   ///< 400, 404, 426: not a supported WebSocket upgrade
  kRequest,     ///< 400, 411, 413, 431: invalid HTTP, no length, or too large
  kConnection,  ///< closed without a reply: too many connections
  kDraining,    ///< 503: the server is about to end
};
inline constexpr std::size_t kRefusedCount = 8;
/// Names indexed by Refused: "origin", "rate", ...
inline constexpr std::array<std::string_view, kRefusedCount> kRefusedNames{
    "origin", "rate", "full", "room", "handshake", "request", "connection", "draining"};

/// Counters since the start (open_session_count: current value).
struct ServerStats {
  std::uint64_t open_session_count = 0;
  std::uint64_t accepted_session_count = 0;
  std::uint64_t open_connection_count = 0;  ///< TCP connections open now, those of sessions included
  std::uint64_t connection_max_count = 0;   ///< as many may be open: fewer than usual where RLIMIT_NOFILE is low
  std::uint64_t failed_accept_count = 0;    ///< times that the system had no descriptor or memory for a connection
  std::uint64_t silent_session_count = 0;   ///< sessions cut off because nothing came for idle_timeout
  std::uint64_t sent_bytes_count = 0;       ///< message bytes of both planes, without WebSocket headers
  std::uint64_t sent_frame_count = 0;       ///< data plane only
  std::uint64_t write_count = 0;            ///< to sessions, of one or more messages each
  std::uint64_t waiting_write_count = 0;    ///< those among them that the kernel did not take at once; with TLS all
  std::uint64_t dropped_frame_count = 0;    ///< replaced in their slot by a newer frame before they were sent
  std::uint64_t lowered_level_count = 0;    ///< times that a session's level was lowered
  std::uint64_t raised_level_count = 0;     ///< times that a session's level was raised again
  std::uint64_t evicted_session_count = 0;  ///< sessions closed for not reading: write stall or too many answers
  std::uint64_t waiting_control_count = 0;  ///< answers and state messages waiting now, over all sessions
  std::uint64_t waiting_frame_count = 0;    ///< frames waiting now, over all sessions
  std::uint64_t delayed_message_count = 0;  ///< messages delayed by their address's token bucket
  std::array<std::uint64_t, kRefusedCount> refused_count{};  ///< by Refused
  std::uint64_t tls_handshake_count = 0;                     ///< completed ones
  std::uint64_t failed_tls_handshake_count = 0;              ///< neither TLS nor in time, or broken off
  std::uint64_t tls_reload_count = 0;                        ///< times that a changed certificate was taken over
  std::uint64_t failed_tls_reload_count = 0;                 ///< times that a changed certificate could not be used
  /// When the certificate in use, or one of its chain, expires; nullopt without TLS.
  std::optional<std::chrono::system_clock::time_point> certificate_expires{};
  std::map<std::uint16_t, std::uint64_t> closed_by_code{};  ///< ended sessions by close code; 0: the connection broke
};

/// A running server. Created by start(); the destructor stops it.
class Server {
 public:
  /// Binds the port and starts the I/O threads. Error kUnavailable (port in use, bad address, a descriptor that is no
  /// socket) names address, port and what to do; kInvalidInput: trusted_proxies, tls.
  static core::Result<std::unique_ptr<Server>> start(const ServerOptions& options, Application& application);
  virtual ~Server() = default;

  virtual std::uint16_t port() const = 0;
  virtual Hub& hub() = 0;
  virtual ServerStats stats() const = 0;
  /// Refuses new sessions from now on, with 503 and Retry-After, and ends HTTP connections after their next reply. Open
  /// sessions continue. Thread-safe.
  virtual void drain(std::chrono::seconds retry_after) = 0;
  /// Reads certificate and key again, in the background; only with TLS. Thread-safe.
  virtual void reloadCertificate() = 0;
  /// Stops accepting, answers waiting requests with 503, closes every session with 1001, waits at most close_timeout +
  /// 1 s, closes the remaining sockets and joins the threads. sessionClosed has been called for every open session when
  /// it returns. Idempotent; not from an I/O thread.
  virtual void stop() = 0;
};

}  // namespace spindrift::net
