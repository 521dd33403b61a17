// An edge over NATS, as a process: roles and lists of the people who use a room through it.
#include <memory>
#include <vector>

#include <gmock/gmock.h>

#include "cluster_fixture.h"
#include "commands.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(ClusterTest, RolesAreCheckedWhereTheClientConnects) {
  folder_.write("tokens", "operator operator-of-the-cluster\nplayer player-of-the-cluster\n");
  const std::string tokens = "--tokens-file '" + (folder_.path() / "tokens").string() + "'";
  const Member s1 = server("s1", tokens);
  const Member e1 = start("edge " + tokens, "e1");
  ASSERT_TRUE(eventually([&] { return httpRequest(e1.port, "GET", "/readyz").status == 200; }));
  ASSERT_TRUE(eventually([&] { return rooms(e1.port).find("main") != std::string::npos; }));
  ScriptedClient guest(e1.port);
  guest.hello();
  EXPECT_EQ(guest.rejected(splash(0.05, 0.5)).reason(), v1::REJECT_REASON_FORBIDDEN);
  ScriptedClient player(e1.port);
  player.hello({.token = "player-of-the-cluster"});
  EXPECT_TRUE(player.apply(splash(0.05, 0.5)));
  EXPECT_EQ(player.rejected(setParameter("wave.damping_per_s", 0.1)).reason(), v1::REJECT_REASON_FORBIDDEN);
  ScriptedClient stranger(e1.port);
  stranger.hello({.token = "a-token-of-nobody-at-all"});
  EXPECT_TRUE(stranger.ws().waitClosed());
  EXPECT_EQ(stranger.ws().closeCode(), 4401);
  EXPECT_EQ(post(e1.port, "/api/v1/rooms", R"({"name": "r", "scene": "pool"})").status, 403u);
}

TEST_F(ClusterTest, EdgeDecidesRolesOfRequests) {
  folder_.write("tokens", "operator operator-of-the-edge\n");
  const Member s1 = server("s1");  // its own guests are operators
  const Member e1 = edge("e1", "--guests player --tokens-file '" + (folder_.path() / "tokens").string() + "'");
  const auto statusOf = [&](const std::string& path, const std::string& body, const std::string& token) {
    const std::string headers = "Content-Type: application/json\r\n";
    return httpRequest(e1.port, "POST", path,
                       headers + (token.empty() ? "" : "Authorization: Bearer " + token + "\r\n"), body)
        .status;
  };
  const std::string commands = "/api/v1/rooms/main/commands";
  const std::string pause = R"({"setPaused": {"paused": true}})";
  EXPECT_EQ(statusOf(commands, R"({"splash": {}})", ""), 200u);
  EXPECT_EQ(statusOf(commands, pause, ""), 403u);
  EXPECT_EQ(statusOf("/api/v1/rooms", R"({"name": "r", "scene": "pool"})", ""), 403u);
  EXPECT_EQ(statusOf(commands, pause, "operator-of-the-edge"), 200u) << "the server does not know that token";
  EXPECT_EQ(statusOf(commands, pause, "a-token-of-nobody-at-all"), 401u);
  // The token of a room is known to its server only.
  const HttpAnswer opened =
      httpRequest(e1.port, "POST", "/api/v1/rooms",
                  "Content-Type: application/json\r\nAuthorization: Bearer operator-of-the-edge\r\n",
                  R"({"name": "lab", "scene": "pool", "tokens": ["ROLE_OPERATOR"]})");
  ASSERT_EQ(opened.status, 201u) << opened.body;
  const std::string of_lab(boost::json::parse(opened.body).at("tokens").as_array().at(0).at("token").as_string());
  EXPECT_EQ(statusOf("/api/v1/rooms/lab/commands", pause, of_lab), 200u);
  EXPECT_EQ(statusOf(commands, pause, of_lab), 403u);
}

TEST_F(ClusterTest, ViewersBeyondTheListAreCounted) {
  folder_.write("tokens", "operator operator-of-the-cluster\n");
  const std::string tokens = "--tokens-file '" + (folder_.path() / "tokens").string() + "'";
  const Member s1 = server("s1", tokens);
  const Member e1 = edge("e1", tokens);
  const Member e2 = edge("e2", tokens);
  ScriptedClient direct(s1.port);
  direct.hello({.token = "operator-of-the-cluster"});
  constexpr int kListedCount = 64;
  std::vector<std::unique_ptr<ScriptedClient>> crowd;
  const auto join = [&](std::uint16_t port) {
    crowd.push_back(std::make_unique<ScriptedClient>(port));
    crowd.back()->hello();
    EXPECT_NE(crowd.back()->welcome().person_id(), 0u);
  };
  const auto seesCounts = [](ScriptedClient& client, int listed_count, std::uint32_t unlisted_count) {
    return client
        .waitFor([&](const v1::ServerMessage& message) {
          return message.people().people_size() == listed_count && message.people().unlisted_count() == unlisted_count;
        })
        .has_value();
  };
  while (crowd.size() < kListedCount - 1) join(crowd.size() % 2 == 0 ? e1.port : e2.port);
  ASSERT_TRUE(seesCounts(direct, kListedCount, 0));
  ASSERT_TRUE(seesCounts(*crowd[0], kListedCount, 0));
  ASSERT_TRUE(seesCounts(*crowd[1], kListedCount, 0));
  for (int k = 0; k < 3; ++k) join(e1.port);
  for (int k = 0; k < 2; ++k) join(e2.port);
  EXPECT_TRUE(seesCounts(direct, kListedCount, 5)) << "the sum over both edges";
  EXPECT_TRUE(seesCounts(*crowd[0], kListedCount, 5));
  EXPECT_TRUE(seesCounts(*crowd.back(), kListedCount, 5)) << "those who are not listed see it, too";
  // Who comes now is told at once.
  ScriptedClient late(e2.port);
  late.hello({.token = "operator-of-the-cluster"});
  EXPECT_TRUE(late.waitFor([](const v1::ServerMessage& message) { return message.people().unlisted_count() == 5; }));
  for (const std::uint16_t port : {s1.port, e1.port, e2.port}) {
    EXPECT_THAT(httpRequest(port, "GET", "/api/v1/rooms/main/people").body, HasSubstr("\"unlisted_count\":5"));
    EXPECT_TRUE(eventually([&] { return rooms(port).find("\"session_count\":70") != std::string::npos; }))
        << rooms(port);
  }
  crowd.resize(crowd.size() - 3);
  EXPECT_TRUE(seesCounts(direct, kListedCount + 1, 2));
  EXPECT_TRUE(seesCounts(late, kListedCount + 1, 2));
}

TEST_F(ClusterTest, AnOnlookerThroughAnEdgeIsNobodyOfTheRoom) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient picture(e1.port, "main?onlooker");
  picture.hello();
  picture.subscribe(packedSurface());
  ASSERT_TRUE(picture.nextFrame(v1::LAYER_SURFACE));
  EXPECT_EQ(picture.welcome().person_id(), 0U);
  EXPECT_THAT(httpRequest(s1.port, "GET", "/api/v1/rooms/main/people").body, Not(HasSubstr("guest")));
  EXPECT_TRUE(eventually([&] { return rooms(e1.port).find("\"session_count\":1") != std::string::npos; }));
  EXPECT_THAT(rooms(e1.port), HasSubstr("\"people_count\":0"));
  // Longer than an edge keeps a room without sessions.
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(13);
  while (std::chrono::steady_clock::now() < until) ASSERT_TRUE(picture.nextFrame(v1::LAYER_SURFACE));
}

}  // namespace
}  // namespace spindrift::test
