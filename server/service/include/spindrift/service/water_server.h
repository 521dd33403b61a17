// A whole server in one object: starts simulation, encoder and network in this order, and stops them in reverse order.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/net/server.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/gateway.h>

namespace spindrift::service {

struct WaterServerOptions {
  gpu::DeviceChoice device;
  net::ServerOptions network;
  std::vector<rooms::RoomSetup> rooms;  ///< the first is the default room; none only in a cluster
  rooms::RoomRules rules;               ///< settings that the rooms share
  std::size_t max_room_count = 8;
  ClusterHooks cluster{};  ///< what they point to outlives stop()
  AccessOptions access;
  std::chrono::milliseconds hello_patience{10'000};  ///< sessions that have not sent Hello by then are closed
  std::function<void()> on_drain{};                  ///< see Gateway
  std::string public_url{};                          ///< net::PageAddress::public_url
  RecordingRules recordings{};
};

class WaterServer {
 public:
  /// Starts the server. Errors: those of the device, the rooms and the port.
  static core::Result<std::unique_ptr<WaterServer>> start(WaterServerOptions options);
  ~WaterServer();
  WaterServer(const WaterServer&) = delete;
  WaterServer& operator=(const WaterServer&) = delete;

  /// Prepares the end, `closes_in` from now on: tells the clients to go to `go_to` (empty: to come back here), refuses
  /// new sessions and rooms, and lets /readyz answer 503. stop() comes next.
  void drain(std::chrono::milliseconds closes_in, const std::string& go_to);
  /// Closes the sessions with 1001, then ends the simulation. Idempotent.
  void stop();

  [[nodiscard]] net::Server& network() { return *network_; }
  [[nodiscard]] std::uint16_t port() const { return network_->port(); }
  [[nodiscard]] Gateway& gateway() { return *gateway_; }
  [[nodiscard]] rooms::RoomHost& simulation() { return *simulation_; }
  [[nodiscard]] net::ServerStats networkStats() const { return network_->stats(); }
  [[nodiscard]] const rooms::EncoderThread& encoder() const { return *encoder_; }

 private:
  WaterServer() = default;

  MetricsSources sources_;
  std::unique_ptr<Gateway> gateway_;
  std::unique_ptr<rooms::EncoderThread> encoder_;
  std::unique_ptr<rooms::RoomHost> simulation_;
  std::unique_ptr<net::Server> network_;
};

}  // namespace spindrift::service
