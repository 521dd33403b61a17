#include "http_request.h"

#include <exception>
#include <utility>

#include <boost/beast/http/error.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <spdlog/spdlog.h>

#include "server_context.h"
#include "url.h"

namespace spindrift::net {

namespace http = boost::beast::http;

void bound(RequestParser& parser, std::size_t body_max_bytes) {
  parser.header_limit(kHeaderMaxBytes);
  parser.body_limit(body_max_bytes);
}

std::optional<Reply> refuseHead(const RequestParser& parser) {
  if (!parser.chunked()) return std::nullopt;
  return textReply(411, "A body needs a Content-Length here; it may not come in chunks.");
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

RequestHead headOf(const Request& request) {
  return {std::string(request.method_string()), std::string(request.target()),
          std::string(request[http::field::if_none_match])};
}

core::ByteView bodyOf(const Request& request) {
  return {reinterpret_cast<const std::uint8_t*>(request.body().data()), request.body().size()};
}

namespace {

/// RFC 6455 section 4.2.1: 16 bytes in base64. What they are is the client's business.
bool isKey(std::string_view key) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t kDigitCount = 22;
  return key.size() == kDigitCount + 2 && key.ends_with("==") &&
         key.substr(0, kDigitCount).find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

UpgradeDecision decideUpgrade(const Request& request, std::size_t more_bytes_count, Application& application) {
  // RFC 6455 section 4.1: the client waits for the answer. The bytes would get lost between the two protocols.
  if (more_bytes_count > 0) {
    return {textReply(400, "Nothing may follow an upgrade request before it is answered.")};
  }
  const auto target = parseTarget(std::string_view(request.target().data(), request.target().size()));
  if (!target) return {textReply(400, "The request's path is not a plain absolute path.")};
  if (request[http::field::sec_websocket_version] != kWebSocketVersion) return {webSocketReply()};
  const auto key = request[http::field::sec_websocket_key];
  if (!isKey({key.data(), key.size()})) {
    return {textReply(400, "An upgrade needs a Sec-WebSocket-Key of 16 bytes in base64.")};
  }
  auto named = roomOfPath(target->path);
  if (!named) return {textReply(404, "There is no WebSocket at " + target->path + ": use /ws or /ws/ROOM.")};

  // A query ends up in logs and histories; nothing of ours belongs there.
  if (target->query.find("token") != std::string::npos) {
    return {textReply(400, "Tokens do not belong into addresses: send it in Hello.token.")};
  }

  UpgradeDecision decision;
  decision.room = std::move(*named);
  const auto offered = request[http::field::sec_websocket_protocol];
  for (const auto& protocol : http::token_list(offered)) decision.echo_subprotocol |= protocol == kSubprotocol;
  if (!offered.empty() && !decision.echo_subprotocol) {
    return {textReply(400, std::string("No offered subprotocol is known here: offer ") + kSubprotocol + ".")};
  }
  try {
    const core::Result<void> accepted = application.acceptSession(decision.room);
    if (!accepted) return {textReply(404, accepted.error().message), Refused::kRoom};
  } catch (const std::exception& error) {
    spdlog::error("acceptSession failed: {}", error.what());
    return {textReply(500, "The server failed on this request; its log says why.")};
  }
  return decision;
}

}  // namespace spindrift::net
