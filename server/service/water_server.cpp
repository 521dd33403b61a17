#include <spindrift/net/page_urls.h>
#include <spindrift/service/water_server.h>

namespace spindrift::service {
namespace {

/// A room has a log and for moments a snapshot open, and on some drivers a device file.
constexpr std::size_t kDescriptorsPerRoom = 4;

}  // namespace

core::Result<std::unique_ptr<WaterServer>> WaterServer::start(WaterServerOptions options) {
  auto self = std::unique_ptr<WaterServer>(new WaterServer);
  self->gateway_ =
      std::make_unique<Gateway>(std::move(options.access),
                                SessionRules{.message_max_bytes = options.network.read_message_max_bytes,
                                             .messages_per_s = options.network.messages_per_s,
                                             .message_burst_count = options.network.message_burst_count,
                                             .hello_patience = options.hello_patience},
                                self->sources_, std::move(options.on_drain), std::move(options.recordings));
  self->gateway_->join(options.cluster);
  self->gateway_->rest().tellPadUrls(
      [&sources = self->sources_, page = net::PageAddress{.address = options.network.address,
                                                          .is_tls = options.network.tls.has_value(),
                                                          .public_url = std::move(options.public_url)}]() {
        const net::Server* const network = sources.network;
        if (network == nullptr) return std::vector<std::string>{};  // a request of the first moment
        net::PageAddress now = page;
        now.port = network->port();
        return net::padUrls(now);
      });
  self->encoder_ = std::make_unique<rooms::EncoderThread>(*self->gateway_);
  self->sources_.encoder = self->encoder_.get();
  auto simulation = rooms::RoomHost::start(options.device, std::move(options.rooms), std::move(options.rules),
                                           options.max_room_count, *self->gateway_);
  if (!simulation) return simulation.error();
  self->simulation_ = *std::move(simulation);
  self->gateway_->serve(*self->simulation_, *self->encoder_);
  options.network.reserved_descriptor_count += kDescriptorsPerRoom * options.max_room_count;
  auto network = net::Server::start(options.network, *self->gateway_);
  if (!network) return network.error();
  self->network_ = *std::move(network);
  self->sources_.network = self->network_.get();
  self->simulation_->run();
  return self;
}

WaterServer::~WaterServer() {
  stop();
}

void WaterServer::drain(std::chrono::milliseconds closes_in, const std::string& go_to) {
  gateway_->drain(*network_, closes_in, go_to);
}

void WaterServer::stop() {
  if (network_) network_->stop();
  if (encoder_) encoder_->stop();  // releases the frames before their devices are destroyed
  if (gateway_) gateway_->recordings().endAll("the server ended");
  if (simulation_) simulation_->stop();
}

}  // namespace spindrift::service
