// A request that the application answers, and its answer.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::net {

/// Reply to a plain HTTP request to a path under /api/ or a probe.
struct HttpReply {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers{};  ///< in addition to Content-Type: "Allow", ...
};

struct HttpRequest {
  std::string method;           ///< "GET", "POST", ...; a HEAD request arrives as "GET"; its reply is sent without body
  std::string path;             ///< percent-decoded, without the query
  std::string query;            ///< undecoded, without the question mark
  core::ByteView body;          ///< at most ServerOptions::request_body_max_bytes; valid during the call
  std::string authorization{};  ///< the Authorization header, unparsed
  std::string content_type{};   ///< the Content-Type header, unparsed
  std::string peer{};           ///< for logs: the client's address, and the proxy if a trusted one passed it on
};

/// Answers one request; nullopt = 404. Call it at most once, from any thread; if every copy is dropped without a call,
/// the answer is 500. An answer after ServerOptions::answer_timeout is ignored: 504 was sent.
using HttpResponder = std::function<void(std::optional<HttpReply>)>;

}  // namespace spindrift::net
