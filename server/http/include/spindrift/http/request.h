// HTTP requests and their replies, without a socket: bounds of the parser, replies to broken requests, routes, and the
// decision on an upgrade.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/system/error_code.hpp>

#include <spindrift/core/result.h>
#include <spindrift/http/message.h>
#include <spindrift/http/static_files.h>
#include <spindrift/http/url.h>

namespace spindrift::net {

struct Reply {
  unsigned status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = std::make_shared<const std::string>();  ///< never null; empty for 304
  /// In addition to Content-Type and the security headers.
  std::vector<std::pair<std::string, std::string>> headers{};
  bool is_embeddable = false;  ///< the page of `?embed`: other pages that the server lists may show it in a frame
};

/// Returns one plain line of text (the newline is added here), not cached.
Reply textReply(unsigned status, std::string line);

/// Returns the same with Retry-After.
Reply retryReply(unsigned status, std::string line, std::int64_t after_s = 1);

/// Name of the subprotocol defined in proto/spindrift/v1.
inline constexpr const char* kSubprotocol = "spindrift.v1";

/// Names of Foxglove's protocol, one and the same under both: that of its SDK, and the older one. At /foxglove only.
inline constexpr std::array<std::string_view, 2> kFoxgloveSubprotocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};

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

/// Limit of the request line and the header fields together.
inline constexpr std::uint32_t kHeaderMaxBytes = 16 * 1024;

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using RequestParser = boost::beast::http::request_parser<boost::beast::http::string_body>;

/// Sets the parser's bounds; call it before the first byte.
void bound(RequestParser& parser, std::size_t body_max_bytes);

/// Returns the refusal for a request whose head alone is wrong, with the body unread; nullopt if it may continue. Turns
/// a target in absolute form ("GET http://host/path") into a path and the Host header (RFC 9112 section 3.2.2). 400:
/// HTTP/1.1 without Host, an invalid Host, or a repeated header that may occur once (RFC 9112 section 3.2, RFC 9110
/// section 5.3, RFC 6455 section 11.3). 411: a POST to the REST interface without a length, or a chunked body. Chunked
/// bodies are refused because no request here needs one, Beast's parser stores a chunk's line at any length, and
/// it fails an assertion when the last chunk of an empty body comes byte by byte (boostorg/beast pull request 2861).
/// 417: an expectation other than 100-continue.
std::optional<Reply> refuseHead(RequestParser& parser);

/// Returns the reply to a request that the parser refused; nullopt if the connection is gone.
std::optional<Reply> replyToBadRequest(const boost::system::error_code& error, std::size_t body_max_bytes);

/// Routes a complete request. Returns a reply (a file of the web client, or an error with one line), or the target of a
/// request that the application has to answer.
std::variant<Reply, RequestTarget> routeRequest(const Request& request, StaticFiles& files);

/// Returns whether the client may wait for "100 Continue" before it sends the body (RFC 9110 section 10.1.1).
bool expectsContinue(const Request& request);

/// Returns what the application is asked; its body is valid as long as the request.
HttpRequest questionOf(const Request& request, RequestTarget target, const std::string& peer);

/// Converts the application's answer to a reply; nullopt is 404.
Reply applicationReply(std::string_view path, std::optional<HttpReply> answer);

/// Returns the headers of every response, the WebSocket handshake included: they restrict what the page may load, and
/// which pages may show it in a frame. `parents`: the origins of those pages (checkParentOrigin()); none: nobody may.
std::vector<std::pair<std::string_view, std::string>> securityHeaders(std::span<const std::string> parents = {});

/// The room of an upgrade, or the refusal.
struct UpgradeDecision {
  std::optional<Reply> refusal;  ///< if set, the upgrade is refused with this reply
  bool is_room_refused = false;  ///< the refusal is that of `accept_room`
  std::string room{};            ///< "" is the default room
  bool is_onlooker = false;      ///< the address has `?onlooker`
  bool is_foxglove = false;      ///< the address is below /foxglove
  std::string subprotocol{};     ///< offered by the client, and spoken from now on; "": none was offered
  std::string
      token{};  ///< secret: `access_token` of an address below /foxglove, where clients have no other place for it
};

/// Checks a WebSocket upgrade. `more_bytes_count`: bytes received after the request before it was answered.
/// `accept_room`: returns whether sessions may enter the room; the line of its error is the refusal's, kUnavailable
/// with 503, all others with 404. It may throw: 500. `serves_foxglove`: /foxglove is a WebSocket, too.
UpgradeDecision decideUpgrade(const Request& request, std::size_t more_bytes_count, bool serves_foxglove,
                              const std::function<core::Result<void>(const std::string& room)>& accept_room);

}  // namespace spindrift::net
