// A TCP proxy between a client and a server on this machine that can stop forwarding without closing anything: to the
// server this looks like a client whose cable was pulled.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace spindrift::test {

/// Forwards one connection.
class SilentProxy {
 public:
  /// Throws std::runtime_error when no port can be had.
  explicit SilentProxy(std::uint16_t server_port);
  ~SilentProxy();
  SilentProxy(const SilentProxy&) = delete;
  SilentProxy& operator=(const SilentProxy&) = delete;

  /// The port for the client.
  std::uint16_t port() const { return port_; }
  /// From now on nothing is read or sent, and both connections stay open until the proxy is destroyed.
  void fallSilent() { silent_ = true; }

 private:
  void forward(std::uint16_t server_port);

  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> silent_{false};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace spindrift::test
