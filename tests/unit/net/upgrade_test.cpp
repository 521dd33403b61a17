// The opening handshake of RFC 6455, section 4: which requests a server refuses, with which answer, and how long it
// waits.
#include <gtest/gtest.h>

#include "test_application.h"
#include "ws_frames.h"

namespace spindrift::net {
namespace {

using test::bytesOf;
using test::eventually;
using test::FrameClient;
using test::HttpAnswer;
using test::httpExchange;
using test::RawTcp;
using test::TestServer;
using test::upgradeRequest;

const std::string kVersion = "Sec-WebSocket-Version: 13\r\n";
const std::string kKey = "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n";

TEST(Upgrade, SaysWhichVersionItSpeaksToOtherVersions) {
  const TestServer served;
  for (const std::string version : {"", "Sec-WebSocket-Version: 8\r\n", "Sec-WebSocket-Version: 14\r\n",
                                    "Sec-WebSocket-Version: thirteen\r\n", "Sec-WebSocket-Version:\r\n"}) {
    const HttpAnswer answer = httpExchange(served.server->port(), upgradeRequest(version + kKey));
    EXPECT_EQ(answer.status, 426U) << version;
    EXPECT_EQ(answer.headers.at("sec-websocket-version"), "13") << version;
    EXPECT_EQ(answer.headers.at("upgrade"), "websocket") << version;
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff") << version;
  }
  EXPECT_TRUE(served.application.opened().empty());
  EXPECT_TRUE(served.serves());
}

TEST(Upgrade, ReportsAWrongVersionAsTheFault) {
  const TestServer served;
  EXPECT_EQ(httpExchange(served.server->port(), upgradeRequest(kKey)).body,
            "The upgrade has no Sec-WebSocket-Version: send version 13.\n");
  EXPECT_EQ(httpExchange(served.server->port(), upgradeRequest("Sec-WebSocket-Version: 8\r\n" + kKey)).body,
            "Sec-WebSocket-Version 8 is not supported here: send version 13.\n");
}

TEST(Upgrade, RefusesSingleHeadersThatAreRepeated) {
  const TestServer served;
  for (const std::string& twice :
       {kVersion, kKey, std::string("Host: localhost\r\n"), std::string("Origin: http://a\r\n")}) {
    const std::string more = twice.starts_with("Host") ? twice : twice + twice;
    std::string headers = more;
    if (twice != kVersion) headers += kVersion;
    if (twice != kKey) headers += kKey;
    const HttpAnswer answer = httpExchange(served.server->port(), upgradeRequest(headers));
    EXPECT_EQ(answer.status, 400U) << twice;
    EXPECT_EQ(answer.body, "There are 2 " + twice.substr(0, twice.find(':')) + " headers; send one.\n");
  }
  EXPECT_TRUE(served.application.opened().empty());
  EXPECT_TRUE(served.serves());
}

TEST(Upgrade, TakesSubprotocolsFromSeveralHeaders) {
  const TestServer served;
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(tcp.send(upgradeRequest(kVersion + kKey +
                                      "Sec-WebSocket-Protocol: other.v1\r\nSec-WebSocket-Protocol: spindrift.v1\r\n")));
  const HttpAnswer answer = test::parseAnswer(tcp.receiveUntil("\r\n\r\n"));
  EXPECT_EQ(answer.status, 101U);
  EXPECT_EQ(answer.headers.at("sec-websocket-protocol"), "spindrift.v1");
}

TEST(Upgrade, JoinsTheRoomOfTheQueryOrRefuses) {
  const TestServer served;
  const auto statusOf = [&](const std::string& target) {
    test::WsClient client;
    if (!client.connect("127.0.0.1", served.server->port(), target)) return std::to_string(client.handshakeStatus());
    return test::text(client.receive());
  };
  EXPECT_EQ(statusOf("/ws?room=pool"), "hello pool");
  EXPECT_EQ(statusOf("/ws/?room=po%6Fl&x=%zz"), "hello pool") << "what is not ours is left alone";
  EXPECT_EQ(statusOf("/ws/pool?room=pool"), "hello pool");
  EXPECT_EQ(statusOf("/ws?room="), "hello ");
  EXPECT_EQ(statusOf("/ws/pool?onlooker"), "hello pool to look");
  EXPECT_EQ(statusOf("/ws?onlookers&room=pool"), "hello pool");
  EXPECT_EQ(statusOf("/ws/pool?onlooker=%zz"), "400");
  EXPECT_EQ(statusOf("/ws?rooms=nosuch"), "hello ");
  EXPECT_EQ(statusOf("/ws?room=nosuch"), "404");
  EXPECT_EQ(statusOf("/ws/pool?room=main"), "400") << "two rooms";
  EXPECT_EQ(statusOf("/ws?room=pool&room=pool"), "400");
  EXPECT_EQ(statusOf("/ws?room=%zz"), "400");
  EXPECT_EQ(statusOf("/ws?room=pool%00"), "400");
}

TEST(Upgrade, RefusesKeysThatAreNotSixteenBytesInBase64) {
  const TestServer served;
  for (const std::string key :
       {"", "Sec-WebSocket-Key:\r\n", "Sec-WebSocket-Key: c2hvcnQ=\r\n",
        "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzISE=\r\n", "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3R*IQ==\r\n",
        "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==c3BpbmRyaWZ0IHRlc3RzIQ==\r\n"}) {
    const HttpAnswer answer = httpExchange(served.server->port(), upgradeRequest(kVersion + key));
    EXPECT_EQ(answer.status, 400U) << key;
    EXPECT_EQ(answer.body, "An upgrade needs a Sec-WebSocket-Key of 16 bytes in base64.\n") << key;
  }
  EXPECT_TRUE(served.application.opened().empty());
  EXPECT_TRUE(served.serves());
}

TEST(Upgrade, IsRefusedWithAnotherMethodOrVersionOrWithoutItsHeaders) {
  const TestServer served;
  const std::string rest = "Host: localhost\r\nConnection: close\r\n" + kVersion + kKey;
  for (const std::string& request :
       {"POST /ws HTTP/1.1\r\nUpgrade: websocket\r\n" + rest, "GET /ws HTTP/1.1\r\nUpgrade: h2c\r\n" + rest,
        "GET /ws HTTP/1.1\r\n" + rest, "GET /ws HTTP/1.0\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" + kKey}) {
    const HttpAnswer answer = httpExchange(served.server->port(), request + "\r\n");
    EXPECT_EQ(answer.status, 426U) << request;
    EXPECT_EQ(answer.headers.at("upgrade"), "websocket") << request;
  }
  EXPECT_TRUE(served.application.opened().empty());
}

TEST(Upgrade, TakesHeadersInAnyCaseAndAmongOthers) {
  const TestServer served;
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(
      tcp.send("GET /ws HTTP/1.1\r\nhost: localhost\r\nCONNECTION: keep-alive, UpGrade\r\n"
               "upgrade: WebSocket\r\nsec-websocket-version: 13\r\n"
               "sec-websocket-key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n\r\n"));
  const HttpAnswer answer = test::parseAnswer(tcp.receiveUntil("\r\n\r\n"));
  EXPECT_EQ(answer.status, 101U);
  // SHA-1 of the key and RFC 6455's GUID, in base64.
  EXPECT_EQ(answer.headers.at("sec-websocket-accept"), "PJOazg5CsVYYcpdEKqexTJxLdz8=");
  EXPECT_FALSE(answer.headers.contains("sec-websocket-extensions"));
}

TEST(Upgrade, TakesAHeaderThatComesByteByByte) {
  const TestServer served;
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  for (const char byte : upgradeRequest()) ASSERT_TRUE(tcp.send({&byte, 1}));
  EXPECT_TRUE(tcp.receiveUntil("hello ").starts_with("HTTP/1.1 101 "));
}

TEST(Upgrade, IsClosedWhenItsHeaderNeverEnds) {
  const TestServer served({.handshake_timeout = std::chrono::milliseconds(300)});
  RawTcp tcp;
  ASSERT_TRUE(tcp.connect("127.0.0.1", served.server->port()));
  ASSERT_TRUE(tcp.send("GET /ws HTTP/1.1\r\nX-Long: "));
  // Each byte arrives within the limit, but the limit applies to the whole header.
  EXPECT_TRUE(eventually([&] {
    (void)tcp.receive(1, std::chrono::milliseconds(20));
    return tcp.closed() || !tcp.send("x");
  }));
  EXPECT_TRUE(served.application.opened().empty());
  EXPECT_TRUE(served.serves());
}

TEST(Upgrade, ASessionThatNeverEndsItsFirstFrameIsEvicted) {
  TestServer served({.idle_timeout = std::chrono::milliseconds(400)});
  FrameClient client;
  ASSERT_TRUE(client.connect(served.server->port()));
  ASSERT_TRUE(client.tcp().send(bytesOf({.payload = "echo half"}).substr(0, 9)));
  EXPECT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.message_count, 0);
  EXPECT_TRUE(served.serves());
}

}  // namespace
}  // namespace spindrift::net
