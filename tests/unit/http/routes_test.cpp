#include <algorithm>

#include <gtest/gtest.h>

#include <spindrift/http/request.h>

#include "temporary_folder.h"

namespace spindrift::net {
namespace {

namespace http = boost::beast::http;

struct HttpRoutesTest : testing::Test {
  test::TemporaryFolder folder;

  static Request requestOf(const std::string& method, const std::string& target) {
    Request out;
    out.method_string(method);
    out.target(target);
    return out;
  }
  Reply route(const std::string& method, const std::string& target, const std::string& if_none_match = "",
              const std::string& accept_encoding = "") {
    StaticFiles files(folder.path().string());
    Request request = requestOf(method, target);
    if (!if_none_match.empty()) request.set(http::field::if_none_match, if_none_match);
    if (!accept_encoding.empty()) request.set(http::field::accept_encoding, accept_encoding);
    auto routed = routeRequest(request, files);
    return std::holds_alternative<Reply>(routed) ? std::get<Reply>(std::move(routed)) : Reply{};
  }
  /// The request that would go to the application.
  std::optional<RequestTarget> target(const std::string& method, const std::string& text) {
    StaticFiles files(folder.path().string());
    auto routed = routeRequest(requestOf(method, text), files);
    return std::holds_alternative<RequestTarget>(routed) ? std::optional(std::get<RequestTarget>(std::move(routed)))
                                                         : std::nullopt;
  }
  static std::string header(const Reply& reply, const std::string& name) {
    for (const auto& [known, value] : reply.headers) {
      if (known == name) return value;
    }
    return "(none)";
  }
};

TEST_F(HttpRoutesTest, SaysHowToBuildAMissingWebClient) {
  const Reply reply = route("GET", "/");
  EXPECT_EQ(reply.status, 503U);
  EXPECT_TRUE(reply.content_type.starts_with("text/plain"));
  EXPECT_TRUE(reply.body->starts_with("The web client is not built: run ./dev build"));
}

TEST_F(HttpRoutesTest, LetsBrowsersCacheHashedAssetsAndRevalidateTheRest) {
  folder.write("index.html", "<h1>water</h1>");
  folder.write("assets/main-abc.js", "run()");
  EXPECT_EQ(header(route("GET", "/assets/main-abc.js"), "Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(header(route("GET", "/?room=pool"), "Cache-Control"), "no-cache");
}

TEST_F(HttpRoutesTest, SendsCompressedFilesWithTheirOwnTag) {
  folder.write("assets/main-abc.js", "run()");
  folder.write("assets/main-abc.js.gz", "gzipped");
  const Reply plain = route("GET", "/assets/main-abc.js");
  const Reply gzip = route("GET", "/assets/main-abc.js", "", "gzip");
  EXPECT_EQ(*gzip.body, "gzipped");
  EXPECT_EQ(gzip.content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(header(gzip, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(gzip, "Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(*plain.body, "run()");
  EXPECT_EQ(header(plain, "Content-Encoding"), "(none)");
  EXPECT_NE(header(plain, "ETag"), header(gzip, "ETag"));
  for (const Reply* reply : {&plain, &gzip}) EXPECT_EQ(header(*reply, "Vary"), "Accept-Encoding");

  const Reply known = route("GET", "/assets/main-abc.js", header(gzip, "ETag"), "gzip");
  EXPECT_EQ(known.status, 304U);
  EXPECT_EQ(header(known, "Vary"), "Accept-Encoding");
  EXPECT_EQ(route("GET", "/assets/main-abc.js", header(gzip, "ETag")).status, 200U);
}

TEST_F(HttpRoutesTest, AnswersNotModifiedForAKnownTag) {
  folder.write("index.html", "<h1>water</h1>");
  const Reply first = route("GET", "/");
  const std::string etag = header(first, "ETag");
  EXPECT_EQ(first.status, 200U);
  for (const std::string& known : {etag, "W/" + etag, "\"other\" , " + etag, std::string("*")}) {
    const Reply second = route("GET", "/", known);
    EXPECT_EQ(second.status, 304U) << known;
    EXPECT_TRUE(second.body->empty());
    EXPECT_EQ(header(second, "ETag"), etag);
  }
  EXPECT_EQ(route("GET", "/", "\"other\"").status, 200U);
}

TEST_F(HttpRoutesTest, RefusesPathsThatAreNotPlain) {
  for (const char* target : {"", "*", "index.html", "http://localhost/", "/%", "/%2", "/%zz", "/%-1", "/%00", "/a%0Ab",
                             "/..%5csecret", "/a\\b"}) {
    EXPECT_EQ(route("GET", target).status, 400U) << target;
  }
}

TEST_F(HttpRoutesTest, FindsNothingByTraversal) {
  folder.write("index.html", "<h1>water</h1>");
  for (const char* target : {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc%2fpasswd",
                             "//etc/passwd", "/%2fetc/passwd", "/assets/../index.html", "/index.html/"}) {
    EXPECT_EQ(route("GET", target).status, 404U) << target;
  }
}

TEST_F(HttpRoutesTest, AllowsOnlyReadingFiles) {
  for (const char* method : {"POST", "PUT", "DELETE", "TRACE", "BREW"}) {
    const Reply reply = route(method, "/");
    EXPECT_EQ(reply.status, 405U) << method;
    EXPECT_EQ(header(reply, "Allow"), "GET, HEAD, OPTIONS");
  }
  EXPECT_EQ(route("TRACE", "/api/echo").status, 405U);
}

TEST_F(HttpRoutesTest, AnswersOptionsWithTheMethodsThatAreAllowed) {
  for (const char* target : {"/", "*", "/index.html"}) {
    const Reply reply = route("OPTIONS", target);
    EXPECT_EQ(reply.status, 204U) << target;
    EXPECT_NE(header(reply, "Allow").find("OPTIONS"), std::string::npos) << target;
  }
}

TEST_F(HttpRoutesTest, TakesOptionsOfAHealthPathAsGet) {
  for (const char* path : {"/healthz", "/readyz"}) {
    EXPECT_TRUE(target("OPTIONS", path)) << path;
    EXPECT_EQ(methodToAnswer("OPTIONS", path), "GET") << path;
  }
  EXPECT_EQ(methodToAnswer("OPTIONS", "/api/v1/rooms"), "OPTIONS");
  EXPECT_EQ(methodToAnswer("HEAD", "/metrics"), "GET");
  EXPECT_EQ(methodToAnswer("POST", "/healthz"), "POST");
}

TEST_F(HttpRoutesTest, PassesItsPathsToTheApplication) {
  const auto echo = target("POST", "/api/echo?x=1");
  ASSERT_TRUE(echo);
  EXPECT_EQ(echo->path, "/api/echo");
  EXPECT_EQ(echo->query, "x=1");
  for (const char* path : {"/healthz", "/readyz", "/metrics", "/api/"}) EXPECT_TRUE(target("GET", path)) << path;
  EXPECT_FALSE(target("GET", "/apis"));
  EXPECT_FALSE(target("TRACE", "/api/echo"));
}

TEST_F(HttpRoutesTest, TurnsTheApplicationsAnswerIntoAReply) {
  const Reply reply = applicationReply("/api/x", HttpReply{201, "text/plain", "made\n"});
  EXPECT_EQ(reply.status, 201U);
  EXPECT_EQ(*reply.body, "made\n");
  EXPECT_EQ(header(reply, "Cache-Control"), "no-store");
  EXPECT_EQ(applicationReply("/api/x", std::nullopt).status, 404U);
}

TEST_F(HttpRoutesTest, AsksForAnUpgradeOnTheWebSocketPath) {
  EXPECT_EQ(route("GET", "/ws").status, 426U);
  EXPECT_EQ(header(route("GET", "/ws/pool"), "Upgrade"), "websocket");
}

TEST_F(HttpRoutesTest, PutsEveryErrorIntoOnePlainLine) {
  for (const char* target : {"/", "/missing", "/%00", "/ws"}) {
    const Reply reply = route("GET", target);
    EXPECT_TRUE(reply.content_type.starts_with("text/plain")) << target;
    EXPECT_EQ(std::ranges::count(*reply.body, '\n'), 1) << target;
    EXPECT_TRUE(reply.body->ends_with('\n')) << target;
  }
}

TEST(Target, SplitsPathAndQuery) {
  const auto target = parseTarget("/a%20b/c?x=%20&y");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/a b/c");
  EXPECT_EQ(target->query, "x=%20&y");
}

TEST(Query, GivesTheValuesOfAName) {
  using Values = std::vector<std::string>;
  EXPECT_EQ(queryValues("room=a&x=1&room=b%20c+d&room&rooms=e", "room"), (Values{"a", "b c d", ""}));
  EXPECT_EQ(queryValues("", "room"), Values{});
  EXPECT_EQ(queryValues("x=%zz", "room"), Values{});
  for (const char* broken : {"room=%", "room=%4", "room=%zz", "room=a%0a"}) {
    EXPECT_EQ(queryValues(broken, "room"), std::nullopt) << broken;
  }
}

TEST(Printable, EscapesAndShortensBytesOfClients) {
  EXPECT_EQ(printable("/a b\xff\"\n"), "/a%20b%FF\"%0A");
  EXPECT_EQ(printable(std::string(1000, '\x01')).size(), 198U + 3U);
}

TEST(Problem, IsTheLineInJson) {
  const Reply reply = asProblem(textReply(404, "There is nothing at /api/\"x\\."));
  EXPECT_EQ(reply.content_type, "application/json");
  EXPECT_EQ(*reply.body, "{\"message\":\"There is nothing at /api/\\\"x\\\\.\"}\n");
  EXPECT_TRUE(asProblem(textReply(200, "fine")).content_type.starts_with("text/plain"));
}

TEST(RoomOfPath, ReadsTheRoom) {
  EXPECT_EQ(roomOfPath("/ws"), "");
  EXPECT_EQ(roomOfPath("/ws/"), "");
  EXPECT_EQ(roomOfPath("/ws/pool"), "pool");
  EXPECT_EQ(roomOfPath("/wsx"), std::nullopt);
  EXPECT_EQ(roomOfPath("/"), std::nullopt);
}

}  // namespace
}  // namespace spindrift::net
