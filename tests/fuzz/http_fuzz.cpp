// Bytes of a new connection, as connection.cpp reads them: requests one after another from one buffer, each routed or
// checked as an upgrade. The first byte decides how the input is split.
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/http/network_text.h>
#include <spindrift/http/request.h>
#include <spindrift/http/static_files.h>
#include <spindrift/http/url.h>

#include "fuzz.h"
#include "temporary_folder.h"

namespace spindrift::fuzz {
namespace {

constexpr std::size_t kBodyMaxBytes = 256;

core::Result<void> acceptRoom(const std::string& room) {
  if (room.empty() || room == "pool") return {};
  return core::Error{core::ErrorCode::kInvalidInput, "there is no such room"};
}

/// A small web root beside a file that must never be served.
struct Site {
  test::TemporaryFolder folder;
  net::StaticFiles files;

  Site() : files(write(folder)) {}
  static std::string write(const test::TemporaryFolder& folder) {
    folder.write("secret.txt", "secret");
    folder.write("web/index.html", "<h1>water</h1>");
    folder.write("web/assets/a.js", ";");
    folder.write("web/.hidden", "secret");
    std::filesystem::create_symlink("../secret.txt", folder.path() / "web/out.txt");
    return (folder.path() / "web").string();
  }
};

void checkReply(const net::Reply& reply) {
  must(reply.body != nullptr, "a reply has a body");
  must(reply.body->find("secret") == std::string::npos || reply.status >= 400,
       "nothing outside the web root is served");
  must(reply.status >= 200 && reply.status < 600, "a reply has a status");
  for (const auto& [name, value] : reply.headers) {
    must(value.find_first_of("\r\n") == std::string::npos, "no header of a reply can be split");
  }
}

/// Feeds the parser until `is_done()`, as Beast's read operations do. False if the connection ends before.
template <typename More, typename Done>
bool read(net::RequestParser& parser, boost::beast::flat_buffer& buffer, More more, Done is_done,
          boost::system::error_code& error) {
  while (!is_done()) {
    bool needs_more = buffer.size() == 0;
    if (!needs_more) {
      buffer.consume(parser.put(buffer.data(), error));
      needs_more = error == boost::beast::http::error::need_more;
    }
    if (needs_more) {
      error = {};
      if (more(buffer)) continue;
      if (!parser.got_some()) return false;
      parser.put_eof(error);
    }
    if (error) return false;
  }
  return true;
}

/// Handles one request from the buffer; false when the connection ends. `more` adds the next piece, false at the end.
template <typename More>
bool serveOne(boost::beast::flat_buffer& buffer, More more, Site& site) {
  net::RequestParser parser;
  net::bound(parser, kBodyMaxBytes);
  boost::system::error_code error;
  parser.eager(false);
  bool is_read = read(
      parser, buffer, more, [&] { return parser.is_header_done(); }, error);
  if (is_read) {
    if (const auto refusal = net::refuseHead(parser)) {
      checkReply(*refusal);
      return false;
    }
    parser.eager(true);
    is_read = read(
        parser, buffer, more, [&] { return parser.is_done(); }, error);
  }
  if (!is_read) {
    if (const auto reply = error ? net::replyToBadRequest(error, kBodyMaxBytes) : std::nullopt) checkReply(*reply);
    return false;
  }
  must(parser.is_done(), "a request without an error is whole");
  const net::Request& request = parser.get();
  must(request.count(boost::beast::http::field::transfer_encoding) == 0, "only its length divides a request");
  if (boost::beast::websocket::is_upgrade(request)) {
    const net::UpgradeDecision decision = net::decideUpgrade(request, buffer.size(), true, acceptRoom);
    if (decision.refusal) {
      must(decision.refusal->status >= 400, "a refusal is an error");
      checkReply(*decision.refusal);
    } else {
      must(decision.room.empty() || decision.room == "pool", "sessions join rooms that there are");
    }
    return false;
  }
  const auto field = [&](boost::beast::http::field name) {
    return std::string_view(request[name].data(), request[name].size());
  };
  const bool is_heard =
      net::isOriginAllowed(field(boost::beast::http::field::origin), field(boost::beast::http::field::host), true, {});
  must(is_heard || !field(boost::beast::http::field::origin).empty(), "programs are heard");
  const auto routed = net::routeRequest(request, site.files);
  if (const auto* target = std::get_if<net::RequestTarget>(&routed)) {
    must(target->path.starts_with('/'), "the application sees absolute paths");
    must(net::questionOf(request, *target, "peer").body.size() <= kBodyMaxBytes, "the body keeps its bound");
    checkReply(net::applicationReply(target->path, std::nullopt));
  } else {
    checkReply(std::get<net::Reply>(routed));
  }
  return request.keep_alive();
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  static fuzz::Site site;
  spdlog::set_level(spdlog::level::off);
  if (size == 0) return 0;
  const std::size_t piece_bytes = std::size_t{1} + 7 * data[0];
  const std::uint8_t* at = data + 1;
  const std::uint8_t* const end = data + size;
  // The seeds are whole requests, so the text itself is also used as a target path.
  if (const auto target = net::parseTarget({reinterpret_cast<const char*>(at), size - 1})) {
    fuzz::must(target->path.starts_with('/'), "a path is absolute");
    fuzz::must(target->path.find('\0') == std::string::npos, "a path holds no NUL");
    (void)net::roomOfPath(target->path);
  }
  const auto more = [&](boost::beast::flat_buffer& buffer) {
    const std::size_t count = std::min(piece_bytes, static_cast<std::size_t>(end - at));
    if (count == 0) return false;
    std::memcpy(buffer.prepare(count).data(), at, count);
    buffer.commit(count);
    at += count;
    return true;
  };
  boost::beast::flat_buffer buffer;
  while (fuzz::serveOne(buffer, more, site)) {
    if (buffer.size() == 0 && at == end) break;
  }
  return 0;
}
