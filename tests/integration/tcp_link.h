// A TCP proxy between processes of a test and a server on this machine that can stop forwarding: a network that is cut
// and comes back.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace spindrift::test {

/// Forwards any number of connections.
class TcpLink {
 public:
  /// Throws std::runtime_error when no port can be had.
  explicit TcpLink(std::uint16_t server_port);
  ~TcpLink();
  TcpLink(const TcpLink&) = delete;
  TcpLink& operator=(const TcpLink&) = delete;

  /// The port for the clients.
  std::uint16_t port() const { return port_; }
  /// From now on nothing is forwarded and nothing is closed; what both sides send waits, new connections too.
  void cut() { is_cut_ = true; }
  /// Forwards again, also what has waited.
  void restore() { is_cut_ = false; }

 private:
  void forward(std::uint16_t server_port);

  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> is_cut_{false};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace spindrift::test
