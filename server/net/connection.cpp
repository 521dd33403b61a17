// In one file although it has more than 400 lines: every step of a connection shares its deadlines and limits.
#include "connection.h"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>

#include <spindrift/http/network_text.h>

#include "pending_answer.h"
#include "session_place.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

/// Limit of bytes read but not yet parsed: a header and one read. Independent of the parser's own limits.
constexpr std::size_t kReadBufferMaxBytes = 128 * 1024;
/// Limit of unsent bytes in the kernel. The rest of a backlog stays in the outbox, where old frames can be dropped.
constexpr int kUnsentLowWaterBytes = 128 * 1024;
constexpr int kSendBufferBytes = 512 * 1024;
/// A reply may take write_stall_timeout plus its size divided by this rate.
constexpr std::size_t kSlowestBytesPerSecond = 16 * 1024;

/// Sets socket options; failures are ignored, because they only cost speed.
void tune(asio::ip::tcp::socket& socket) {
  boost::system::error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  (void)::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentLowWaterBytes,
                     sizeof kUnsentLowWaterBytes);
}

/// Returns 0.0.0.0 and port 0 for a peer that has left already.
asio::ip::tcp::endpoint peerOf(const asio::ip::tcp::socket& socket) {
  boost::system::error_code error;
  const auto endpoint = socket.remote_endpoint(error);
  return error ? asio::ip::tcp::endpoint() : asio::ip::tcp::endpoint(unmapped(endpoint.address()), endpoint.port());
}

std::string nameOf(const asio::ip::tcp::endpoint& peer) {
  return peer.address().to_string() + ":" + std::to_string(peer.port());
}

template <typename Fields>
void fillHead(Fields& response, const Reply& reply, bool keep_alive, const ServerOptions& options) {
  response.set(http::field::server, "Spindrift");
  const std::span<const std::string> parents = options.embedding_origins;
  for (const auto& [name, value] : securityHeaders(reply.is_embeddable ? parents : parents.first(0))) {
    response.set(name, value);
  }
  for (const auto& [name, value] : reply.headers) response.set(name, value);
  // RFC 9110 section 8.6: no length and no type for statuses that never have content.
  if (reply.status != 304 && reply.status != 204) {
    response.set(http::field::content_type, reply.content_type);
    response.content_length(reply.body->size());
  }
  response.keep_alive(keep_alive);
}

}  // namespace

Connection::Connection(std::uint64_t id, asio::ip::tcp::socket socket, ServerContext& context)
    : id_(id),
      context_(context),
      strand_(socket.get_executor()),
      endpoint_(peerOf(socket)),
      is_by_proxy_(context.proxies.contains(endpoint_.address())),
      peer_(nameOf(endpoint_)),
      address_(limitKey(endpoint_.address())),
      stream_(std::move(socket)),
      buffer_(kReadBufferMaxBytes) {
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
    } else if (self->pending_) {
      self->pending_->cancel();  // run() tells the client
    } else if (!self->is_sending_) {
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
      if (self->pending_) self->pending_->cancel();
    }
  });
}

asio::awaitable<void> Connection::run() {
  if (context_.credentials) {
    const bool is_secure = co_await secure();
    if (!is_secure) co_return;
  }
  while (!stopping_) {
    RequestParser parser;
    const bool is_accepted = co_await read(parser);
    if (!is_accepted) co_return;
    if (beast::websocket::is_upgrade(parser.get())) {
      co_await upgrade(parser.get());
      co_return;
    }
    const auto& request = parser.get();
    auto routed = routeRequest(request, context_.files);
    Reply reply;
    if (isPreflight(request)) {
      reply = preflightReply();
    } else if (auto* target = std::get_if<RequestTarget>(&routed)) {
      reply = co_await ask(questionOf(request, *std::move(target), peer_));
    } else {
      reply = std::get<Reply>(std::move(routed));
    }
    const bool keep_alive = request.keep_alive() && !stopping_ && context_.retry_after_s == 0;
    reply = fitted(request, std::move(reply));
    const bool sent = co_await send(reply, request.method() == http::verb::head, request.version(), keep_alive);
    if (!sent || !keep_alive) break;
  }
  (void)co_await stream_.async_linger(kToken);
}

