#include "tls_context.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <string_view>
#include <utility>

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <spindrift/core/files.h>

namespace spindrift::net {
namespace {

namespace ssl = boost::asio::ssl;

constexpr int kSecurityLevel = 2;  // RSA keys of 2048 bits, 112 bits of security: OpenSSL's SSL_CTX_set_security_level

/// Empties OpenSSL's queue of errors of this thread and returns the first one, the cause.
std::string opensslReason() {
  const unsigned long first = ERR_get_error();
  ERR_clear_error();
  const char* const reason = first == 0 ? nullptr : ERR_reason_error_string(first);
  return reason != nullptr ? reason : "unknown reason";
}

using core::invalid;

core::Result<std::string> readPem(const std::string& option, const std::string& file) {
  constexpr std::size_t kPemMaxBytes = 4u << 20;
  auto text = core::readText(file, kPemMaxBytes, "a PEM file", "is it the right file?");
  if (text) return text;
  return core::Error{text.error().code, option + " " + file + ": " + text.error().message};
}

/// Returns why Asio could not use a PEM text: `error`, or what it left in OpenSSL's queue, which says more.
std::string reasonOf(const boost::system::error_code& error) {
  return ERR_peek_error() != 0 ? opensslReason() : error.message();
}

/// RFC 7301. A client that offers no protocol is served as well; one that offers others only is refused.
int chooseProtocol(SSL* /*connection*/, const unsigned char** out, unsigned char* out_length,
                   const unsigned char* offered, unsigned offered_length, void* /*nothing*/) {
  static constexpr std::array<unsigned char, 9> kHttp11{8, 'h', 't', 't', 'p', '/', '1', '.', '1'};
  unsigned char* chosen = nullptr;
  const int result =
      SSL_select_next_proto(&chosen, out_length, kHttp11.data(), kHttp11.size(), offered, offered_length);
  if (result != OPENSSL_NPN_NEGOTIATED) return SSL_TLSEXT_ERR_ALERT_FATAL;
  *out = chosen;
  return SSL_TLSEXT_ERR_OK;
}

void setVersions(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_security_level(context, kSecurityLevel);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  // Sessions resume by tickets, which the clients keep; nothing is remembered here.
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
}

std::chrono::system_clock::time_point endOf(const X509* certificate) {
  std::tm end{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end) != 1) return {};
  return std::chrono::system_clock::from_time_t(timegm(&end));
}

/// The first end of all certificates: clients need the whole chain.
std::chrono::system_clock::time_point firstEnd(SSL_CTX* context) {
  auto end = endOf(SSL_CTX_get0_certificate(context));
  STACK_OF(X509)* chain = nullptr;
  if (SSL_CTX_get_extra_chain_certs(context, &chain) != 1 || chain == nullptr) return end;
  for (int k = 0; k < sk_X509_num(chain); ++k) end = std::min(end, endOf(sk_X509_value(chain, k)));
  return end;
}

void warnAboutKey(const std::string& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) == 0 && (facts.st_mode & S_IROTH) != 0) {
    spdlog::warn("--tls-key {}: every user of this machine can read the private key; chmod o-r {}", file, file);
  }
}

}  // namespace

core::Result<std::shared_ptr<TlsContext>> TlsContext::forServer(const std::string& certificate_file,
                                                                const std::string& key_file) {
  const auto certificates = readPem("--tls-cert", certificate_file);
  if (!certificates) return certificates.error();
  const auto key = readPem("--tls-key", key_file);
  if (!key) return key.error();
  auto out = std::make_shared<TlsContext>(TlsContext{.context = ssl::context(ssl::context::tls_server)});
  SSL_CTX* const context = out->context.native_handle();
  setVersions(context);
  SSL_CTX_set_alpn_select_cb(context, chooseProtocol, nullptr);
  // Without this function OpenSSL asks at the terminal. The context keeps it.
  const auto is_asked = std::make_shared<bool>(false);
  out->context.set_password_callback([is_asked](std::size_t, ssl::context::password_purpose) {
    *is_asked = true;
    return std::string();
  });
  boost::system::error_code error;
  out->context.use_certificate_chain(boost::asio::buffer(*certificates), error);
  if (error) {
    return invalid("--tls-cert " + certificate_file + ": " + reasonOf(error) +
                   "; give a chain of certificates in PEM form, the server's own first");
  }
  out->context.use_private_key(boost::asio::buffer(*key), ssl::context::pem, error);
  if (error) {
    const std::string reason = error.message();
    ERR_clear_error();
    if (*is_asked) return invalid("--tls-key " + key_file + ": the key has a passphrase; give one without");
    return invalid("--tls-key " + key_file + ": " + reason + "; give the private key of " + certificate_file +
                   " in PEM form");
  }
  if (SSL_CTX_check_private_key(context) != 1) {
    return invalid("--tls-key " + key_file + ": " + opensslReason() + "; the key does not belong to " +
                   certificate_file);
  }
  warnAboutKey(key_file);
  out->expires = firstEnd(context);
  return out;
}

core::Result<std::shared_ptr<TlsContext>> TlsContext::forClient(const std::string& ca_file) {
  auto out = std::make_shared<TlsContext>(TlsContext{.context = ssl::context(ssl::context::tls_client)});
  SSL_CTX* const context = out->context.native_handle();
  setVersions(context);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER, nullptr);
  ERR_clear_error();
  SSL_CTX_set_default_verify_paths(
      context);  // it has no authorities where the system has none; then only ca_file counts
  ERR_clear_error();
  if (ca_file.empty()) return out;
  const auto authorities = readPem("--tls-ca", ca_file);
  if (!authorities) return authorities.error();
  boost::system::error_code error;
  out->context.add_certificate_authority(boost::asio::buffer(*authorities), error);
  if (error) {
    return invalid("--tls-ca " + ca_file + ": " + reasonOf(error) + "; give certificates of authorities in PEM form");
  }
  return out;
}

}  // namespace spindrift::net
