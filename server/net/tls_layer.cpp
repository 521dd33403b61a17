#include "tls_layer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "tls_context.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// Largest content of a TLS record (RFC 8446 section 5.1).
constexpr std::size_t kRecordBytes = 16 * 1024;
/// A part from this size on is encrypted where it lies; shorter ones, such as frame headers, share a record with what
/// follows.
constexpr std::size_t kLongBytes = 8 * 1024;

class OpensslLayer final : public TlsLayer {
 public:
  OpensslLayer(boost::beast::tcp_stream& stream, TlsContext& context, asio::ssl::stream_base::handshake_type role)
      : ssl_(stream, context.asio()), role_(role) {}

  SSL* handle() { return ssl_.native_handle(); }

  void handshake(asio::const_buffer received, Handler handler) override {
    ssl_.async_handshake(role_, received, std::move(handler));
  }

  void read(asio::mutable_buffer buffer, Handler handler) override { ssl_.async_read_some(buffer, std::move(handler)); }

  void write(std::span<const asio::const_buffer> parts, Handler handler) override {
    if (parts.size() == 1 || parts[0].size() >= kLongBytes) return ssl_.async_write_some(parts[0], std::move(handler));
    std::size_t bytes_count = 0;
    for (const asio::const_buffer& part : parts) {
      const std::size_t taken = std::min(part.size(), record_.size() - bytes_count);
      std::memcpy(record_.data() + bytes_count, part.data(), taken);
      bytes_count += taken;
    }
    ssl_.async_write_some(asio::const_buffer(record_.data(), bytes_count), std::move(handler));
  }

  void shutdown(Handler handler) override {
    ssl_.async_shutdown([handler = std::move(handler)](const error_code& error) { handler(error, 0); });
  }

  std::string reasonOf(const error_code& error) const override {
    const long verdict = SSL_get_verify_result(const_cast<OpensslLayer*>(this)->handle());
    if (verdict == X509_V_OK) return error.message();
    return std::string("the certificate is not accepted: ") + X509_verify_cert_error_string(verdict);
  }

 private:
  asio::ssl::stream<boost::beast::tcp_stream&> ssl_;
  const asio::ssl::stream_base::handshake_type role_;
  std::array<std::uint8_t, kRecordBytes> record_;
};

}  // namespace

std::unique_ptr<TlsLayer> makeServerTls(boost::beast::tcp_stream& stream, TlsContext& context) {
  return std::make_unique<OpensslLayer>(stream, context, asio::ssl::stream_base::server);
}

std::unique_ptr<TlsLayer> makeClientTls(boost::beast::tcp_stream& stream, TlsContext& context,
                                        const std::string& host) {
  auto out = std::make_unique<OpensslLayer>(stream, context, asio::ssl::stream_base::client);
  error_code is_name;
  (void)asio::ip::make_address(host, is_name);
  if (is_name) {
    SSL_set_tlsext_host_name(out->handle(), host.c_str());  // RFC 6066: names only
    SSL_set1_host(out->handle(), host.c_str());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(out->handle()), host.c_str());
  }
  return out;
}

}  // namespace spindrift::net
