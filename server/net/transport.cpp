#include "transport.h"

#include <utility>

#include <boost/beast/websocket/teardown.hpp>

namespace spindrift::net {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

void Transport::read(asio::mutable_buffer into, Handler handler) {
  if (TlsLayer* const layer = tls()) return layer->read(into, std::move(handler));
  state_->tcp.async_read_some(into, std::move(handler));
}

void Transport::write(std::span<const asio::const_buffer> parts, Handler handler) {
  if (TlsLayer* const layer = tls()) return layer->write(parts, std::move(handler));
  state_->tcp.async_write_some(Parts(parts.begin(), parts.end()), std::move(handler));
}

void Transport::tearDown(boost::beast::role_type role, Handler handler) {
  if (TlsLayer* const layer = tls()) return layer->shutdown(std::move(handler));
  websocket::async_teardown(
      role, socket(), [handler = std::move(handler)](const boost::system::error_code& error) { handler(error, 0); });
}

void teardown(boost::beast::role_type role, Transport& stream, boost::system::error_code& error) {
  websocket::teardown(role, stream.socket(), error);
}

}  // namespace spindrift::net
