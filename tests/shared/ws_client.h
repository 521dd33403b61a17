// Blocking network clients for tests: a WebSocket client that runs only inside its calls (without a receive call it
// really does not read), a raw TCP client, and a plain HTTP request. Link spindrift::ws_client.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <spindrift/core/bytes.h>

namespace spindrift::test {

/// Long enough for a loaded machine; only failing tests reach it.
inline constexpr std::chrono::milliseconds kPatience{60'000};

class WsClient {
 public:
  WsClient();
  WsClient(WsClient&& other) noexcept;
  WsClient& operator=(WsClient&& other) noexcept;
  // NOLINTNEXTLINE(bugprone-exception-escape): ends the test
  ~WsClient();  ///< hangs up without a goodbye if still open

  /// Size of the kernel's buffer for unread bytes; 0 = the system's choice. Set it before connect().
  void setReceiveBuffer(int bytes_count);

  /// False if refused; the handshake* functions then return the details. An empty subprotocol offers none.
  bool connect(const std::string& host, std::uint16_t port, const std::string& target = "/ws",
               const std::string& subprotocol = "spindrift.v1");
  unsigned handshakeStatus() const;  ///< 101 = upgraded, 0 = no answer
  std::string handshakeBody() const;
  std::string handshakeHeader(const std::string& name) const;

  /// False if the connection is gone or the peer reads nothing for kPatience.
  bool sendBinary(core::ByteView message);
  bool sendText(std::string_view message);
  bool sendPing();

  /// Returns the next whole message; nullopt after `timeout` or once closed. Answers pings meanwhile.
  std::optional<core::Bytes> receive(std::chrono::milliseconds timeout = kPatience);
  /// Receives and drops messages until the connection is closed; false after `timeout`.
  bool waitClosed(std::chrono::milliseconds timeout = kPatience);

  bool closed() const;
  std::uint16_t closeCode() const;  ///< from the peer's close frame; 0 if there was none
  std::string closeReason() const;

  /// Performs the closing handshake. False if the peer does not take part.
  bool close(std::uint16_t code = 1000);
  /// Closes the TCP connection without a close frame.
  void vanish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class RawTcp {
 public:
  RawTcp() = default;
  RawTcp(RawTcp&& other) noexcept;
  RawTcp& operator=(RawTcp&& other) noexcept;
  ~RawTcp();

  bool connect(const std::string& host, std::uint16_t port);
  /// False if the peer has disconnected.
  bool send(std::string_view bytes);
  /// Reads until `bytes_count` bytes are there, the peer disconnects (then closed()), or `timeout`.
  std::string receive(std::size_t bytes_count, std::chrono::milliseconds timeout = kPatience);
  /// Reads up to and including `mark`; less if the peer disconnects or sends nothing for `timeout`.
  std::string receiveUntil(std::string_view mark, std::chrono::milliseconds timeout = kPatience);
  /// Reads everything until the peer disconnects; check closed().
  std::string receiveAll(std::chrono::milliseconds timeout = kPatience);
  bool closed() const { return closed_; }
  void close();

 private:
  int socket_ = -1;
  bool closed_ = false;
};

struct HttpAnswer {
  unsigned status = 0;                         ///< 0 = no HTTP answer
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;                            ///< as many bytes as followed the header
};

/// Parses the bytes of one whole response.
HttpAnswer parseAnswer(const std::string& bytes);

/// Sends the bytes unchanged on a new connection and reads until the server disconnects.
HttpAnswer httpExchange(std::uint16_t port, std::string_view request_bytes);

/// `METHOD target` with "Connection: close" and `extra_headers` (each line ended by CRLF).
HttpAnswer httpRequest(std::uint16_t port, const std::string& method, const std::string& target,
                       const std::string& extra_headers = "", const std::string& body = "");

}  // namespace spindrift::test
