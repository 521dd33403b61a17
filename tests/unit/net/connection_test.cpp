// Plain HTTP over loopback, from browsers and from other programs.
#include <random>

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include "test_application.h"

namespace spindrift::net {
namespace {

using test::HttpAnswer;
using test::httpExchange;
using test::httpRequest;
using test::parseAnswer;
using test::RawTcp;
using test::TestServer;
using namespace std::string_view_literals;

struct ConnectionTest : testing::Test {
  test::TemporaryFolder folder;

  void SetUp() override {
    folder.write("index.html", "<h1>water</h1>");
    folder.write("assets/main-abc.js", std::string(3'000'000, ';'));
  }
  ServerOptions options() const { return {.web_root = folder.path().string()}; }
};

TEST_F(ConnectionTest, ServesThePageWithItsHeaders) {
  const TestServer served(options());
  const HttpAnswer answer = httpRequest(served.server->port(), "GET", "/");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.body, "<h1>water</h1>");
  EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(answer.headers.at("cache-control"), "no-cache");
  EXPECT_EQ(answer.headers.at("content-security-policy"),
            "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src "
            "'self' data: blob:; "
            "worker-src 'self' "
            "blob:; connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(answer.headers.at("referrer-policy"), "no-referrer");
  EXPECT_EQ(answer.headers.at("cross-origin-opener-policy"), "same-origin");
  EXPECT_EQ(answer.headers.at("x-frame-options"), "DENY");
}

TEST_F(ConnectionTest, LetsListedPagesEmbedThePageWithoutPanelsAndNothingElse) {
  ServerOptions listed = options();
  listed.embedding_origins = {"https://school.example", "http://localhost:5173"};
  const TestServer served(listed);
  const auto policy = [&](const std::string& target) {
    return httpRequest(served.server->port(), "GET", target).headers.at("content-security-policy");
  };
  const auto isDenied = [&](const std::string& target) {
    return httpRequest(served.server->port(), "GET", target).headers.contains("x-frame-options");
  };
  for (const std::string target : {"/?embed", "/?embed=", "/?room=pool&embed&view=side"}) {
    EXPECT_NE(policy(target).find("; frame-ancestors https://school.example http://localhost:5173; base-uri 'none';"),
              std::string::npos)
        << target << ": " << policy(target);
    EXPECT_FALSE(isDenied(target)) << target;
  }
  for (const std::string target :
       {"/", "/?room=embed", "/?embedded", "/pad?embed", "/index.html?embed", "/api/echo?embed", "/nothing?embed"}) {
    EXPECT_NE(policy(target).find("; frame-ancestors 'none';"), std::string::npos) << target;
    EXPECT_TRUE(isDenied(target)) << target;
  }
  const std::string etag = httpRequest(served.server->port(), "GET", "/?embed").headers.at("etag");
  const HttpAnswer cached = httpRequest(served.server->port(), "GET", "/?embed", "If-None-Match: " + etag + "\r\n");
  EXPECT_EQ(cached.status, 304U);
  EXPECT_NE(cached.headers.at("content-security-policy").find("https://school.example"), std::string::npos)
      << "a browser takes over the headers of a 304";
}

TEST_F(ConnectionTest, LetsNobodyEmbedThePageByDefault) {
  const TestServer served(options());
  const HttpAnswer answer = httpRequest(served.server->port(), "GET", "/?embed");
  EXPECT_NE(answer.headers.at("content-security-policy").find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_EQ(answer.headers.at("x-frame-options"), "DENY");
}

TEST_F(ConnectionTest, LetsEveryPageLoadTheElementAndNoOtherFile) {
  folder.write("element.js", "export {};");
  const TestServer served(options());
  const HttpAnswer element = httpRequest(served.server->port(), "GET", "/element.js");
  EXPECT_EQ(element.status, 200U);
  EXPECT_EQ(element.headers.at("content-type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(element.headers.at("access-control-allow-origin"), "*");
  EXPECT_EQ(element.headers.at("cross-origin-resource-policy"), "cross-origin");
  EXPECT_EQ(element.headers.at("cache-control"), "no-cache");
  for (const std::string target : {"/", "/?embed", "/assets/main-abc.js"}) {
    const HttpAnswer other = httpRequest(served.server->port(), "GET", target);
    EXPECT_FALSE(other.headers.contains("access-control-allow-origin")) << target;
    EXPECT_FALSE(other.headers.contains("cross-origin-resource-policy")) << target;
  }
}

TEST_F(ConnectionTest, ServesALargeFileWhole) {
  const TestServer served(options());
  const HttpAnswer answer = httpRequest(served.server->port(), "GET", "/assets/main-abc.js");
  EXPECT_EQ(answer.headers.at("content-length"), "3000000");
  EXPECT_EQ(answer.body, std::string(3'000'000, ';'));
}

TEST_F(ConnectionTest, AnswersHeadWithoutTheBody) {
  const TestServer served(options());
  const HttpAnswer answer = httpRequest(served.server->port(), "HEAD", "/");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.headers.at("content-length"), "14");
  EXPECT_EQ(answer.body, "");
}

TEST_F(ConnectionTest, AnswersNotModifiedWithoutTheBody) {
  const TestServer served(options());
  const std::string etag = httpRequest(served.server->port(), "GET", "/").headers.at("etag");
  const HttpAnswer answer = httpRequest(served.server->port(), "GET", "/", "If-None-Match: " + etag + "\r\n");
  EXPECT_EQ(answer.status, 304U);
  EXPECT_EQ(answer.body, "");
  EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
}

TEST_F(ConnectionTest, KeepsAConnectionForTheNextRequest) {
  const TestServer served(options());
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(
      tcp.send("HEAD / HTTP/1.1\r\nHost: a\r\n\r\nGET /healthz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n"));
  const std::string both = tcp.receiveAll();
  EXPECT_TRUE(tcp.closed());
  EXPECT_EQ(parseAnswer(both).status, 200U);
  EXPECT_EQ(parseAnswer(parseAnswer(both).body).body, "ok\n");
}

TEST_F(ConnectionTest, HandsTheApplicationItsRequests) {
  const TestServer served(options());
  EXPECT_EQ(httpRequest(served.server->port(), "POST", "/api/echo?a=1", "", "body").body, "POST a=1 body");
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/none").status, 404U);
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/api/throw").status, 500U);
  EXPECT_TRUE(served.serves());
}

TEST_F(ConnectionTest, FindsNothingOutsideTheWebRoot) {
  const TestServer served(options());
  for (const char* target : {"/../../../../../etc/passwd", "/%2e%2e/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                             "/assets/%2e%2e/index.html"}) {
    EXPECT_EQ(httpRequest(served.server->port(), "GET", target).status, 404U) << target;
  }
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/index.html%00.js").status, 400U);
  EXPECT_EQ(httpRequest(served.server->port(), "GET", std::string("/index\0.html", 12)).status, 400U);
}

TEST_F(ConnectionTest, AnswersABadRequestWithTheReason) {
  ServerOptions small = options();
  small.request_body_max_bytes = 100;
  const TestServer served(small);
  const auto port = served.server->port();
  EXPECT_EQ(httpRequest(port, "DELETE", "/").status, 405U);
  EXPECT_EQ(httpExchange(port, "hello water\r\n\r\n").status, 400U);
  const HttpAnswer too_big = httpRequest(port, "POST", "/api/echo", "", std::string(101, 'x'));
  EXPECT_EQ(too_big.status, 413U);
  EXPECT_EQ(too_big.body, "{\"message\":\"The request's body is larger than 100 bytes.\"}\n");
  const HttpAnswer too_long = httpRequest(port, "GET", "/", "X-Long: " + std::string(20'000, 'x') + "\r\n");
  EXPECT_EQ(too_long.status, 431U);
  EXPECT_EQ(too_long.body, "The request's header is larger than 16384 bytes.\n");
  EXPECT_EQ(httpRequest(port, "GET", "/ws").status, 426U);
}

TEST_F(ConnectionTest, RefusesEveryFormOfChunkedBody) {
  const TestServer served(options());
  const std::string head = "POST /api/echo HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(httpExchange(served.server->port(), head + "4\r\nbody\r\n0\r\n\r\n").status, 411U);
  // A chunk line without an end must not be stored without limit.
  EXPECT_EQ(httpExchange(served.server->port(), head + "4;" + std::string(100'000, 'x')).status, 411U);
  // Boost's parser would fail an assertion on this input: the last chunk's line, then single bytes.
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  for (const std::string_view piece : {std::string_view(head), "0\r\n"sv, "\r"sv, "\n"sv}) {
    (void)tcp.send(piece);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(parseAnswer(tcp.receiveAll()).status, 411U);
  EXPECT_TRUE(served.serves());
}

TEST_F(ConnectionTest, RefusesEveryOtherTransferEncoding) {
  const TestServer served(options());
  for (const char* coding : {"identity", "gzip", "xchunked", "\"chunked\"", "chunked, identity", ""}) {
    // A reader that takes the coding for "chunked" finds a second request behind the last chunk.
    const std::string body = "0\r\n\r\nGET /healthz HTTP/1.1\r\nHost: a\r\n\r\n";
    const std::string headers = std::string("Host: a\r\nTransfer-Encoding: ") + coding +
                                "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n";
    for (const char* line : {"POST /api/echo HTTP/1.1\r\n", "GET /healthz HTTP/1.1\r\n"}) {
      RawTcp tcp;
      ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
      ASSERT_TRUE(tcp.send(line + headers + body));
      const std::string answer = tcp.receiveAll();
      EXPECT_EQ(test::parseAnswer(answer).status, 400U) << coding;
      EXPECT_EQ(answer.find("HTTP/1.1 200"), std::string::npos) << coding;
    }
  }
  EXPECT_TRUE(served.serves());
}

TEST_F(ConnectionTest, RequiresExactlyOneHostPerHttp11Request) {
  const TestServer served(options());
  const auto ask = [&](const std::string& version, const std::string& headers) {
    return httpExchange(served.server->port(),
                        "GET /healthz HTTP/" + version + "\r\nConnection: close\r\n" + headers + "\r\n");
  };
  EXPECT_EQ(ask("1.1", "").status, 400U);
  EXPECT_EQ(ask("1.1", "").body, "An HTTP/1.1 request needs a Host header.\n");
  EXPECT_EQ(ask("1.1", "Host: a\r\nHost: a\r\n").status, 400U);
  EXPECT_EQ(ask("1.1", "Host: a b\r\n").status, 400U);
  EXPECT_EQ(ask("1.1", "Host: a/b\r\n").status, 400U);
  EXPECT_EQ(ask("1.1", "Host: user@a\r\n").status, 400U);
  for (const char* host : {"Host: a\r\n", "Host:\r\n", "Host: [::1]:8080\r\n", "Host: b%C3%A9a_r.example:1\r\n"}) {
    EXPECT_EQ(ask("1.1", host).status, 200U) << host;
  }
  EXPECT_EQ(ask("1.0", "").status, 200U) << "HTTP/1.0 knows no Host";
}

TEST_F(ConnectionTest, AnswersRestErrorsOfItsOwnAsProblems) {
  ServerOptions small = options();
  small.request_body_max_bytes = 100;
  small.answer_timeout = std::chrono::milliseconds(50);
  const TestServer served(small);
  const auto ask = [&](const std::string& method, const std::string& target, const std::string& headers = "") {
    return httpRequest(served.server->port(), method, target, headers);
  };
  const std::vector<std::pair<unsigned, HttpAnswer>> answers{
      {400, ask("GET", "/api/%zz")},
      {403, ask("POST", "/api/echo", "Origin: http://evil.example\r\nContent-Length: 0\r\n")},
      {404, ask("GET", "/api/nothing/\"here\"")},
      {405, ask("TRACE", "/api/echo")},
      {411, ask("POST", "/api/echo")},
      {411, ask("POST", "/api/echo", "Transfer-Encoding: chunked\r\n")},
      {413, ask("POST", "/api/echo", "Content-Length: 101\r\n")},
      {500, ask("GET", "/api/forget")},
      {504, ask("GET", "/api/keep")}};
  for (const auto& [status, answer] : answers) {
    EXPECT_EQ(answer.status, status);
    EXPECT_EQ(answer.headers.at("content-type"), "application/json") << status;
    EXPECT_TRUE(answer.body.starts_with("{\"message\":\"") && answer.body.ends_with("\"}\n")) << answer.body;
  }
  EXPECT_TRUE(ask("GET", "/nothing").headers.at("content-type").starts_with("text/plain"));
  EXPECT_EQ(ask("POST", "/api/echo", "Content-Length: 0\r\n").status, 200U) << "no content, and it says so";
}

TEST_F(ConnectionTest, OpensRestToListedPagesAndToNoOthers) {
  ServerOptions listed = options();
  listed.allowed_origins = {"https://water.example"};
  const TestServer served(listed);
  const std::string good = "Origin: https://water.example\r\n", evil = "Origin: https://evil.example\r\n";
  const auto preflight = [&](const std::string& origin, const std::string& target) {
    return httpRequest(
        served.server->port(), "OPTIONS", target,
        origin + "Access-Control-Request-Method: POST\r\nAccess-Control-Request-Headers: content-type\r\n");
  };
  const HttpAnswer allowed = preflight(good, "/api/echo");
  EXPECT_EQ(allowed.status, 204U);
  EXPECT_EQ(allowed.headers.at("access-control-allow-origin"), "https://water.example");
  EXPECT_EQ(allowed.headers.at("access-control-allow-methods"), "GET, HEAD, POST, DELETE");
  EXPECT_EQ(allowed.headers.at("access-control-allow-headers"), "Authorization, Content-Type");
  EXPECT_EQ(allowed.headers.at("vary"), "Origin");
  EXPECT_FALSE(allowed.headers.contains("content-length"));
  const HttpAnswer refused = preflight(evil, "/api/echo");
  EXPECT_EQ(refused.status, 403U);
  EXPECT_FALSE(refused.headers.contains("access-control-allow-origin"));
  EXPECT_FALSE(preflight(good, "/healthz").headers.contains("access-control-allow-origin")) << "REST alone";

  // The page may read the answers to its requests, errors included.
  const auto ask = [&](const std::string& method, const std::string& target, const std::string& headers) {
    return httpRequest(served.server->port(), method, target,
                       headers + (method == "POST" ? "Content-Length: 0\r\n" : ""));
  };
  for (const std::string target : {"/api/echo", "/api/nothing"}) {
    EXPECT_EQ(ask("POST", target, good).headers.at("access-control-allow-origin"), "https://water.example") << target;
  }
  EXPECT_FALSE(ask("GET", "/api/echo", evil).headers.contains("access-control-allow-origin"));
  EXPECT_EQ(ask("GET", "/api/echo", "").headers.at("vary"), "Origin") << "for caches";
}

TEST_F(ConnectionTest, ReadsABodyThatComesInPieces) {
  const TestServer served(options());
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  const std::string request =
      "POST /api/echo?p HTTP/1.1\r\nHost: a\r\nConnection: close\r\nContent-Length: 4\r\n\r\nbody";
  for (const char byte : request) ASSERT_TRUE(tcp.send({&byte, 1}));
  EXPECT_EQ(parseAnswer(tcp.receiveAll()).body, "POST p body");
}

TEST_F(ConnectionTest, ContinuesAClientThatWaitsBeforeItsBody) {
  const TestServer served(options());
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(
      tcp.send("POST /api/echo?p HTTP/1.1\r\nHost: a\r\nConnection: close\r\nExpect: 100-Continue\r\nContent-Length: "
               "4\r\n\r\n"));
  constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  EXPECT_EQ(tcp.receive(kContinue.size()), kContinue);
  ASSERT_TRUE(tcp.send("body"));
  EXPECT_EQ(parseAnswer(tcp.receiveAll()).body, "POST p body");
}

TEST_F(ConnectionTest, AnswersAClientThatWaitsAtOnceWhereItRefusesTheHead) {
  ServerOptions small = options();
  small.request_body_max_bytes = 100;
  const TestServer served(small);
  const auto answerTo = [&](const std::string& headers) {
    RawTcp tcp;
    EXPECT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
    EXPECT_TRUE(tcp.send("POST /api/echo HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + headers + "\r\n"));
    return parseAnswer(tcp.receiveAll()).status;
  };
  EXPECT_EQ(answerTo("Expect: 100-continue\r\nContent-Length: 101\r\n"), 413U);
  EXPECT_EQ(answerTo("Expect: 100-continue\r\nContent-Length: 4\r\nOrigin: https://evil.example\r\n"), 403U);
  EXPECT_EQ(answerTo("Expect: 100-continue\r\n"), 411U);
  EXPECT_EQ(answerTo("Expect: the-unexpected\r\nContent-Length: 4\r\n"), 417U);
}

TEST_F(ConnectionTest, SendsNoContinueToClientsThatDoNotWait) {
  const TestServer served(options());
  const std::string with_body =
      "POST /api/echo HTTP/1.1\r\nHost: a\r\nConnection: close\r\nExpect: 100-continue\r\nContent-Length: "
      "4\r\n\r\nbody";
  EXPECT_EQ(httpExchange(served.server->port(), with_body).status, 200U) << "the body came with the head";
  const std::string empty =
      "POST /api/echo HTTP/1.1\r\nHost: a\r\nConnection: close\r\nExpect: 100-continue\r\n"
      "Content-Length: 0\r\n\r\n";
  EXPECT_EQ(httpExchange(served.server->port(), empty).status, 200U);
  const std::string old = "POST /api/echo HTTP/1.0\r\nContent-Length: 0\r\n\r\n";
  EXPECT_EQ(httpExchange(served.server->port(), old).status, 200U);
}

TEST_F(ConnectionTest, AcceptsTargetsInAbsoluteForm) {
  const TestServer served(options());
  const auto port = served.server->port();
  EXPECT_EQ(httpRequest(port, "GET", "http://localhost/api/echo?x").body, "GET x ");
  EXPECT_EQ(httpRequest(port, "GET", "HTTPS://localhost:443/healthz").body, "ok\n");
  EXPECT_EQ(httpRequest(port, "GET", "http://localhost").body, "<h1>water</h1>") << "an empty path is /";
  EXPECT_EQ(httpRequest(port, "GET", "http://localhost?x").status, 200U);
  EXPECT_EQ(httpRequest(port, "POST", "http://localhost/api/echo").status, 411U) << "the API's rules hold";
  EXPECT_EQ(httpRequest(port, "GET", "http:///healthz").status, 400U) << "no host";
  EXPECT_EQ(httpRequest(port, "GET", "http://user@localhost/healthz").status, 400U);
  EXPECT_EQ(httpRequest(port, "GET", "ftp://localhost/healthz").status, 400U);
  EXPECT_EQ(
      httpRequest(port, "POST", "http://evil.example/api/echo", "Origin: http://localhost\r\nContent-Length: 0\r\n")
          .status,
      403U)
      << "the target's host counts, not that of the header";
}

TEST_F(ConnectionTest, AnswersTheChecksOfLoadBalancers) {
  const TestServer served(options());
  const auto port = served.server->port();
  EXPECT_EQ(httpExchange(port, "OPTIONS /healthz HTTP/1.0\r\n\r\n").status, 200U) << "as HAProxy asks";
  EXPECT_EQ(httpExchange(port, "OPTIONS / HTTP/1.0\r\n\r\n").status, 204U);
  EXPECT_EQ(httpRequest(port, "OPTIONS", "*").status, 204U);
}

TEST_F(ConnectionTest, RandomBytesDoNoHarm) {
  const TestServer served(options());
  std::mt19937 random(42);
  for (int k = 0; k < 200; ++k) {
    RawTcp tcp;
    ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
    std::string noise(1 + random() % 2000, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    (void)tcp.send(noise);
  }
  EXPECT_TRUE(served.serves());
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/").status, 200U);
}

TEST_F(ConnectionTest, ClosesRequestsThatNeverEnd) {
  ServerOptions hurried = options();
  hurried.handshake_timeout = std::chrono::milliseconds(300);
  const TestServer served(hurried);
  std::vector<RawTcp> slow(30);
  for (RawTcp& tcp : slow) {
    ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
    ASSERT_TRUE(tcp.send("GET / HTTP/1.1\r\nHost: "));
  }
  EXPECT_EQ(httpRequest(served.server->port(), "GET", "/").status, 200U) << "others are served meanwhile";
  for (RawTcp& tcp : slow) {
    (void)tcp.receiveAll();
    EXPECT_TRUE(tcp.closed());
  }
}

}  // namespace
}  // namespace spindrift::net
