// A blocking TLS client for tests, on a raw TCP connection to 127.0.0.1. Link spindrift::tls_client.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "ws_client.h"

namespace spindrift::test {

struct TlsWish {
  std::string version_max{};  ///< "1.1", "1.2"; empty: the newest
  std::string protocols{};    ///< ALPN, one name; empty: not offered
};

class TlsTcp {
 public:
  TlsTcp();
  TlsTcp(TlsTcp&& other) noexcept;
  TlsTcp& operator=(TlsTcp&& other) noexcept;
  ~TlsTcp();

  /// Connects and makes the handshake; the server's certificate is not checked. False if it fails: see error().
  bool connect(std::uint16_t port, const TlsWish& wish = {});
  [[nodiscard]] const std::string& error() const;     ///< OpenSSL's words for the failed handshake
  [[nodiscard]] std::string version() const;          ///< "TLSv1.3"
  [[nodiscard]] std::string protocol() const;         ///< chosen by ALPN; empty: none
  [[nodiscard]] std::string certificateName() const;  ///< CN of the server's certificate

  bool send(std::string_view bytes);
  std::string receiveUntil(std::string_view mark);
  /// Reads until the peer ends the connection; was_closed: by close_notify and not by a cut.
  std::string receiveAll(bool* was_closed = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// `METHOD target` with "Connection: close" over TLS.
HttpAnswer tlsRequest(std::uint16_t port, const std::string& method, const std::string& target);

}  // namespace spindrift::test
