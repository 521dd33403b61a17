#include <algorithm>
#include <cmath>

#include <spindrift/service/water_server.h>

namespace spindrift::service {

core::Result<std::unique_ptr<WaterServer>> WaterServer::start(WaterServerOptions options) {
  auto self = std::unique_ptr<WaterServer>(new WaterServer);
  self->gateway_ = std::make_unique<Gateway>(GatewayOptions{.access = std::move(options.access),
                                                            .message_max_bytes = options.network.read_message_max_bytes,
                                                            .messages_per_s = options.network.messages_per_s,
                                                            .message_burst_count = options.network.message_burst_count,
                                                            .hello_patience = options.hello_patience,
                                                            .on_drain = std::move(options.on_drain)},
                                             self->sources_);
  self->encoder_ = std::make_unique<rooms::EncoderThread>(*self->gateway_);
  self->sources_.encoder = self->encoder_.get();
  auto simulation = rooms::SimulationThread::start(options.device, std::move(options.rooms), std::move(options.rules),
                                                   options.max_room_count, *self->gateway_);
  if (!simulation) return simulation.error();
  self->simulation_ = *std::move(simulation);
  self->gateway_->serve(*self->simulation_, *self->encoder_);
  auto network = net::Server::start(options.network, *self->gateway_);
  if (!network) return network.error();
  self->network_ = *std::move(network);
  self->sources_.network = self->network_.get();
  self->simulation_->run();
  self->port_ = self->network_->port();
  return self;
}

WaterServer::~WaterServer() {
  stop();
}

void WaterServer::drain(std::chrono::milliseconds closes_in, const std::string& go_to) {
  /// A server that is started again can take this many clients a second: handshake, greeting and keyframes.
  constexpr double kReturnsPerS = 200.0;
  constexpr double kRestart_s = 1.0;  // shortest time in which a server comes back
  const double closes_in_s = std::chrono::duration<double>(closes_in).count();
  const double spread_s = static_cast<double>(network_->stats().open_session_count) / kReturnsPerS;
  v1::Draining out;
  out.set_closes_in_s(closes_in_s);
  out.set_go_to(go_to);
  out.set_reconnect_after_min_s(go_to.empty() ? closes_in_s + kRestart_s : 0.0);
  out.set_reconnect_after_max_s(go_to.empty() ? closes_in_s + kRestart_s + std::max(0.5, spread_s) : closes_in_s);
  network_->drain(std::chrono::seconds(static_cast<std::int64_t>(std::ceil(closes_in_s + kRestart_s))));
  gateway_->drain(out);
}

void WaterServer::stop() {
  if (network_) network_->stop();
  if (encoder_) encoder_->stop();  // releases the frames before their devices are destroyed
  if (simulation_) simulation_->stop();
}

}  // namespace spindrift::service
