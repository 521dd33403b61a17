// Sessions whose clients speak another protocol than the application: /foxglove.
#include <gtest/gtest.h>

#include "test_application.h"

namespace spindrift {
namespace {

using test::bytes;
using test::TestServer;
using test::text;

/// Says "echo open SUBPROTOCOL TOKEN" at first. Text is for the application; binary messages come back as they are,
/// through the outbox. Each message to the client is sent twice, as text and as binary; "hello" ones are left out.
class Twice final : public core::Translator {
 public:
  explicit Twice(const net::SessionOpening& opening)
      : opening_("echo open " + opening.subprotocol + " " + opening.token) {}
  Incoming open() override { return {.messages = {bytes(opening_)}, .answers = {}}; }
  Incoming receive(core::ByteView message, bool is_text) override {
    if (is_text && text(core::Bytes(message.begin(), message.end())) == "fail") throw std::runtime_error("receive");
    core::Bytes copy(message.begin(), message.end());
    if (is_text) return {.messages = {std::move(copy)}, .answers = {}};
    return {.messages = {}, .answers = {core::share(std::move(copy))}};
  }
  std::vector<Outgoing> send(core::ByteView message) override {
    const core::Bytes copy(message.begin(), message.end());
    if (text(copy).starts_with("hello")) return {};
    return {{core::share(copy), true}, {core::share(copy), false}};
  }

 private:
  std::string opening_;
};

net::ServerOptions withFoxglove(std::size_t session_max_count) {
  net::ServerOptions out;
  out.foxglove_session_max_count = session_max_count;
  return out;
}

void translate(TestServer& served) {
  served.application.make_translator = [](const net::SessionOpening& opening) {
    return opening.subprotocol.starts_with("foxglove.") ? std::make_unique<Twice>(opening) : nullptr;
  };
}

TEST(Translator, StandsBetweenTheClientAndTheApplication) {
  TestServer served(withFoxglove(16));
  translate(served);
  test::WsClient client;
  ASSERT_TRUE(
      client.connect("127.0.0.1", served.server->port(), "/foxglove/pool?access_token=a%20secret", "foxglove.sdk.v1"))
      << client.handshakeBody();
  EXPECT_EQ(client.handshakeHeader("Sec-WebSocket-Protocol"), "foxglove.sdk.v1");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(text(client.receive()), "echo open foxglove.sdk.v1 a secret");
  client.sendText("echo to the application");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(text(client.receive()), "echo to the application");
  client.sendBinary(bytes("to myself"));
  for (int i = 0; i < 2; ++i) EXPECT_EQ(text(client.receive()), "to myself");
  EXPECT_EQ(served.application.message_count, 2);
}

TEST(Translator, MessagesOfBothKindsKeepTheirOrderInLongRuns) {
  TestServer served(withFoxglove(16));
  translate(served);
  test::WsClient client;
  ASSERT_TRUE(client.connect("127.0.0.1", served.server->port(), "/foxglove", "foxglove.websocket.v1"));
  for (int i = 0; i < 2; ++i) (void)client.receive();
  client.sendText("flood 100 20");
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(text(client.receive()).starts_with(std::to_string(i / 2) + " ")) << i;
}

TEST(Translator, AFailureEndsOnlyItsSession) {
  TestServer served(withFoxglove(16));
  translate(served);
  test::WsClient client;
  ASSERT_TRUE(client.connect("127.0.0.1", served.server->port(), "/foxglove", "foxglove.sdk.v1"));
  client.sendText("fail");
  ASSERT_TRUE(client.waitClosed());
  EXPECT_EQ(client.closeCode(), 1011);
  EXPECT_TRUE(served.serves());
}

TEST(Translator, FoxglovesAddressNeedsItsSubprotocolAndTheOption) {
  const TestServer served(withFoxglove(16)), plain;
  const auto statusOf = [](const TestServer& server, const std::string& target, const std::string& subprotocol) {
    test::WsClient client;
    client.connect("127.0.0.1", server.server->port(), target, subprotocol);
    return client.handshakeStatus();
  };
  EXPECT_EQ(statusOf(served, "/foxglove", "foxglove.sdk.v1"), 101u);
  EXPECT_EQ(statusOf(served, "/foxglove?room=pool", "foxglove.websocket.v1"), 101u);
  EXPECT_EQ(statusOf(served, "/foxglove", "spindrift.v1"), 400u);
  EXPECT_EQ(statusOf(served, "/foxglove", ""), 400u);
  EXPECT_EQ(statusOf(served, "/ws", "foxglove.sdk.v1"), 400u);
  EXPECT_EQ(statusOf(served, "/foxglove/nosuch", "foxglove.sdk.v1"), 404u);
  EXPECT_EQ(statusOf(served, "/foxgloves", "foxglove.sdk.v1"), 404u);
  EXPECT_EQ(statusOf(served, "/foxglove?access_token=a&access_token=b", "foxglove.sdk.v1"), 400u);
  EXPECT_EQ(statusOf(served, "/ws?access_token=a", "spindrift.v1"), 400u);
  EXPECT_EQ(statusOf(plain, "/foxglove", "foxglove.sdk.v1"), 404u);
}

TEST(Translator, SessionsOfFoxgloveHaveALimitOfTheirOwn) {
  TestServer served(withFoxglove(1));
  translate(served);
  const auto connect = [&](test::WsClient& client) {
    return client.connect("127.0.0.1", served.server->port(), "/foxglove", "foxglove.sdk.v1");
  };
  test::WsClient first, second;
  ASSERT_TRUE(connect(first));
  EXPECT_FALSE(connect(second));
  EXPECT_EQ(second.handshakeStatus(), 503u);
  EXPECT_EQ(second.handshakeBody(),
            "The server has 1 sessions of Foxglove open, their limit: close one, or try again later.\n");
  EXPECT_TRUE(served.serves());
  first.close();
  EXPECT_TRUE(test::eventually([&] {
    test::WsClient third;
    return connect(third);
  }));
}

}  // namespace
}  // namespace spindrift
