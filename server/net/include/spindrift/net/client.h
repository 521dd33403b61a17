// WebSocket client connections, for the scripted client and the load generator. Moves bytes and never parses them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::net {

/// Address of a server: "ws://HOST[:PORT][/PATH]", or "wss://..." for TLS.
struct ClientUrl {
  std::string host;
  std::string port;
  std::string path;  ///< with its leading slash
  bool is_tls = false;

  /// Parses the URL; kInvalidInput says what is wrong.
  static core::Result<ClientUrl> parse(const std::string& url);

  /// Returns the address of a room's socket. The path may be that of a server ("/", or "/water/" behind a proxy), or of
  /// a socket ("/ws", "/ws/ROOM"), which stays as it is unless `room` names another room.
  [[nodiscard]] ClientUrl inRoom(const std::string& room) const;
};

struct ClientOptions {
  std::size_t message_max_bytes = 64u << 20;
  std::chrono::milliseconds connect_timeout{10'000};
  int receive_buffer_bytes = 0;  ///< of the kernel; 0 = the kernel's default
  bool reads = true;             ///< false: never reads a byte after the handshake
};

/// The callbacks of one client come one at a time, from a thread of its pool.
struct ClientEvents {
  std::function<void()> opened;
  std::function<void(core::ByteView)> message;
  /// Takes the end of the session, called once and last: the peer's close code (0 without one) and a line of text.
  std::function<void(std::uint16_t code, const std::string& reason)> closed;
};

/// Thread-safe. Dropping the last pointer does not close the connection: the pool keeps it until it is closed.
class Client {
 public:
  virtual ~Client() = default;
  /// Sends in order. At most kClientQueueMaxCount messages wait; further ones are dropped, and false is returned.
  virtual bool send(core::SharedBytes message) = 0;
  /// Starts the closing handshake after the waiting messages were sent.
  virtual void close() = 0;
  /// Closes the TCP connection without a closing handshake.
  virtual void vanish() = 0;
};

inline constexpr std::size_t kClientQueueMaxCount = 4096;

/// Owns the threads of the clients. Without threads, the caller runs the callbacks with runFor().
class ClientPool {
 public:
  /// Makes a pool. With 0 threads callbacks come from runFor() only.
  /// For wss:// the server's certificate must come from an authority of the system or of `ca_file` (PEM; read at the
  /// first such connection), and must have the URL's host.
  static std::unique_ptr<ClientPool> create(std::size_t thread_count, const std::string& ca_file = "");
  virtual ~ClientPool() = default;  ///< closes open connections at once; no callback comes after it

  virtual std::shared_ptr<Client> connect(const ClientUrl& url, const ClientOptions& options, ClientEvents events) = 0;
  /// Runs callbacks, of a pool without threads, for about this long, or until `done` returns true.
  virtual void runFor(std::chrono::milliseconds duration, const std::function<bool()>& done) = 0;
};

}  // namespace spindrift::net
