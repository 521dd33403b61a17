// A NATS connection: publish and subscribe, for messages of any size. Sees only bytes.
// Delivery is at most once: a message is lost when the connection breaks or a receiver is too slow. Messages of one
// connection to one subject arrive in the order in which they were published.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::bus {

struct BusOptions {
  /// "nats://HOST:4222", "nats://USER:PASSWORD@HOST", several separated by commas. With "tls://…" or a ca_file, servers
  /// without TLS are refused.
  std::string url;
  std::string name;     ///< of this process, shown by the NATS server
  std::string ca_file;  ///< certificates that sign the server's; empty: the system's
};

struct BusStats {
  bool is_connected = false;
  std::uint64_t dropped_message_count = 0;  ///< not sent while disconnected, incomplete, or more than a receiver took
  std::uint64_t reconnect_count = 0;
};

/// Ends with its destructor, which waits for a running handler unless it is called from one.
class Subscription {
 public:
  virtual ~Subscription() = default;
};

/// Thread-safe. All handlers run on one thread, in the order in which the messages arrived; they must not block.
class Bus {
 public:
  /// Connects. Later it connects again by itself whenever the connection breaks. Error kUnavailable names the URL
  /// without its password.
  static core::Result<std::unique_ptr<Bus>> connect(const BusOptions& options);
  virtual ~Bus() = default;

  /// Sends `head` and `body` as one message. While there is no connection it is dropped and counted.
  virtual void publish(const std::string& subject, core::ByteView head, core::ByteView body) = 0;
  void publish(const std::string& subject, core::ByteView message) { publish(subject, message, {}); }

  using Handler = std::function<void(core::ByteView message)>;
  /// Subscribes to a subject. At most `waiting_max_bytes` of messages wait for the handler; further ones are dropped
  /// and counted. Null if the subject is not valid or the connection was closed for good.
  virtual std::unique_ptr<Subscription> subscribe(const std::string& subject, std::size_t waiting_max_bytes,
                                                  Handler handler) = 0;

  [[nodiscard]] virtual bool isConnected() const = 0;
  [[nodiscard]] virtual BusStats stats() const = 0;
  /// Returns the connection's own handle, for KeyValues.
  [[nodiscard]] virtual void* connection() const = 0;
};

/// Returns the URL without user and password, for messages.
std::string withoutPassword(const std::string& url);

}  // namespace spindrift::bus
