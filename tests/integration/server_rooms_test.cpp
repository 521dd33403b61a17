// Several rooms in one server, paused rooms, plain HTTP, and the shutdown.
#include <future>

#include <boost/json/parse.hpp>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class Rooms : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"lake", kStillWave}, {"pond", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }"}};
  }
};

class PausedRoom : public ServerTest {};

TEST_F(Rooms, HaveTheirOwnSceneFramesAndCommands) {
  ScriptedClient lake = client("lake");
  ScriptedClient pond = client("pond");
  EXPECT_EQ(lake.greeting().room(), "lake");
  EXPECT_EQ(pond.greeting().room(), "pond");
  EXPECT_EQ(lake.greeting().scene().wave().resolution_count(), 32u);
  EXPECT_EQ(pond.greeting().scene().wave().resolution_count(), 48u);
  lake.subscribe(v1::LAYER_SURFACE);
  pond.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(lake.apply(splash()));
  double lake_m = 0.0;
  for (int i = 0; i < 300 && lake_m < 0.05; ++i) {
    const auto frame = lake.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->surface_fixed16().resolution_count(), 32u);
    lake_m = maxElevation_m(*frame);
  }
  EXPECT_GE(lake_m, 0.05);
  for (int i = 0; i < 20; ++i) {
    const auto frame = pond.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->surface_fixed16().resolution_count(), 48u);
    EXPECT_EQ(maxElevation_m(*frame), 0.0);
  }
}

TEST_F(Rooms, SendChangesToTheirOwnClientsOnly) {
  ScriptedClient lake = client("lake");
  ScriptedClient pond = client("pond");
  ASSERT_TRUE(lake.apply(setParameter("wave.damping_per_s", 1)));
  ASSERT_TRUE(lake.apply(setSpeed(0.5)));
  EXPECT_TRUE(lake.hasReceived(v1::ServerMessage::kParameterChanged));
  EXPECT_TRUE(lake.hasReceived(v1::ServerMessage::kRoomState));
  EXPECT_FALSE(pond.hasReceived(v1::ServerMessage::kParameterChanged));
  EXPECT_FALSE(pond.hasReceived(v1::ServerMessage::kRoomState));
  EXPECT_EQ(client("pond").greeting().scene().wave().damping_per_s(), 0.1);
}

TEST_F(Rooms, PauseByThemselves) {
  ScriptedClient lake = client("lake");
  ScriptedClient pond = client("pond");
  ASSERT_TRUE(lake.apply(setPaused(true)));
  EXPECT_TRUE(pond.runFor(30));
}

TEST_F(Rooms, FirstIsTheDefault) {
  EXPECT_EQ(client().greeting().room(), "lake");
}

TEST_F(Rooms, UnknownIsRefusedWithTheNamesOfTheOthers) {
  WsClient lost;
  EXPECT_FALSE(lost.connect("127.0.0.1", server().port(), "/ws/sea"));
  EXPECT_EQ(lost.handshakeStatus(), 404u);
  const HttpAnswer answer =
      httpExchange(server().port(),
                   "GET /ws/sea HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                   "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
                   "Sec-WebSocket-Protocol: spindrift.v1\r\n\r\n");
  EXPECT_EQ(answer.status, 404u);
  EXPECT_THAT(answer.body, HasSubstr("'sea'"));
  EXPECT_THAT(answer.body, HasSubstr("lake, pond"));
}

TEST_F(Rooms, AreListedOverHttpAsTheyAreNow) {
  ASSERT_TRUE(client("pond").apply(setPaused(true)));
  const HttpAnswer answer = httpRequest(server().port(), "GET", "/api/v1/rooms");
  EXPECT_EQ(answer.status, 200u);
  const boost::json::value list = boost::json::parse(answer.body);
  const boost::json::array& rooms = list.at("rooms").as_array();
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_EQ(rooms[0].at("name").as_string(), "lake");
  EXPECT_FALSE(rooms[0].at("paused").as_bool());
  EXPECT_EQ(rooms[1].at("name").as_string(), "pond");
  EXPECT_TRUE(rooms[1].at("paused").as_bool());
}

TEST_F(Rooms, ServerAnswersProbes) {
  EXPECT_EQ(httpRequest(server().port(), "GET", "/healthz").status, 200u);
  EXPECT_EQ(httpRequest(server().port(), "GET", "/readyz").status, 200u);
  EXPECT_EQ(httpRequest(server().port(), "GET", "/api/v1/nothing").status, 404u);
}

TEST_F(PausedRoom, ShowsANewcomerItsWater) {
  const auto paused = client().apply(setPaused(true));
  ASSERT_TRUE(paused);
  ScriptedClient newcomer = client();
  EXPECT_TRUE(newcomer.greeting().room_state().paused());
  newcomer.subscribe(v1::LAYER_SURFACE);
  newcomer.subscribe(v1::LAYER_PARTICLES);
  newcomer.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto surface = newcomer.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->tick(), *paused);
  EXPECT_EQ(maxElevation_m(*surface), 0.0);
  const auto particles = newcomer.nextFrame(v1::LAYER_PARTICLES);
  ASSERT_TRUE(particles);
  EXPECT_EQ(particles->tick(), *paused);
  EXPECT_TRUE(newcomer.waitFor(v1::ServerMessage::kDiagnostics));
}

TEST_F(Rooms, StopClosesEveryClientAndThePort) {
  std::vector<ScriptedClient> clients;
  for (const char* room : {"lake", "lake", "pond"}) clients.push_back(client(room));
  clients[0].subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(clients[0].nextFrame(v1::LAYER_SURFACE));
  const std::uint16_t port = server().port();
  // The clients run only inside their calls, so the server is stopped on a thread of its own.
  auto stopped = std::async(std::launch::async, [this] { server().stop(); });
  for (ScriptedClient& one : clients) {
    EXPECT_TRUE(one.ws().waitClosed());
    EXPECT_EQ(one.ws().closeCode(), 1001);
  }
  stopped.get();
  EXPECT_EQ(server().simulation().summary().size(), 2u);
  EXPECT_FALSE(WsClient().connect("127.0.0.1", port));
  server().stop();  // a second call does no harm
}

TEST_F(Rooms, StopDoesNotWaitForASilentClient) {
  ScriptedClient deaf = client("lake");
  deaf.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(deaf.nextFrame(v1::LAYER_SURFACE));
  server().stop();  // returns although the client does not answer the close frame
  EXPECT_EQ(server().networkStats().open_session_count, 0u);
}

}  // namespace
}  // namespace spindrift::test
