#include "connection.h"

#include <array>
#include <optional>
#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include "url.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr auto kToken = asio::as_tuple(asio::use_awaitable);

constexpr std::uint32_t kHeaderMaxBytes = 16 * 1024;
/// The kernel takes this much from us ahead of the wire; the rest of a backlog stays in the outbox, where it is
/// dropped.
constexpr int kUnsentLowWaterBytes = 128 * 1024;
constexpr int kSendBufferBytes = 512 * 1024;
/// A page is given a write_stall_timeout plus the time that this rate takes.
constexpr std::size_t kSlowestBytesPerSecond = 16 * 1024;
/// How long and how much of a refused request is read away, so that closing does not reset the reply.
constexpr std::chrono::seconds kLingerTime{1};
constexpr std::size_t kLingerBytes = 256 * 1024;

/// Best effort: each of these only tunes.
void tune(asio::ip::tcp::socket& socket) {
  boost::system::error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  using UnsentLowWater = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
  socket.set_option(UnsentLowWater(kUnsentLowWaterBytes), ignored);
}

std::string peerName(const asio::ip::tcp::socket& socket) {
  boost::system::error_code error;
  const auto endpoint = socket.remote_endpoint(error);
  return error ? "a peer that left" : endpoint.address().to_string() + ":" + std::to_string(endpoint.port());
}

template <typename Fields>
void fillHead(Fields& response, const Reply& reply, bool keep_alive) {
  response.set(http::field::server, "Spindrift");
  for (const auto& [name, value] : securityHeaders()) response.set(name, value);
  for (const auto& [name, value] : reply.headers) response.set(name, value);
  if (reply.status != 304) {
    response.set(http::field::content_type, reply.content_type);
    response.content_length(reply.body->size());
  }
  response.keep_alive(keep_alive);
}

/// What a request that Beast's parser refused gets; nullopt if there is nobody to answer.
std::optional<Reply> replyToBadRequest(const boost::system::error_code& error, std::size_t body_max_bytes) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return textReply(431, "The request's header is larger than " + std::to_string(kHeaderMaxBytes) + " bytes.");
  }
  if (error == http::error::body_limit) {
    return textReply(413, "The request's body is larger than " + std::to_string(body_max_bytes) + " bytes.");
  }
  if (error == http::error::end_of_stream || error == http::error::partial_message) return std::nullopt;
  if (error.category() == make_error_code(http::error::bad_method).category()) {
    return textReply(400, "This is not an HTTP request: " + error.message() + ".");
  }
  return std::nullopt;
}

}  // namespace

Connection::Connection(std::uint64_t id, asio::ip::tcp::socket socket, ServerContext& context)
    : id_(id), context_(context), strand_(socket.get_executor()), peer_(peerName(socket)), stream_(std::move(socket)) {
  tune(stream_.socket());
}

void Connection::start() {
  asio::co_spawn(strand_, run(), [self = shared_from_this()](const std::exception_ptr& failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      spdlog::error("{}: the connection failed: {}", self->peer_, error.what());
    }
    self->context_.connections.remove(self->id_);
  });
}

void Connection::shutDown() {
  asio::post(strand_, [self = shared_from_this()] {
    self->stopping_ = true;
    if (self->session_) {
      self->session_->close(CloseCode::kGoingAway, "server is shutting down");
    } else {
      self->stream_.close();
    }
  });
}

void Connection::cut() {
  asio::post(strand_, [self = shared_from_this()] {
    if (self->session_) {
      self->session_->cut();
    } else {
      self->stream_.close();
    }
  });
}

