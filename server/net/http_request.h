// An HTTP request as it comes off the wire: the bounds of its parser, what a broken one gets, and whether an upgrade
// may go on. Decided without a socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/system/error_code.hpp>

#include "http_routes.h"

namespace spindrift::net {

/// The request line and the header fields together.
inline constexpr std::uint32_t kHeaderMaxBytes = 16 * 1024;

using Request = boost::beast::http::request<boost::beast::http::string_body>;
using RequestParser = boost::beast::http::request_parser<boost::beast::http::string_body>;

/// Sets the parser's bounds; before its first byte.
void bound(RequestParser& parser, std::size_t body_max_bytes);

/// What a request gets that is refused by its head alone, its body unread; nullopt if it may go on. 400: HTTP/1.1
/// without Host, a Host that is none, or two of a header of which there may be one (RFC 9112 section 3.2, RFC 9110
/// section 5.3, RFC 6455 section 11.3). 411: a POST to the REST interface without a length, or a chunked body. Those
/// are refused: nothing here takes one, Boost 1.81's parser keeps a chunk's line however long it grows, and it fails an
/// assertion when the last chunk of an empty body comes byte by byte (boostorg/beast pull request 2861).
std::optional<Reply> refuseHead(const RequestParser& parser);

/// What a request gets that the parser refused; nullopt if there is nobody to answer.
std::optional<Reply> replyToBadRequest(const boost::system::error_code& error, std::size_t body_max_bytes);

/// The parts that routeRequest() reads.
RequestHead headOf(const Request& request);

/// The body as bytes; valid as long as the request.
core::ByteView bodyOf(const Request& request);

/// Where an upgrade leads, or why it does not.
struct UpgradeDecision {
  std::optional<Reply> refusal;       ///< set: the upgrade is refused with it
  Refused why = Refused::kHandshake;  ///< for the count, where it is refused
  std::string room{};                 ///< as Application::acceptSession took it
  bool echo_subprotocol = false;      ///< the client offered kSubprotocol
};

/// Judges a WebSocket upgrade. `more_bytes_count`: bytes that came behind the request before it was answered.
UpgradeDecision decideUpgrade(const Request& request, std::size_t more_bytes_count, Application& application);

}  // namespace spindrift::net
