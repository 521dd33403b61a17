#include "ws_client.h"

#include <algorithm>
#include <cctype>
#include <deque>
#include <utility>

#include <arpa/inet.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

}  // namespace

struct WsClient::Impl {
  asio::io_context io;
  websocket::stream<beast::tcp_stream> ws{io};
  websocket::response_type response;
  beast::flat_buffer buffer;
  std::deque<core::Bytes> inbox;
  int receive_buffer_bytes = 0;
  bool open = false;
  bool reading = false;
  bool closed = false;

  /// Runs pending operations until `done` or the deadline; returns done().
  template <typename Done>
  bool runUntil(Done done, std::chrono::milliseconds timeout) {
    const auto deadline = Clock::now() + timeout;
    io.restart();
    while (!done() && Clock::now() < deadline) {
      if (io.run_one_until(deadline) == 0 && io.stopped()) break;
    }
    return done();
  }

  /// Starts an operation and runs it to its end; false if it fails or does not end in time.
  template <typename Start>
  bool complete(Start start) {
    auto result = std::make_shared<std::optional<error_code>>();
    start([result](const error_code& error, auto&&...) { *result = error; });
    return runUntil([&] { return result->has_value(); }, kPatience) && !**result;
  }

  void startRead() {
    if (reading || !open || closed) return;
    reading = true;
    ws.async_read(buffer, [this](const error_code& error, std::size_t) {
      reading = false;
      if (error) {
        closed = true;
        return;
      }
      const auto* const first = static_cast<const std::uint8_t*>(buffer.data().data());
      inbox.emplace_back(first, first + buffer.size());
      buffer.consume(buffer.size());
    });
  }
};

WsClient::WsClient() : impl_(std::make_unique<Impl>()) {}
WsClient::WsClient(WsClient&& other) noexcept = default;
WsClient& WsClient::operator=(WsClient&& other) noexcept = default;
WsClient::~WsClient() {  // NOLINT(bugprone-exception-escape)
  if (impl_) vanish();
}

void WsClient::setReceiveBuffer(int bytes_count) {
  impl_->receive_buffer_bytes = bytes_count;
}

bool WsClient::connect(const std::string& host, std::uint16_t port, const std::string& target,
                       const std::string& subprotocol) {
  auto& ws = impl_->ws;
  auto& tcp = beast::get_lowest_layer(ws);
  const asio::ip::tcp::endpoint endpoint(asio::ip::make_address(host), port);
  error_code ignored;
  tcp.socket().open(endpoint.protocol(), ignored);
  if (impl_->receive_buffer_bytes > 0) {
    tcp.socket().set_option(asio::socket_base::receive_buffer_size(impl_->receive_buffer_bytes), ignored);
  }
  tcp.socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  if (!impl_->complete([&](auto handler) { tcp.async_connect(endpoint, handler); })) return false;
  ws.set_option(websocket::stream_base::decorator([&subprotocol](websocket::request_type& request) {
    if (!subprotocol.empty()) request.set(beast::http::field::sec_websocket_protocol, subprotocol);
  }));
  ws.read_message_max(0);
  ws.binary(true);
  const std::string name = host + ":" + std::to_string(port);
  impl_->open = impl_->complete([&](auto handler) { ws.async_handshake(impl_->response, name, target, handler); });
  impl_->closed = !impl_->open;
  return impl_->open;
}

unsigned WsClient::handshakeStatus() const {
  return impl_->response.result_int();
}
std::string WsClient::handshakeBody() const {
  return impl_->response.body();
}
std::string WsClient::handshakeHeader(const std::string& name) const {
  return std::string(impl_->response[name]);
}

bool WsClient::sendBinary(core::ByteView message) {
  impl_->ws.binary(true);
  const auto bytes = asio::buffer(message.data(), message.size());
  return !impl_->closed && impl_->complete([&](auto handler) { impl_->ws.async_write(bytes, handler); });
}

bool WsClient::sendText(std::string_view message) {
  impl_->ws.text(true);
  const auto bytes = asio::buffer(message.data(), message.size());
  return !impl_->closed && impl_->complete([&](auto handler) { impl_->ws.async_write(bytes, handler); });
}

bool WsClient::sendPing() {
  return !impl_->closed && impl_->complete([&](auto handler) { impl_->ws.async_ping({}, handler); });
}

