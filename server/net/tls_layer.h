// TLS over a TCP stream, behind an interface without templates: OpenSSL and Asio's SSL headers are compiled in
// tls_*.cpp only, and a plain connection has nothing of them.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/system/error_code.hpp>

namespace spindrift::net {

/// Used on the stream's strand. One read and one write may be in progress at a time. The owner keeps the object until
/// every operation has called its handler.
class TlsLayer {
 public:
  using Handler = std::function<void(boost::system::error_code, std::size_t)>;

  virtual ~TlsLayer() = default;
  /// `received`: bytes that were read from the stream before; they stay valid until the handler is called.
  virtual void handshake(boost::asio::const_buffer received, Handler handler) = 0;
  virtual void read(boost::asio::mutable_buffer buffer, Handler handler) = 0;
  /// Writes the beginning of `parts`, which has at least one and none that is empty; reports how much. The bytes stay
  /// valid until then, the array of parts only during the call.
  virtual void write(std::span<const boost::asio::const_buffer> parts, Handler handler) = 0;
  /// Sends close_notify and waits for the peer's, or for the end of the connection.
  virtual void shutdown(Handler handler) = 0;
  /// Says for people why a handshake failed with this error.
  [[nodiscard]] virtual std::string reasonOf(const boost::system::error_code& error) const = 0;
};

/// Settings of many connections: certificate and key of a server, or the authorities that a client trusts. Thread-safe.
class TlsContext;

/// `stream` outlives the layer.
std::unique_ptr<TlsLayer> makeServerTls(boost::beast::tcp_stream& stream, TlsContext& context);

/// `host`: name or IP address that the server's certificate must have.
std::unique_ptr<TlsLayer> makeClientTls(boost::beast::tcp_stream& stream, TlsContext& context, const std::string& host);

}  // namespace spindrift::net
