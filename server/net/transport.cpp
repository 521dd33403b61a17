#include "transport.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "tls_context.h"

namespace spindrift::net {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

/// Largest content of a TLS record (RFC 8446 section 5.1).
constexpr std::size_t kRecordBytes = 16 * 1024;
/// A part from this size on is encrypted where it lies; shorter ones, such as frame headers, share a record with what
/// follows.
constexpr std::size_t kLongBytes = 8 * 1024;

}  // namespace

struct Transport::Tls {
  Tls(boost::beast::tcp_stream& tcp, TlsContext& settings, ssl::stream_base::handshake_type our_role)
      : stream(tcp, settings.context), role(our_role) {}

  void write(std::span<const asio::const_buffer> parts, Handler handler) {
    if (parts.size() == 1 || parts[0].size() >= kLongBytes)
      return stream.async_write_some(parts[0], std::move(handler));
    std::size_t bytes_count = 0;
    for (const asio::const_buffer& part : parts) {
      const std::size_t taken = std::min(part.size(), record.size() - bytes_count);
      std::memcpy(record.data() + bytes_count, part.data(), taken);
      bytes_count += taken;
    }
    stream.async_write_some(asio::const_buffer(record.data(), bytes_count), std::move(handler));
  }

  ssl::stream<boost::beast::tcp_stream&> stream;
  const ssl::stream_base::handshake_type role;
  std::array<std::uint8_t, kRecordBytes> record;
};

void Transport::useServerTls(TlsContext& context) {
  state_->tls = std::make_shared<Tls>(tcp(), context, ssl::stream_base::server);
}

void Transport::useClientTls(TlsContext& context, const std::string& host) {
  state_->tls = std::make_shared<Tls>(tcp(), context, ssl::stream_base::client);
  SSL* const connection = state_->tls->stream.native_handle();
  error_code is_name;
  (void)asio::ip::make_address(host, is_name);
  if (is_name) {
    SSL_set_tlsext_host_name(connection, host.c_str());  // RFC 6066: names only
    SSL_set1_host(connection, host.c_str());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(connection), host.c_str());
  }
}

std::string Transport::tlsReasonOf(const error_code& error) const {
  const long verdict = SSL_get_verify_result(state_->tls->stream.native_handle());
  if (verdict == X509_V_OK) return error.message();
  return std::string("the certificate is not accepted: ") + X509_verify_cert_error_string(verdict);
}

void Transport::handshake(asio::const_buffer received, Handler handler) {
  state_->tls->stream.async_handshake(state_->tls->role, received, std::move(handler));
}

void Transport::read(asio::mutable_buffer into, Handler handler) {
  if (isTls()) return state_->tls->stream.async_read_some(into, std::move(handler));
  tcp().async_read_some(into, std::move(handler));
}

void Transport::write(std::span<const asio::const_buffer> parts, Handler handler) {
  if (isTls()) return state_->tls->write(parts, std::move(handler));
  tcp().async_write_some(Parts(parts.begin(), parts.end()), std::move(handler));
}

void Transport::linger(boost::beast::role_type role, Handler handler) {
  struct Drain : std::enable_shared_from_this<Drain> {
    Drain(const Transport& of, Handler end) : stream(of), handler(std::move(end)) {}

    void endOurSide() {
      error_code ignored;
      stream.socket().shutdown(asio::socket_base::shutdown_send, ignored);
    }
    void read(std::size_t left_bytes) {
      stream.tcp().async_read_some(asio::buffer(scratch), [self = shared_from_this(), left_bytes](
                                                              const error_code& error, std::size_t bytes_count) {
        if (!error && bytes_count < left_bytes) return self->read(left_bytes - bytes_count);
        self->endOurSide();
        self->stream.close();
        self->handler({}, 0);
      });
    }

    Transport stream;
    Handler handler;
    std::array<char, 16 * 1024> scratch;
  };
  const auto drain = std::make_shared<Drain>(*this, std::move(handler));
  expires_after(kLingerTime);
  const bool is_server = role == boost::beast::role_type::server;
  if (isTls()) {
    return state_->tls->stream.async_shutdown([drain, is_server](const error_code&) {
      if (is_server) drain->endOurSide();
      drain->read(kLingerBytes);
    });
  }
  if (is_server) drain->endOurSide();
  drain->read(kLingerBytes);
}

void teardown(boost::beast::role_type role, Transport& stream, error_code& error) {
  websocket::teardown(role, stream.socket(), error);
}

}  // namespace spindrift::net