asio::awaitable<void> Connection::run() {
  while (!stopping_) {
    http::request_parser<http::string_body> parser;
    parser.header_limit(kHeaderMaxBytes);
    parser.body_limit(context_.options.request_body_max_bytes);
    // One deadline for the whole request: a byte now and then does not extend it.
    stream_.expires_after(context_.options.handshake_timeout);
    const auto [error, bytes_count] = co_await http::async_read(stream_, buffer_, parser, kToken);
    if (error) {
      spdlog::debug("{}: no whole request: {}", peer_, error.message());
      auto reply = replyToBadRequest(error, context_.options.request_body_max_bytes);
      if (reply) co_await sendLast(std::move(*reply), false);
      co_return;
    }
    if (beast::websocket::is_upgrade(parser.get())) {
      co_await upgrade(parser.get());
      co_return;
    }
    const auto& request = parser.get();
    const RequestHead head{std::string(request.method_string()), std::string(request.target()),
                           std::string(request[http::field::if_none_match])};
    const std::string& body = request.body();
    const core::ByteView body_view(reinterpret_cast<const std::uint8_t*>(body.data()), body.size());
    const Reply reply = routeRequest(head, body_view, context_.files, context_.application);
    const bool keep_alive = request.keep_alive() && !stopping_;
    const bool sent = co_await send(reply, head.method == "HEAD", request.version(), keep_alive);
    if (!sent || !keep_alive) break;
  }
  boost::system::error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

asio::awaitable<void> Connection::upgrade(const UpgradeRequest& request) {
  // Reserved before the handshake, so that a crowd of handshakes cannot pass the bound together.
  struct Place {
    ServerContext& context;
    const bool granted;
    explicit Place(ServerContext& shared)
        : context(shared), granted(++shared.reserved_session_count <= shared.options.max_session_count) {}
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    ~Place() { --context.reserved_session_count; }
  };
  const Place place(context_);
  std::string room;
  bool echo_subprotocol = false;
  auto refusal = place.granted ? refuseUpgrade(request, room, echo_subprotocol)
                               : std::make_unique<Reply>(textReply(
                                     503, "The server is full: " + std::to_string(context_.options.max_session_count) +
                                              " sessions are open; try again later."));
  if (refusal) {
    co_await sendLast(std::move(*refusal), false);
    co_return;
  }
  session_ = std::make_shared<Session>(std::move(stream_), context_);
  if (stopping_) session_->close(CloseCode::kGoingAway, "server is shutting down");
  co_await session_->run(request, std::move(room), peer_, echo_subprotocol);
}

std::unique_ptr<Reply> Connection::refuseUpgrade(const UpgradeRequest& request, std::string& room,
                                                 bool& echo_subprotocol) {
  // RFC 6455 section 4.1: the client waits for the answer. The bytes would get lost between the two protocols.
  if (buffer_.size() > 0) {
    return std::make_unique<Reply>(textReply(400, "Nothing may follow an upgrade request before it is answered."));
  }
  const auto target = parseTarget(std::string_view(request.target().data(), request.target().size()));
  if (!target) return std::make_unique<Reply>(textReply(400, "The request's path is not a plain absolute path."));
  auto named = roomOfPath(target->path);
  if (!named) {
    return std::make_unique<Reply>(
        textReply(404, "There is no WebSocket at " + target->path + ": use /ws or /ws/ROOM."));
  }
  room = std::move(*named);

  const auto offered = request[http::field::sec_websocket_protocol];
  for (const auto& protocol : http::token_list(offered)) echo_subprotocol |= protocol == kSubprotocol;
  if (!offered.empty() && !echo_subprotocol) {
    return std::make_unique<Reply>(
        textReply(400, std::string("No offered subprotocol is known here: offer ") + kSubprotocol + "."));
  }
  try {
    const core::Result<void> accepted = context_.application.acceptSession(room);
    if (!accepted) return std::make_unique<Reply>(textReply(404, accepted.error().message));
  } catch (const std::exception& error) {
    spdlog::error("{}: acceptSession failed: {}", peer_, error.what());
    return std::make_unique<Reply>(textReply(500, "The server failed on this request; its log says why."));
  }
  return nullptr;
}

asio::awaitable<bool> Connection::send(const Reply& reply, bool head_only, unsigned version, bool keep_alive) {
  const auto status = static_cast<http::status>(reply.status);
  stream_.expires_after(context_.options.write_stall_timeout +
                        std::chrono::seconds(reply.body->size() / kSlowestBytesPerSecond));
  boost::system::error_code error;
  if (head_only || reply.status == 304) {
    http::response<http::empty_body> response(status, version);
    fillHead(response, reply, keep_alive);
    std::tie(error, std::ignore) = co_await http::async_write(stream_, response, kToken);
  } else {
    http::response<http::span_body<const char>> response(status, version);
    response.body() = beast::span<const char>(reply.body->data(), reply.body->size());
    fillHead(response, reply, keep_alive);
    std::tie(error, std::ignore) = co_await http::async_write(stream_, response, kToken);
  }
  if (error) spdlog::debug("{}: the reply did not go through: {}", peer_, error.message());
  co_return !error;
}

asio::awaitable<void> Connection::sendLast(Reply reply, bool head_only) {
  constexpr unsigned kHttp11 = 11;
  const bool sent = co_await send(reply, head_only, kHttp11, false);
  if (!sent) co_return;
  boost::system::error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  std::array<char, 4096> scratch;
  stream_.expires_after(kLingerTime);
  for (std::size_t read_bytes = 0; read_bytes < kLingerBytes;) {
    const auto [error, bytes_count] = co_await stream_.async_read_some(asio::buffer(scratch), kToken);
    if (error) co_return;
    read_bytes += bytes_count;
  }
}

}  // namespace spindrift::net
