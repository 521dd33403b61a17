#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <utility>

#include <boost/beast/http/error.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/http/request.h>

namespace spindrift::net {

namespace beast = boost::beast;
namespace http = boost::beast::http;

void bound(RequestParser& parser, std::size_t body_max_bytes) {
  parser.header_limit(kHeaderMaxBytes);
  parser.body_limit(body_max_bytes);
}

namespace {

constexpr unsigned kHttp11 = 11;

/// Headers that may occur once. If one is repeated, a proxy could read the request differently (request smuggling).
constexpr std::array kSingleFields{http::field::host,
                                   http::field::origin,
                                   http::field::authorization,
                                   http::field::content_type,
                                   http::field::sec_websocket_key,
                                   http::field::sec_websocket_version};

/// RFC 9112 section 3.2: a host with an optional port, in the characters of RFC 3986 section 3.2.2. Empty is allowed.
bool isHost(std::string_view host) {
  constexpr std::string_view kMarks = "-._~%!$&'()*+,;=:[]";
  return std::ranges::all_of(host, [&](unsigned char c) {
    return (std::isalnum(c) != 0 && c < 0x80) || kMarks.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

/// RFC 9112 section 3.2.2: a request for a proxy names the whole URL, and servers have to accept it. Its host counts
/// then, whatever the Host header says.
void useOriginForm(Request& request) {
  const std::string target(request.target());
  std::size_t host = 0;
  for (const beast::string_view scheme : {"http://", "https://"}) {
    if (beast::iequals(beast::string_view(target).substr(0, scheme.size()), scheme)) host = scheme.size();
  }
  const std::size_t end = std::min(target.find_first_of("/?", host), target.size());
  if (host == 0 || end == host) return;
  const std::string path = target.substr(end);
  request.set(http::field::host, target.substr(host, end - host));
  request.target(path.starts_with('/') ? path : "/" + path);
}

}  // namespace

std::optional<Reply> refuseHead(RequestParser& parser) {
  Request& request = parser.get();
  for (const http::field field : kSingleFields) {
    if (request.count(field) <= 1) continue;
    return textReply(400, "There are " + std::to_string(request.count(field)) + " " +
                              std::string(http::to_string(field)) + " headers; send one.");
  }
  if (request.version() >= kHttp11 && request.count(http::field::host) == 0) {
    return textReply(400, "An HTTP/1.1 request needs a Host header.");
  }
  useOriginForm(request);
  if (!isHost(request[http::field::host])) {
    return textReply(400, "The Host header is not a host with an optional port.");
  }
  if (parser.chunked()) return textReply(411, "A body needs a Content-Length here; it may not come in chunks.");
  // RFC 9112 section 6.3: with another coding two readers could disagree where the body ends. Boost's parser ignores
  // it.
  if (const auto coding = request.find(http::field::transfer_encoding); coding != request.end()) {
    return textReply(400, "The Transfer-Encoding " + printable(coding->value()) +
                              " is not known here: send a Content-Length instead.");
  }
  // RFC 9110 section 10.1.1.
  if (const auto expected = request.find(http::field::expect); expected != request.end() && !expectsContinue(request)) {
    return textReply(417, "The Expect header " + printable(expected->value()) +
                              " is not known here: send 100-continue, or leave it out.");
  }
  const bool has_body = request.method() == http::verb::post || request.method() == http::verb::put ||
                        request.method() == http::verb::patch;
  if (has_body && isApiTarget(request.target()) && request.count(http::field::content_length) == 0) {
    return textReply(
        411, "A " + std::string(request.method_string()) + " needs a Content-Length, also where its body is empty.");
  }
  return std::nullopt;
}

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

bool expectsContinue(const Request& request) {
  return request.version() >= kHttp11 && beast::iequals(request[http::field::expect], "100-continue");
}

HttpRequest questionOf(const Request& request, RequestTarget target, const std::string& peer) {
  HttpRequest out;
  out.method = methodToAnswer(std::string(request.method_string()), target.path);
  out.path = std::move(target.path);
  out.query = std::move(target.query);
  out.body = {reinterpret_cast<const std::uint8_t*>(request.body().data()), request.body().size()};
  out.authorization = std::string(request[http::field::authorization]);
  out.content_type = std::string(request[http::field::content_type]);
  out.peer = peer;
  return out;
}

namespace {

/// RFC 6455 section 4.2.1: 16 bytes in base64. Their value is not checked.
bool isKey(std::string_view key) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t kDigitCount = 22;
  return key.size() == kDigitCount + 2 && key.ends_with("==") &&
         key.substr(0, kDigitCount).find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

UpgradeDecision decideUpgrade(const Request& request, std::size_t more_bytes_count, bool serves_foxglove,
                              const std::function<core::Result<void>(const std::string& room)>& accept_room) {
  // RFC 6455 section 4.1: the client waits for the answer. Bytes sent earlier would be lost between the two protocols.
  if (more_bytes_count > 0) {
    return {textReply(400, "Nothing may follow an upgrade request before it is answered.")};
  }
  const auto target = parseTarget(request.target());
  if (!target) return {textReply(400, "The request's path is not a plain absolute path.")};
  if (const auto version = request[http::field::sec_websocket_version]; version != kWebSocketVersion) {
    return {
        webSocketReply((version.empty() ? "The upgrade has no Sec-WebSocket-Version"
                                        : "Sec-WebSocket-Version " + printable(version) + " is not supported here") +
                       ": send version 13.")};
  }
  if (!isKey(request[http::field::sec_websocket_key])) {
    return {textReply(400, "An upgrade needs a Sec-WebSocket-Key of 16 bytes in base64.")};
  }
  auto named = roomOfPath(target->path);
  const bool is_foxglove = !named && serves_foxglove;
  if (is_foxglove) named = foxgloveRoomOfPath(target->path);
  if (!named) return {textReply(404, "There is no WebSocket at " + printable(target->path) + ": use /ws or /ws/ROOM.")};

  // A query ends up in logs and browser histories, so tokens are refused there where clients can send them otherwise.
  auto tokens = queryValues(target->query, "access_token");
  if (!tokens || tokens->size() > 1) return {textReply(400, "The address has a broken access_token, or two of them.")};
  if (!is_foxglove && target->query.find("token") != std::string::npos) {
    return {textReply(400, "A token in the address is refused: send it in Hello.token.")};
  }

  // The web client's own URL has the room in its query; accept it here too.
  const auto asked = queryValues(target->query, "room");
  const auto looks = queryValues(target->query, "onlooker");
  if (!asked || !looks) return {textReply(400, "The query has a broken percent escape or a control character.")};
  if (asked->size() > 1 || (asked->size() == 1 && !named->empty() && asked->front() != *named)) {
    return {textReply(400, "The address names more than one room: use /ws/ROOM.")};
  }
  if (!asked->empty()) named = asked->front();

  UpgradeDecision decision;
  decision.room = *std::move(named);
  decision.is_onlooker = !looks->empty() && !is_foxglove;
  decision.is_foxglove = is_foxglove;
  if (!tokens->empty()) decision.token = std::move(tokens->front());
  // RFC 6455 section 11.3.4: the list may be split over several headers.
  bool is_protocol_offered = false;
  const auto isKnown = [is_foxglove](std::string_view name) {
    return is_foxglove ? std::ranges::find(kFoxgloveSubprotocols, name) != kFoxgloveSubprotocols.end()
                       : name == kSubprotocol;
  };
  const auto [first, end] = request.equal_range(http::field::sec_websocket_protocol);
  for (auto offered = first; offered != end; ++offered) {
    is_protocol_offered = is_protocol_offered || !offered->value().empty();
    for (const auto& protocol : http::token_list(offered->value())) {
      const std::string_view name(protocol.data(), protocol.size());
      if (decision.subprotocol.empty() && isKnown(name)) decision.subprotocol = name;
    }
  }
  if ((is_protocol_offered || is_foxglove) && decision.subprotocol.empty()) {
    return {textReply(400, std::string("No offered subprotocol is known here: offer ") +
                               (is_foxglove ? std::string(kFoxgloveSubprotocols.front()) : kSubprotocol) + ".")};
  }
  try {
    const core::Result<void> accepted = accept_room(decision.room);
    if (!accepted) {
      const bool is_temporary = accepted.error().code == core::ErrorCode::kUnavailable;
      const std::string& why = accepted.error().message;
      return {.refusal = is_temporary ? retryReply(503, why) : textReply(404, why), .is_room_refused = true};
    }
  } catch (const std::exception& error) {
    spdlog::error("whether a session may enter a room could not be decided: {}", error.what());
    return {textReply(500, "The server failed on this request; its log says why.")};
  }
  return decision;
}

}  // namespace spindrift::net