asio::awaitable<bool> Connection::read(RequestParser& parser) {
  bound(parser, context_.options.request_body_max_bytes);
  // One deadline for the whole request: single bytes do not extend it.
  stream_.expires_after(context_.options.handshake_timeout);
  auto [error, bytes_count] = co_await http::async_read_header(stream_, buffer_, parser, kToken);
  auto refusal = error ? std::nullopt : refuseHead(parser);
  if (!error && !refusal) refusal = identify(parser.get());
  if (!error && !refusal) {
    // Before the body, so that a client that waits for "100 Continue" need not send it.
    if (auto reply = refuseAny(parser.get())) {
      co_await sendLast(fitted(parser.get(), *std::move(reply)), parser.get().method() == http::verb::head);
      co_return false;
    }
    if (expectsContinue(parser.get()) && !parser.is_done() && buffer_.size() == 0) {
      constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
      std::tie(error, bytes_count) = co_await asio::async_write(stream_, asio::buffer(kContinue), kToken);
    }
    if (!error) std::tie(error, bytes_count) = co_await http::async_read(stream_, buffer_, parser, kToken);
  }
  if (error) {
    spdlog::debug("{}: incomplete request: {}", peer_, error.message());
    refusal = replyToBadRequest(error, context_.options.request_body_max_bytes);
  }
  if (refusal) {
    context_.counters.refused(Refused::kRequest);
    co_await sendLast(fitted(parser.get(), *std::move(refusal)), false);
    co_return false;
  }
  co_return !error;
}

asio::awaitable<bool> Connection::secure() {
  constexpr std::uint8_t kHandshakeRecord = 0x16;  // RFC 8446 section 5.1: the first byte of every TLS connection
  if (!is_by_proxy_ && !context_.addresses.takeRequest(address_, Clock::now())) {
    context_.counters.refused(Refused::kRate);  // a handshake costs more than a request
    stream_.close();
    co_return false;
  }
  std::array<std::uint8_t, 1> first{};
  // One deadline for the whole handshake: single bytes do not extend it.
  stream_.expires_after(context_.options.handshake_timeout);
  auto [error, bytes_count] = co_await stream_.async_read_some(asio::buffer(first), kToken);
  if (error) {
    // Probes of the port open a connection and close it without a byte; they are not failures.
    if (error != asio::error::eof) context_.counters.add(&ServerStats::failed_tls_handshake_count);
    co_return false;
  }
  if (first[0] != kHandshakeRecord) {
    context_.counters.add(&ServerStats::failed_tls_handshake_count);
    if (first[0] >= 'A' && first[0] <= 'Z') {
      co_await sendLast(textReply(400, "This port speaks TLS: use https:// and wss://."), false);
    }
    co_return false;
  }
  stream_.useServerTls(*context_.credentials->context());
  std::tie(error, std::ignore) = co_await stream_.async_handshake(asio::buffer(first), kToken);
  if (error) {
    context_.counters.add(&ServerStats::failed_tls_handshake_count);
    spdlog::debug("{}: the TLS handshake failed: {}", peer_, error.message());
    stream_.close();
    co_return false;
  }
  context_.counters.add(&ServerStats::tls_handshake_count);
  co_return true;
}

Reply Connection::fitted(const Request& request, Reply reply) const {
  if (!isApiTarget(request.target())) return reply;
  reply = asProblem(std::move(reply));
  reply.headers.emplace_back("Vary", "Origin");
  const std::string_view origin = request[http::field::origin];
  if (!origin.empty() && isOriginListed(origin, context_.options.allowed_origins)) allowOrigin(reply, origin);
  return reply;
}

bool Connection::isPreflight(const Request& request) const {
  return request.method() == http::verb::options && request.count(http::field::access_control_request_method) > 0 &&
         isApiTarget(request.target()) &&
         isOriginListed(request[http::field::origin], context_.options.allowed_origins);
}

std::optional<Reply> Connection::identify(const Request& request) {
  if (!is_by_proxy_) return std::nullopt;
  // A proxy may send the requests of several clients through one connection.
  peer_ = nameOf(endpoint_);
  address_ = limitKey(endpoint_.address());
  std::vector<std::string_view> lines;
  const auto [first, end] = request.equal_range("X-Forwarded-For");
  for (auto line = first; line != end; ++line) lines.emplace_back(line->value());
  const auto client = forwardedClient(lines, context_.proxies);
  if (!client) {
    spdlog::debug("{}: {}", peer_, client.error().message);
    return textReply(400, client.error().message);
  }
  if (*client) {
    peer_ = (*client)->to_string() + " by " + nameOf(endpoint_);
    address_ = limitKey(**client);
  }
  return std::nullopt;
}

std::optional<Reply> Connection::refuseAny(const Request& request) {
  if (!context_.addresses.takeRequest(address_, Clock::now())) {
    context_.counters.refused(Refused::kRate);
    return retryReply(429, "Too many requests from your address: slow down.");
  }
  // Any page may read what is public; only allowed Origins may send commands or open a stream.
  const bool acts = request.method() != http::verb::get && request.method() != http::verb::head;
  if (!acts && !beast::websocket::is_upgrade(request)) return std::nullopt;
  const std::string_view origin = request[http::field::origin];
  if (isOriginAllowed(origin, request[http::field::host], context_.listens_on_loopback,
                      context_.options.allowed_origins)) {
    return std::nullopt;
  }
  context_.counters.refused(Refused::kOrigin);
  return textReply(403, "Pages of this origin may not act here: start the server with --origin " + printable(origin) +
                            " to allow them.");
}

