// TLS settings: what a server proves itself with, what a client believes, and which versions both speak (1.2 and 1.3,
// with OpenSSL's ciphers at security level 2).
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include <boost/asio/ssl/context.hpp>

#include <spindrift/core/result.h>

namespace spindrift::net {

struct TlsContext {
  /// Reads a chain of certificates (leaf first) and its private key, both PEM. Errors (kUnavailable, kInvalidInput)
  /// name the file and the reason: unreadable, no PEM, a key that belongs to another certificate, a key with a
  /// passphrase.
  static core::Result<std::shared_ptr<TlsContext>> forServer(const std::string& certificate_file,
                                                             const std::string& key_file);
  /// Trusts the system's authorities, and those in `ca_file` (PEM) if it is not empty.
  static core::Result<std::shared_ptr<TlsContext>> forClient(const std::string& ca_file);

  boost::asio::ssl::context context;
  std::chrono::system_clock::time_point expires{};  ///< the first certificate of the chain; servers only
};

}  // namespace spindrift::net
