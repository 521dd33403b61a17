// What a plain HTTP request gets, decided without a socket: the request's parts in, a reply out.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/net/server.h>

#include "static_files.h"
#include "url.h"

namespace spindrift::net {

struct RequestHead {
  std::string method;
  std::string target;  ///< as sent
  std::string if_none_match;
};

struct Reply {
  unsigned status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  ///< never null; empty for 304
  /// Beyond Content-Type and the security headers.
  std::vector<std::pair<std::string, std::string>> headers;
};

/// One plain line of text (the newline is added here), not cached.
Reply textReply(unsigned status, std::string line);

/// RFC 6455.
inline constexpr std::string_view kWebSocketVersion = "13";

/// 426: what a request to a WebSocket address gets that is no upgrade, or one to another version. `line` says which.
Reply webSocketReply(std::string line);

/// Whether what is at this target, as sent, is the REST interface, which answers in JSON.
bool isApiTarget(std::string_view target);

/// The reply as a spindrift.v1.Problem in JSON where it is an error in plain text; unchanged otherwise.
Reply asProblem(Reply reply);

/// 204: what a browser is told that asks whether a page of `origin` may send a request to the REST interface.
Reply preflightReply();

/// Lets a page of `origin` read the reply (Fetch standard, "CORS protocol").
void allowOrigin(Reply& reply, std::string_view origin);

/// What a whole request gets: a reply at once (the web client's files, or an error with one line), or, for its paths,
/// what the application says.
std::variant<Reply, Target> routeRequest(const RequestHead& head, StaticFiles& files);

/// The application's answer as a reply; nullopt is 404.
Reply applicationReply(std::string_view path, std::optional<HttpReply> answer);

/// Sent with every response, the WebSocket handshake included: what the page may load, and that it may not be framed.
std::span<const std::pair<std::string_view, std::string_view>> securityHeaders();

}  // namespace spindrift::net