asio::awaitable<Reply> Connection::ask(const HttpRequest& request) {
  constexpr const char* kFailed = "The server failed on this request; its log says why.";
  PendingAnswer pending(strand_);
  try {
    context_.application.httpRequest(request, pending.responder());
  } catch (const std::exception& error) {
    spdlog::error("{} {} failed: {}", request.method, request.path, error.what());
    co_return textReply(500, kFailed);
  }
  pending_ = &pending;
  PendingAnswer::Outcome outcome = co_await pending.wait(context_.options.answer_timeout);
  pending_ = nullptr;
  switch (outcome.end) {
    case PendingAnswer::End::kAnswered:
      co_return applicationReply(request.path, std::move(outcome.reply));
    case PendingAnswer::End::kDropped:
      spdlog::error("{} {} was never answered", request.method, request.path);
      co_return textReply(500, kFailed);
    case PendingAnswer::End::kCancelled:
      co_return retryReply(503, "The server ends before it has the answer; what was asked for may have been done.");
    case PendingAnswer::End::kTimeout:
      break;
  }
  co_return textReply(504, "The server did not answer in time; what was asked for may still happen.");
}

asio::awaitable<void> Connection::upgrade(const Request& request) {
  if (const std::int64_t retry_after_s = context_.retry_after_s; retry_after_s > 0) {
    context_.counters.refused(Refused::kDraining);
    const std::string line = "The server is about to end: try again in " + std::to_string(retry_after_s) + " s.";
    co_await sendLast(retryReply(503, line, retry_after_s), false);
    co_return;
  }
  SessionPlace place(context_, address_);
  UpgradeDecision decision;
  Refused why = Refused::kFull;
  const std::string max_count = std::to_string(context_.options.max_session_count);
  if (place.isInShare()) {
    decision = decideUpgrade(request, buffer_.size(), context_.options.foxglove_session_max_count > 0,
                             [this](const std::string& room) { return context_.application.acceptSession(room); });
    why = decision.is_room_refused ? Refused::kRoom : Refused::kHandshake;
    if (decision.is_foxglove && !decision.refusal && !place.takeFoxglove()) {
      why = Refused::kFull;
      decision.refusal =
          textReply(503, "The server has " + std::to_string(context_.options.foxglove_session_max_count) +
                             " sessions of Foxglove open, their limit: close one, or try again later.");
    }
  } else if (place.isFree()) {
    decision.refusal = textReply(503, "Your address has " + std::to_string(context_.addresses.sessionMaxCount()) +
                                          " of this server's " + max_count +
                                          " sessions open, the limit of one address: close one, or try again later.");
  } else {
    decision.refusal = textReply(503, "The server is full: " + max_count + " sessions are open; try again later.");
  }
  if (decision.refusal) {
    context_.counters.refused(why);
    co_await sendLast(std::move(*decision.refusal), false);
    co_return;
  }
  session_ = std::make_shared<Session>(std::move(stream_), context_);
  if (stopping_) session_->close(CloseCode::kGoingAway, "server is shutting down");
  SessionOpening opening{std::move(decision.room), peer_, decision.is_onlooker, std::move(decision.subprotocol),
                         std::move(decision.token)};
  co_await session_->run(request, std::move(opening), address_);
}

asio::awaitable<bool> Connection::send(const Reply& reply, bool head_only, unsigned version, bool keep_alive) {
  const auto status = static_cast<http::status>(reply.status);
  stream_.expires_after(context_.options.write_stall_timeout +
                        std::chrono::seconds(reply.body->size() / kSlowestBytesPerSecond));
  is_sending_ = true;
  boost::system::error_code error;
  if (head_only || reply.status == 304) {
    http::response<http::empty_body> response(status, version);
    fillHead(response, reply, keep_alive, context_.options);
    std::tie(error, std::ignore) = co_await http::async_write(stream_, response, kToken);
  } else {
    http::response<http::span_body<const char>> response(status, version);
    response.body() = beast::span<const char>(reply.body->data(), reply.body->size());
    fillHead(response, reply, keep_alive, context_.options);
    std::tie(error, std::ignore) = co_await http::async_write(stream_, response, kToken);
  }
  is_sending_ = false;
  if (error) spdlog::debug("{}: the reply could not be sent: {}", peer_, error.message());
  co_return !error;
}

asio::awaitable<void> Connection::sendLast(Reply reply, bool head_only) {
  constexpr unsigned kHttp11 = 11;
  const bool sent = co_await send(reply, head_only, kHttp11, false);
  if (sent) (void)co_await stream_.async_linger(kToken);
}

}  // namespace spindrift::net
