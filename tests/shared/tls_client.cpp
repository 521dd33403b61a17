#include "tls_client.h"

#include <csignal>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::test {

struct TlsTcp::Impl {
  int socket = -1;
  SSL_CTX* context = nullptr;
  SSL* ssl = nullptr;
  std::string error;

  ~Impl() {
    SSL_free(ssl);
    SSL_CTX_free(context);
    if (socket >= 0) ::close(socket);
  }
};

TlsTcp::TlsTcp() : impl_(std::make_unique<Impl>()) {}
TlsTcp::TlsTcp(TlsTcp&& other) noexcept = default;
TlsTcp& TlsTcp::operator=(TlsTcp&& other) noexcept = default;
TlsTcp::~TlsTcp() = default;

bool TlsTcp::connect(std::uint16_t port, const TlsWish& wish) {
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to its socket without MSG_NOSIGNAL
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  impl_->socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  timeval patience{.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(kPatience).count(), .tv_usec = 0};
  ::setsockopt(impl_->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (::connect(impl_->socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return false;
  impl_->context = SSL_CTX_new(TLS_client_method());
  if (wish.version_max == "1.1" || wish.version_max == "1.2") {
    SSL_CTX_set_security_level(impl_->context, 0);  // otherwise 1.1 is not even offered
    SSL_CTX_set_min_proto_version(impl_->context, TLS1_VERSION);
    SSL_CTX_set_max_proto_version(impl_->context, wish.version_max == "1.1" ? TLS1_1_VERSION : TLS1_2_VERSION);
  }
  impl_->ssl = SSL_new(impl_->context);
  if (!wish.protocols.empty()) {
    const std::string list = static_cast<char>(wish.protocols.size()) + wish.protocols;
    SSL_set_alpn_protos(impl_->ssl, reinterpret_cast<const unsigned char*>(list.data()),
                        static_cast<unsigned>(list.size()));
  }
  SSL_set_fd(impl_->ssl, impl_->socket);
  ERR_clear_error();
  if (SSL_connect(impl_->ssl) == 1) return true;
  const char* const reason = ERR_reason_error_string(ERR_get_error());
  impl_->error = reason != nullptr ? reason : "the connection ended";
  return false;
}

const std::string& TlsTcp::error() const {
  return impl_->error;
}

std::string TlsTcp::version() const {
  return SSL_get_version(impl_->ssl);
}

std::string TlsTcp::protocol() const {
  const unsigned char* name = nullptr;
  unsigned size = 0;
  SSL_get0_alpn_selected(impl_->ssl, &name, &size);
  return {reinterpret_cast<const char*>(name), size};
}

std::string TlsTcp::certificateName() const {
  char name[256] = "";
  X509* const certificate = SSL_get0_peer_certificate(impl_->ssl);
  X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, name, sizeof name);
  return name;
}

bool TlsTcp::send(std::string_view bytes) {
  return SSL_write(impl_->ssl, bytes.data(), static_cast<int>(bytes.size())) == static_cast<int>(bytes.size());
}

std::string TlsTcp::receiveUntil(std::string_view mark) {
  std::string out;
  char byte = 0;
  while (!out.ends_with(mark) && SSL_read(impl_->ssl, &byte, 1) == 1) out.push_back(byte);
  return out;
}

std::string TlsTcp::receiveAll(bool* was_closed) {
  std::string out;
  char bytes[4096];
  int count = 0;
  while ((count = SSL_read(impl_->ssl, bytes, sizeof bytes)) > 0) out.append(bytes, static_cast<std::size_t>(count));
  if (was_closed != nullptr) *was_closed = SSL_get_error(impl_->ssl, count) == SSL_ERROR_ZERO_RETURN;
  return out;
}

HttpAnswer tlsRequest(std::uint16_t port, const std::string& method, const std::string& target) {
  TlsTcp client;
  if (!client.connect(port) ||
      !client.send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")) {
    return {};
  }
  return parseAnswer(client.receiveAll());
}

}  // namespace spindrift::test
