// Routes plain HTTP requests, without a socket: takes the parts of a request, returns a reply.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/http/message.h>
#include <spindrift/http/static_files.h>
#include <spindrift/http/url.h>

namespace spindrift::net {

struct RequestHead {
  std::string method;
  std::string target;  ///< undecoded
  std::string if_none_match;
  std::string accept_encoding;
};

struct Reply {
  unsigned status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = std::make_shared<const std::string>();  ///< never null; empty for 304
  /// In addition to Content-Type and the security headers.
  std::vector<std::pair<std::string, std::string>> headers{};
};

/// Returns one plain line of text (the newline is added here), not cached.
Reply textReply(unsigned status, std::string line);

/// Returns the same with Retry-After.
Reply retryReply(unsigned status, std::string line, std::int64_t after_s = 1);

/// Name of the subprotocol defined in proto/spindrift/v1.
inline constexpr const char* kSubprotocol = "spindrift.v1";

/// Defined by RFC 6455.
inline constexpr std::string_view kWebSocketVersion = "13";

/// Returns 426, for a request to a WebSocket address that is not an upgrade or one to another version; `line` says
/// which.
Reply webSocketReply(std::string line);

/// Returns whether the undecoded target belongs to the REST interface, which answers in JSON.
bool isApiTarget(std::string_view target);

/// Turns a plain-text error into a spindrift.v1.Problem in JSON; other replies stay unchanged.
Reply asProblem(Reply reply);

/// Returns 204, the answer to a CORS preflight of an allowed Origin.
Reply preflightReply();

/// Lets a page of `origin` read the reply (Fetch standard, "CORS protocol").
void allowOrigin(Reply& reply, std::string_view origin);

/// Returns the method with which the application answers: GET for HEAD, and for OPTIONS of a health path, which is the
/// check that HAProxy makes unless told otherwise. net leaves out the body for HEAD.
std::string methodToAnswer(const std::string& method, std::string_view path);

/// Routes a complete request. Returns a reply (a file of the web client, or an error with one line), or the target of a
/// request that the application has to answer.
std::variant<Reply, RequestTarget> routeRequest(const RequestHead& head, StaticFiles& files);

/// Converts the application's answer to a reply; nullopt is 404.
Reply applicationReply(std::string_view path, std::optional<HttpReply> answer);

/// Headers of every response, the WebSocket handshake included: they restrict what the page may load and forbid
/// framing.
std::span<const std::pair<std::string_view, std::string_view>> securityHeaders();

}  // namespace spindrift::net
