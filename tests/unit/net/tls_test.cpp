// The port with TLS: what it speaks, and what hostile or clumsy peers get.
#include <filesystem>

#include <gmock/gmock.h>

#include <spindrift/net/client.h>

#include "certificates.h"
#include "temporary_folder.h"
#include "test_application.h"
#include "tls_client.h"

namespace spindrift::net {
namespace {

using namespace std::chrono_literals;
using test::bytes;
using test::eventually;
using test::HttpAnswer;
using test::RawTcp;
using test::TlsTcp;
using testing::HasSubstr;
using testing::StartsWith;

std::size_t descriptorCount() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

class Tls : public testing::Test {
 protected:
  /// Returns a server that speaks TLS; it lives as long as the test.
  test::TestServer& start(ServerOptions options = {}) {
    options.tls = TlsFiles{files_.certificate, files_.key};
    served_ = std::make_unique<test::TestServer>(options);
    return *served_;
  }
  std::uint16_t port() const { return served_->server->port(); }
  ServerStats stats() const { return served_->server->stats(); }
  /// Returns whether a new client is served.
  bool serves() const { return test::tlsRequest(port(), "GET", "/healthz").body == "ok\n"; }
  const test::CertificateFiles& files() const { return files_; }

 private:
  test::TemporaryFolder folder_;
  const test::CertificateFiles files_ = test::writeCertificate(folder_.path(), "server");
  std::unique_ptr<test::TestServer> served_;
};

TEST_F(Tls, ServesHttpByVersions12And13) {
  start();
  for (const auto& [wish, version] : {std::pair("", "TLSv1.3"), std::pair("1.2", "TLSv1.2")}) {
    TlsTcp client;
    ASSERT_TRUE(client.connect(port(), {.version_max = wish})) << client.error();
    EXPECT_EQ(client.version(), version);
    ASSERT_TRUE(client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
    bool was_closed = false;
    EXPECT_THAT(client.receiveAll(&was_closed), testing::AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("ok\n")));
    EXPECT_TRUE(was_closed) << "the end of the reply is distinguished from a cut";
  }
  EXPECT_EQ(stats().tls_handshake_count, 2u);
}

TEST_F(Tls, RefusesOlderVersions) {
  start();
  TlsTcp client;
  EXPECT_FALSE(client.connect(port(), {.version_max = "1.1"}));
  EXPECT_THAT(client.error(), HasSubstr("protocol version"));
  EXPECT_TRUE(eventually([&] { return stats().failed_tls_handshake_count == 1; }));
}

TEST_F(Tls, ChoosesHttp11AndRefusesClientsThatSpeakOnlyOtherProtocols) {
  start();
  TlsTcp client;
  ASSERT_TRUE(client.connect(port(), {.protocols = "http/1.1"}));
  EXPECT_EQ(client.protocol(), "http/1.1");
  TlsTcp newer;
  EXPECT_FALSE(newer.connect(port(), {.protocols = "h2"}));
  EXPECT_THAT(newer.error(), HasSubstr("no application protocol"));
}

TEST_F(Tls, PlainHttpIsAnsweredWithTheReason) {
  start();
  const HttpAnswer answer = test::httpRequest(port(), "GET", "/healthz");
  EXPECT_EQ(answer.status, 400u);
  EXPECT_EQ(answer.body, "This port speaks TLS: use https:// and wss://.\n");
  EXPECT_TRUE(serves());
}

TEST_F(Tls, ConnectionsStayOpenForFurtherRequests) {
  start();
  TlsTcp client;
  ASSERT_TRUE(client.connect(port()));
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(client.send("GET /api/echo?" + std::to_string(k) + " HTTP/1.1\r\nHost: localhost\r\n\r\n"));
    EXPECT_THAT(client.receiveUntil("GET " + std::to_string(k) + " "), StartsWith("HTTP/1.1 200"));
  }
  EXPECT_EQ(stats().tls_handshake_count, 1u);
}

TEST_F(Tls, ARefusedRequestGetsItsReply) {
  start({.request_body_max_bytes = 16});
  TlsTcp client;
  ASSERT_TRUE(client.connect(port()));
  ASSERT_TRUE(client.send("POST /api/echo HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000\r\n\r\n"));
  (void)client.send(std::string(60'000, 'x'));  // the server may have refused already
  EXPECT_THAT(client.receiveAll(), StartsWith("HTTP/1.1 413"));
}

TEST_F(Tls, APeerGetsTheCloseFrameWhileItIsStillSending) {
  start({.read_message_max_bytes = 1000});
  TlsTcp client;
  ASSERT_TRUE(client.connect(port()));
  ASSERT_TRUE(
      client.send("GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: "
                  "websocket\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n\r\n"));
  EXPECT_THAT(client.receiveUntil("hello "), StartsWith("HTTP/1.1 101 "));
  ASSERT_TRUE(client.send(std::string("\x82\xff\0\0\0\0\0\x10\0\0\0\0\0\0", 14)));  // a message of 1 MiB
  for (int k = 0; k < 16; ++k) ASSERT_TRUE(client.send(std::string(64 * 1024, 'x'))) << "after " << k << " of 16 parts";
  EXPECT_THAT(client.receiveAll(), testing::EndsWith(std::string("\x88\x02\x03\xf1", 4))) << "code 1009";
}

TEST_F(Tls, SessionsGetFramesOfAnySizeAndTheirAnswersInOrder) {
  test::TestServer& served = start();
  const auto pool = ClientPool::create(1, files().certificate);
  std::mutex mutex;
  std::vector<core::Bytes> received;
  std::atomic<std::uint16_t> close_code{0};
  const auto url = ClientUrl::parse("wss://localhost:" + std::to_string(port()) + "/ws/pool");
  const auto client = pool->connect(*url, {},
                                    {.opened = [] {},
                                     .message =
                                         [&](core::ByteView message) {
                                           const std::lock_guard lock(mutex);
                                           received.emplace_back(message.begin(), message.end());
                                         },
                                     .closed = [&](std::uint16_t code, const std::string&) { close_code = code; }});
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return received.size();
  };
  client->send(test::shared("watch 1 1000000"));
  ASSERT_TRUE(eventually([&] { return count() == 2; }));
  for (const std::size_t size_bytes : {1u, 125u, 126u, 1023u, 1024u, 16'383u, 16'384u, 65'535u, 65'536u, 3'000'000u}) {
    core::Bytes frame(size_bytes);
    for (std::size_t k = 0; k < size_bytes; ++k) frame[k] = static_cast<std::uint8_t>(k * 31 + k / 251);
    const std::size_t before = count();
    served.server->hub().publish("pool", 1, {core::share(core::Bytes(frame)), {}});
    ASSERT_TRUE(eventually([&] { return count() > before; })) << size_bytes;
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(received.back() == frame) << size_bytes;
  }
  const std::size_t before = count();
  client->send(test::shared("flood 300 5000"));
  ASSERT_TRUE(eventually([&] { return count() == before + 300; }));
  {
    const std::lock_guard lock(mutex);
    for (std::size_t k = 0; k < 300; ++k) {
      EXPECT_THAT(std::string(received[before + k].begin(), received[before + k].begin() + 4),
                  StartsWith(std::to_string(k)));
    }
  }
  served.server->stop();
  EXPECT_TRUE(eventually([&] { return close_code == 1001; }));
  EXPECT_EQ(served.application.closed().front().end.code, 1001);
}

TEST_F(Tls, GarbageIsClosedAndCounted) {
  start({.handshake_timeout = 500ms});  // one of them announces more than it sends
  const std::string garbage = "\x16\x03\x01 this is not a hello of a client, whatever its first byte says";
  for (const std::string& words : {garbage, std::string("\x80\x2e\x01\x00\x02", 5), std::string("\0\0\0\0", 4)}) {
    RawTcp peer;
    ASSERT_TRUE(peer.connect("127.0.0.1", port()));
    ASSERT_TRUE(peer.send(words));
    (void)peer.receiveAll();
    EXPECT_TRUE(peer.closed());
  }
  EXPECT_TRUE(eventually([&] { return stats().failed_tls_handshake_count == 3; }));
  EXPECT_TRUE(serves());
}

TEST_F(Tls, ARecordOverTheLimitIsRefused) {
  start();
  RawTcp peer;
  ASSERT_TRUE(peer.connect("127.0.0.1", port()));
  ASSERT_TRUE(peer.send(std::string("\x16\x03\x01\xff\xff", 5) + std::string(1000, '\x01')));
  (void)peer.receiveAll();
  EXPECT_TRUE(peer.closed());
  TlsTcp client;  // the same after the handshake, below the layer
  ASSERT_TRUE(client.connect(port()));
  EXPECT_TRUE(serves());
}

TEST_F(Tls, AHandshakeThatTakesTooLongIsCut) {
  start({.handshake_timeout = 300ms});
  RawTcp silent, slow;
  ASSERT_TRUE(silent.connect("127.0.0.1", port()));
  ASSERT_TRUE(slow.connect("127.0.0.1", port()));
  const auto begin = std::chrono::steady_clock::now();
  // A byte from time to time does not extend the time.
  bool is_open = slow.send(std::string("\x16\x03\x01\x02\x00\x01", 6));
  while (is_open && std::chrono::steady_clock::now() - begin < test::kPatience) {
    std::this_thread::sleep_for(50ms);
    is_open = slow.send("\x01") && slow.receive(1, 1ms).empty() && !slow.closed();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, test::kPatience);
  (void)silent.receiveAll();
  EXPECT_TRUE(silent.closed());
  EXPECT_TRUE(eventually([&] { return stats().failed_tls_handshake_count == 2; }));
  EXPECT_TRUE(serves());
}

TEST_F(Tls, PeersThatLeaveInTheHandshakeLeaveNothingBehind) {
  start();
  EXPECT_TRUE(serves());
  const std::size_t before = descriptorCount();
  for (int k = 0; k < 200; ++k) {
    RawTcp peer;
    ASSERT_TRUE(peer.connect("127.0.0.1", port()));
    if (k % 3 > 0) (void)peer.send("\x16");
    if (k % 3 > 1) (void)peer.send(std::string("\x03\x01\x01\x00\x01\x00\x00\xfc", 8));
  }
  EXPECT_TRUE(eventually([&] { return descriptorCount() <= before; }));
  EXPECT_TRUE(serves());
}

TEST_F(Tls, HandshakesCountForTheLimitOfTheirAddress) {
  start({.address_requests_per_s = 1e-3, .address_request_burst_count = 3.0});
  EXPECT_TRUE(serves()) << "a handshake and a request";
  TlsTcp third;
  EXPECT_TRUE(third.connect(port()));
  TlsTcp fourth;
  EXPECT_FALSE(fourth.connect(port()));
  EXPECT_EQ(stats().refused_count[static_cast<std::size_t>(Refused::kRate)], 1u);
}

TEST_F(Tls, StopDoesNotWaitForHalfAHandshake) {
  test::TestServer& served = start({.handshake_timeout = 60s, .close_timeout = 10s});
  RawTcp silent, half;
  ASSERT_TRUE(silent.connect("127.0.0.1", port()));
  ASSERT_TRUE(half.connect("127.0.0.1", port()));
  ASSERT_TRUE(half.send(std::string("\x16\x03\x01\x02\x00\x01", 6)));
  TlsTcp keep_alive;
  ASSERT_TRUE(keep_alive.connect(port()));
  const auto begin = std::chrono::steady_clock::now();
  served.server->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
}

}  // namespace
}  // namespace spindrift::net
