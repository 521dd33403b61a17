// WebSocket connections from the other side: for the scripted client and the load generator. Moves bytes and never
// parses.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::net {

/// Where to: "ws://HOST[:PORT][/PATH]". TLS ends before a Spindrift server, so wss:// is not spoken here.
struct ClientUrl {
  std::string host;
  std::string port;
  std::string path;  ///< with its slash

  /// kInvalidInput with what is wrong.
  static core::Result<ClientUrl> parse(const std::string& url);
};

struct ClientOptions {
  std::size_t message_max_bytes = 64u << 20;
  std::chrono::milliseconds connect_timeout{10'000};
  int receive_buffer_bytes = 0;  ///< the kernel's; 0 = its choice
  bool reads = true;             ///< false: never reads a byte after the handshake
};

/// Callbacks of one client come one at a time, from a thread of its pool.
struct ClientEvents {
  std::function<void()> opened;
  std::function<void(core::ByteView)> message;
  /// Once, last: the peer's close code (0 without one) and a line.
  std::function<void(std::uint16_t code, const std::string& reason)> closed;
};

/// Thread-safe. Letting go of the last pointer does not close it: its pool keeps it until it is closed.
class Client {
 public:
  virtual ~Client() = default;
  /// Sent in order. At most kClientQueueMaxCount wait; more are dropped and false is returned.
  virtual bool send(core::SharedBytes message) = 0;
  /// The closing handshake; what waits is sent before.
  virtual void close() = 0;
  /// Closes the TCP connection without a word.
  virtual void vanish() = 0;
};

inline constexpr std::size_t kClientQueueMaxCount = 4096;

/// Owns the clients' threads, or, without any, is driven by the caller.
class ClientPool {
 public:
  /// With 0 threads callbacks come from runFor() alone.
  static std::unique_ptr<ClientPool> create(std::size_t thread_count);
  virtual ~ClientPool() = default;  ///< cuts what is open; no callback comes after it

  virtual std::shared_ptr<Client> connect(const ClientUrl& url, const ClientOptions& options, ClientEvents events) = 0;
  /// Without threads: runs callbacks for about this long, or until `done` says so.
  virtual void runFor(std::chrono::milliseconds duration, const std::function<bool()>& done) = 0;
};

}  // namespace spindrift::net
