#include <optional>

#include <spindrift/http/request.h>

#include "field_list.h"

namespace spindrift::net {

namespace http = boost::beast::http;

namespace {

constexpr std::string_view kApiRoot = "/api/";
/// The web component that shows this server's water in other pages. Browsers load a module of another origin only with
/// the headers below.
constexpr std::string_view kElementPath = "/element.js";

bool isApplicationPath(std::string_view path) {
  return path.starts_with(kApiRoot) || path == "/healthz" || path == "/readyz" || path == "/metrics";
}

/// Load balancers ask these whether they may send clients.
bool isHealthPath(std::string_view path) {
  return path == "/healthz" || path == "/readyz";
}

/// RFC 9110 section 9.3.7.
Reply optionsReply(std::string_view allowed) {
  return {.status = 204, .headers = {{"Cache-Control", "no-store"}, {"Allow", std::string(allowed)}}};
}

Reply methodNotAllowed(const std::string& method, std::string_view allowed) {
  Reply reply =
      textReply(405, "The method " + printable(method) + " is not allowed here: use " + std::string(allowed) + ".");
  reply.headers.emplace_back("Allow", allowed);
  return reply;
}

/// Returns the list of a header that may be split over several lines.
std::string listOf(const Request& request, http::field name) {
  std::string joined;
  const auto [first, end] = request.equal_range(name);
  for (auto line = first; line != end; ++line) {
    joined.append(joined.empty() ? "" : ", ").append(line->value().data(), line->value().size());
  }
  return joined;
}

/// Returns whether the If-None-Match list contains this tag, with the weak comparison of RFC 9110 section 13.1.2.
bool matchesEtag(std::string_view list, std::string_view etag) {
  while (!list.empty()) {
    std::string_view tag = takeEntry(list);
    if (tag.starts_with("W/")) tag.remove_prefix(2);
    if (tag == "*" || tag == etag) return true;
  }
  return false;
}

/// Returns whether the page without panels was asked for, which other pages may embed.
bool isEmbeddedPage(const RequestTarget& target) {
  if (target.path != "/") return false;
  const auto values = queryValues(target.query, "embed");
  return values && !values->empty();
}

Reply fileReply(const Request& request, const RequestTarget& target, StaticFiles& files) {
  const std::string& path = target.path;
  const std::shared_ptr<const StaticFile> file = files.find(path, listOf(request, http::field::accept_encoding));
  if (!file && (path == "/" || path == "/pad")) {
    return textReply(503, "The web client is not built: run ./dev build, then start the server again with --web-root.");
  }
  if (!file) return textReply(404, "There is nothing at " + printable(path) + ".");
  Reply reply;
  reply.headers.emplace_back("ETag", file->etag);
  reply.headers.emplace_back("Vary", "Accept-Encoding");
  reply.is_embeddable = isEmbeddedPage(target);
  if (path == kElementPath) {
    reply.headers.emplace_back("Access-Control-Allow-Origin", "*");
    reply.headers.emplace_back("Cross-Origin-Resource-Policy", "cross-origin");
  }
  reply.headers.emplace_back("Cache-Control", file->immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (matchesEtag(listOf(request, http::field::if_none_match), file->etag)) {
    reply.status = 304;
    return reply;
  }
  if (!file->coding.empty()) reply.headers.emplace_back("Content-Encoding", file->coding);
  reply.content_type = file->content_type;
  reply.body = std::shared_ptr<const std::string>(file, &file->content);
  return reply;
}

}  // namespace

Reply textReply(unsigned status, std::string line) {
  return {.status = status,
          .body = std::make_shared<const std::string>(std::move(line) + "\n"),
          .headers = {{"Cache-Control", "no-store"}}};
}

Reply retryReply(unsigned status, std::string line, std::int64_t after_s) {
  Reply reply = textReply(status, std::move(line));
  reply.headers.emplace_back("Retry-After", std::to_string(after_s));
  return reply;
}

Reply webSocketReply(std::string line) {
  Reply reply = textReply(426, std::move(line));
  reply.headers.emplace_back("Upgrade", "websocket");
  reply.headers.emplace_back("Sec-WebSocket-Version", kWebSocketVersion);
  return reply;
}

bool isApiTarget(std::string_view target) {
  if (const auto parsed = parseTarget(target)) return parsed->path.starts_with(kApiRoot);
  return target.starts_with(kApiRoot);
}

Reply asProblem(Reply reply) {
  constexpr unsigned kFirstError = 400;
  if (reply.status < kFirstError || !reply.content_type.starts_with("text/plain")) return reply;
  // The server's own lines are printable ASCII: untrusted text in them has passed printable().
  std::string line;
  for (const char c : *reply.body) {
    if (c == '"' || c == '\\') line.push_back('\\');
    if (c != '\n') line.push_back(c);
  }
  reply.content_type = "application/json";
  reply.body = std::make_shared<const std::string>("{\"message\":\"" + line + "\"}\n");
  return reply;
}

Reply preflightReply() {
  return {.status = 204,
          .headers = {{"Cache-Control", "no-store"},
                      {"Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE"},
                      {"Access-Control-Allow-Headers", "Authorization, Content-Type"},
                      {"Access-Control-Max-Age", "600"}}};
}

void allowOrigin(Reply& reply, std::string_view origin) {
  reply.headers.emplace_back("Access-Control-Allow-Origin", origin);
}

std::string methodToAnswer(const std::string& method, std::string_view path) {
  const bool asks = method == "HEAD" || (method == "OPTIONS" && isHealthPath(path));
  return asks ? "GET" : method;
}

std::variant<Reply, RequestTarget> routeRequest(const Request& request, StaticFiles& files) {
  const std::string method(request.method_string());
  // RFC 9112 section 3.2.4: the server as a whole.
  if (method == "OPTIONS" && request.target() == "*") return optionsReply("GET, HEAD, POST, DELETE, OPTIONS");
  std::optional<RequestTarget> target = parseTarget(request.target());
  if (!target) return textReply(400, "The request's path is not a plain absolute path.");
  if (isApplicationPath(target->path)) {
    if (method == "TRACE" || method == "CONNECT") {
      return methodNotAllowed(method, "GET, HEAD, POST, PUT, PATCH, DELETE");
    }
    return *std::move(target);
  }
  if (roomOfPath(target->path)) {
    return webSocketReply("This is a WebSocket address: connect with a WebSocket client, subprotocol spindrift.v1.");
  }
  constexpr std::string_view kAllowed = "GET, HEAD, OPTIONS";
  if (method == "OPTIONS") return optionsReply(kAllowed);
  if (method != "GET" && method != "HEAD") return methodNotAllowed(method, kAllowed);
  return fileReply(request, *target, files);
}

Reply applicationReply(std::string_view path, std::optional<HttpReply> answer) {
  if (!answer) return textReply(404, "There is nothing at " + printable(path) + ".");
  answer->headers.emplace_back("Cache-Control", "no-store");
  return {.status = answer->status,
          .content_type = std::move(answer->content_type),
          .body = std::make_shared<const std::string>(std::move(answer->body)),
          .headers = std::move(answer->headers)};
}

std::vector<std::pair<std::string_view, std::string>> securityHeaders(std::span<const std::string> parents) {
  std::string ancestors;
  for (const std::string& parent : parents) ancestors += " " + parent;
  std::vector<std::pair<std::string_view, std::string>> out{
      {"Content-Security-Policy",
       "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' "
       "data: blob:; worker-src 'self' blob:; connect-src 'self' ws: wss:; frame-ancestors" +
           (parents.empty() ? " 'none'" : ancestors) + "; base-uri 'none'; form-action 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
  };
  // It cannot name origins.
  if (parents.empty()) out.emplace_back("X-Frame-Options", "DENY");
  return out;
}

}  // namespace spindrift::net