std::optional<core::Bytes> WsClient::receive(std::chrono::milliseconds timeout) {
  impl_->startRead();
  impl_->runUntil([this] { return !impl_->inbox.empty() || impl_->closed; }, timeout);
  if (impl_->inbox.empty()) return std::nullopt;
  core::Bytes message = std::move(impl_->inbox.front());
  impl_->inbox.pop_front();
  return message;
}

bool WsClient::waitClosed(std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (!impl_->closed && Clock::now() < deadline) {
    (void)receive(std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()));
  }
  return impl_->closed;
}

bool WsClient::closed() const {
  return impl_->closed;
}
std::uint16_t WsClient::closeCode() const {
  return impl_->ws.reason().code;
}
std::string WsClient::closeReason() const {
  return impl_->ws.reason().reason.c_str();
}

bool WsClient::close(std::uint16_t code) {
  if (impl_->closed) return false;
  const websocket::close_reason reason(static_cast<websocket::close_code>(code));
  const bool done = impl_->complete([&](auto handler) { impl_->ws.async_close(reason, handler); });
  impl_->closed = true;
  return done;
}

void WsClient::vanish() {
  beast::get_lowest_layer(impl_->ws).close();
  impl_->closed = true;
  impl_->io.restart();
  impl_->io.poll();
}

RawTcp::RawTcp(RawTcp&& other) noexcept : socket_(std::exchange(other.socket_, -1)), closed_(other.closed_) {}

RawTcp& RawTcp::operator=(RawTcp&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(closed_, other.closed_);
  return *this;
}

RawTcp::~RawTcp() {
  close();
}

bool RawTcp::connect(const std::string& host, std::uint16_t port) {
  close();
  closed_ = false;
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (socket_ < 0 || ::inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) return false;
  return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

bool RawTcp::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::string RawTcp::receive(std::size_t bytes_count, std::chrono::milliseconds timeout) {
  std::string out;
  const auto deadline = Clock::now() + timeout;
  char chunk[4096];
  while (out.size() < bytes_count && !closed_) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd waiting{socket_, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
    const ssize_t got = ::recv(socket_, chunk, std::min(sizeof chunk, bytes_count - out.size()), 0);
    if (got <= 0) {
      closed_ = true;
    } else {
      out.append(chunk, static_cast<std::size_t>(got));
    }
  }
  return out;
}

std::string RawTcp::receiveUntil(std::string_view mark, std::chrono::milliseconds timeout) {
  std::string out;
  while (!out.ends_with(mark)) {
    const std::string byte = receive(1, timeout);
    if (byte.empty()) break;
    out += byte;
  }
  return out;
}

std::string RawTcp::receiveAll(std::chrono::milliseconds timeout) {
  return receive(static_cast<std::size_t>(-1), timeout);
}

void RawTcp::close() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  closed_ = true;
}

HttpAnswer parseAnswer(const std::string& bytes) {
  HttpAnswer answer;
  const std::size_t end = bytes.find("\r\n\r\n");
  constexpr std::string_view kVersion = "HTTP/1.";
  if (end == std::string::npos || !bytes.starts_with(kVersion)) return answer;
  answer.status = static_cast<unsigned>(std::stoul(bytes.substr(9, 3)));
  std::size_t line = bytes.find("\r\n") + 2;
  while (line < end) {
    const std::size_t line_end = bytes.find("\r\n", line);
    const std::size_t colon = bytes.find(':', line);
    std::string name = bytes.substr(line, colon - line);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::size_t value = bytes.find_first_not_of(' ', colon + 1);
    answer.headers[name] = bytes.substr(value, line_end - value);
    line = line_end + 2;
  }
  answer.body = bytes.substr(end + 4);
  return answer;
}

HttpAnswer httpExchange(std::uint16_t port, std::string_view request_bytes) {
  RawTcp tcp;
  if (!tcp.connect("127.0.0.1", port)) return {};
  (void)tcp.send(request_bytes);  // the server may answer and disconnect before it has read everything
  const std::string bytes = tcp.receiveAll();
  return tcp.closed() ? parseAnswer(bytes) : HttpAnswer{};
}

HttpAnswer httpRequest(std::uint16_t port, const std::string& method, const std::string& target,
                       const std::string& extra_headers, const std::string& body) {
  std::string request = method + " " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + extra_headers;
  if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return httpExchange(port, request + "\r\n" + body);
}

}  // namespace spindrift::test
