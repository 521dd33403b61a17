#include <gtest/gtest.h>

#include <spindrift/net/client.h>

namespace spindrift::net {
namespace {

std::string socketPath(const std::string& url, const std::string& room) {
  return ClientUrl::parse(url)->inRoom(room).path;
}

TEST(ClientUrl, OfAServerLeadsToTheSocketOfARoom) {
  EXPECT_EQ(socketPath("ws://h", ""), "/ws");
  EXPECT_EQ(socketPath("ws://h:1/", "pool"), "/ws/pool");
}

TEST(ClientUrl, OfAServerBehindAPathKeepsThePath) {
  EXPECT_EQ(socketPath("wss://h/water/", ""), "/water/ws");
  EXPECT_EQ(socketPath("wss://h/a/b", "pool"), "/a/b/ws/pool");
}

TEST(ClientUrl, OfASocketStaysUnlessAnotherRoomIsNamed) {
  EXPECT_EQ(socketPath("ws://h/ws", ""), "/ws");
  EXPECT_EQ(socketPath("ws://h/ws?room=pool", ""), "/ws?room=pool");
  EXPECT_EQ(socketPath("ws://h/water/ws/wsx", ""), "/water/ws/wsx");
  EXPECT_EQ(socketPath("ws://h/ws/pool", "pond"), "/ws/pond");
  EXPECT_EQ(socketPath("ws://h/water/ws", "pond"), "/water/ws/pond");
}

}  // namespace
}  // namespace spindrift::net
