// Servers and edges over NATS, as processes: what clients see, and what happens when a part dies.
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/codec/frame_decoder.h>

#include "cluster_fixture.h"
#include "commands.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

v1::Subscribe packed(v1::Layer layer) {
  v1::Subscribe out;
  out.set_layer(layer);
  out.set_max_rate_hz(60.0);
  out.set_packing(v1::PACKING_PACKED);
  return out;
}

/// Whether every delta among the frames builds on the frame before it.
testing::AssertionResult areContinuous(ScriptedClient& client, int count) {
  std::uint64_t last_tick = 0;
  for (int k = 0; k < count; ++k) {
    const auto frame = client.nextFrame(v1::LAYER_SURFACE);
    if (!frame) return testing::AssertionFailure() << "frame " << k << " did not come";
    if (k == 0 && !frame->keyframe()) return testing::AssertionFailure() << "the first frame is a delta";
    if (!frame->keyframe() && frame->base_tick() != last_tick) {
      return testing::AssertionFailure() << "the delta of tick " << frame->tick() << " builds on tick "
                                         << frame->base_tick() << ", not on " << last_tick;
    }
    last_tick = frame->tick();
  }
  return testing::AssertionSuccess();
}

TEST_F(ClusterTest, AnEdgeServesARoomLikeItsServer) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient ada(e1.port);
  ASSERT_TRUE(ada.isOpen());
  EXPECT_EQ(ada.greeting().room(), "main");
  EXPECT_EQ(ada.greeting().scene().wave().resolution_count(), 64u);
  ada.hello({.name = "Ada"});
  EXPECT_EQ(ada.welcome().role(), v1::ROLE_OPERATOR);
  ada.subscribe(packed(v1::LAYER_SURFACE));
  EXPECT_TRUE(areContinuous(ada, 40));
  EXPECT_TRUE(ada.apply(splash(0.05, 0.5)));
  EXPECT_EQ(ada.rejected(setParameter("wave.damping_per_s", -1)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);

  // Another client, at the server itself: each sees what the other does.
  ScriptedClient ben(s1.port, "main");
  ben.hello({.name = "Ben"});
  const auto people = ada.waitFor([](const v1::ServerMessage& message) { return message.people().people_size() == 2; });
  ASSERT_TRUE(people);
  ASSERT_TRUE(ben.apply(spawnBoat(1.0, 0.0)));
  EXPECT_TRUE(ada.waitFor([](const v1::ServerMessage& message) { return message.boat_list().boats_size() == 1; }));
  ASSERT_TRUE(ada.apply(setPaused(true)));
  EXPECT_TRUE(ben.waitFor([](const v1::ServerMessage& message) { return message.room_state().paused(); }));

  // A late one gets the present state, and frames although the water stands still.
  ScriptedClient late(e1.port, "main");
  EXPECT_TRUE(late.greeting().room_state().paused());
  EXPECT_EQ(late.greeting().boat_list().boats_size(), 1);
  late.hello();
  late.subscribe(packed(v1::LAYER_SURFACE));
  EXPECT_TRUE(late.nextFrame(v1::LAYER_SURFACE));
}

TEST_F(ClusterTest, ALatecomerSeesPausedWaterAtOnceAndGoesOnFromIt) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient ada(e1.port);
  ada.hello();
  ada.subscribe(packed(v1::LAYER_SURFACE));
  ASSERT_TRUE(ada.apply(splash(0.05, 0.5)));
  ASSERT_TRUE(ada.apply(setPaused(true)));
  // A paused room has four frames per second: from the sixth or so on the edge knows that they are rare.
  for (int k = 0; k < 12; ++k) ASSERT_TRUE(ada.nextFrame(v1::LAYER_SURFACE));
  int shown_count = 0;
  constexpr int kLateCount = 8;
  for (int k = 0; k < kLateCount; ++k) {
    ScriptedClient late(e1.port);
    late.hello();
    late.subscribe(packed(v1::LAYER_SURFACE));
    const auto first = late.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(first);
    EXPECT_TRUE(first->keyframe());
    // A frame from before the client came; seldom one comes just then.
    if (first->server_time_s() < late.greeting().server_time_s()) ++shown_count;
  }
  EXPECT_GT(shown_count, kLateCount / 2);

  // It reads all that follows, and sees the same water as a client of the server itself.
  ScriptedClient late(e1.port);
  late.hello();
  late.subscribe(packed(v1::LAYER_SURFACE));
  codec::PackedSurfaceDecoder decoder;
  const auto readNext = [&] {
    const auto frame = late.nextFrame(v1::LAYER_SURFACE);
    EXPECT_TRUE(frame);
    auto samples = decoder.decode(frame.value_or(v1::LayerFrame()));
    EXPECT_TRUE(samples) << samples.error().message;
    return std::pair(frame.value_or(v1::LayerFrame()), samples ? *std::move(samples) : codec::SurfaceSamples());
  };
  EXPECT_TRUE(readNext().first.keyframe());
  EXPECT_FALSE(readNext().first.keyframe());
  ASSERT_TRUE(ada.apply(setPaused(false)));
  for (int k = 0; k < 20; ++k) readNext();
  ASSERT_TRUE(ada.apply(setPaused(true)));
  ScriptedClient direct(s1.port);
  direct.hello();
  direct.subscribe(v1::LAYER_SURFACE);
  const auto reference = direct.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(reference);
  for (auto [frame, samples] = readNext();; std::tie(frame, samples) = readNext()) {
    ASSERT_LE(frame.state_id(), reference->state_id());
    if (frame.state_id() < reference->state_id()) continue;
    EXPECT_EQ(samples.elevation_m, codec::decodeSurface(*reference)->elevation_m);
    break;
  }
}

TEST_F(ClusterTest, AClientBelowTheFrameRateGetsItsRateThroughAnEdge) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient slow(e1.port);
  slow.hello();
  v1::Subscribe tenth = packed(v1::LAYER_SURFACE);
  tenth.set_max_rate_hz(10.0);
  slow.subscribe(tenth);
  ASSERT_TRUE(slow.nextFrame(v1::LAYER_SURFACE));
  double first_s = 0.0;
  double last_s = 0.0;
  constexpr int kFrameCount = 20;
  for (int k = 0; k < kFrameCount; ++k) {
    const auto frame = slow.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->keyframe()) << "it did not get the frame before";
    if (k == 0) first_s = frame->time_s();
    last_s = frame->time_s();
  }
  // In the time of the simulation, which does not depend on the machine: no slower than every fifth frame of 30 Hz.
  EXPECT_LT((last_s - first_s) / (kFrameCount - 1), 5.0 / 30.0);
}

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

TEST_F(ClusterTest, RolesOfRequestsAreDecidedWhereTheClientConnects) {
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

TEST_F(ClusterTest, AnEdgeRefusesClientsWith503UntilItKnowsTheRooms) {
  const auto join = [](std::uint16_t port, const std::string& target) {
    WsClient client;
    EXPECT_FALSE(client.connect("127.0.0.1", port, target));
    return std::pair(client.handshakeStatus(), client.handshakeHeader("Retry-After"));
  };
  const Member e1 = start("edge", "e1");
  EXPECT_EQ(join(e1.port, "/ws"), std::pair(503u, std::string("1")));
  EXPECT_EQ(httpRequest(e1.port, "GET", "/readyz").status, 503u);
  EXPECT_EQ(httpRequest(e1.port, "GET", "/api/v1/rooms").status, 503u) << "no empty list";
  EXPECT_EQ(httpRequest(e1.port, "GET", "/api/v1/rooms/main").status, 503u);
  const Member s1 = server("s1");
  ASSERT_TRUE(eventually([&] { return rooms(e1.port).find("\"main\"") != std::string::npos; }));
  EXPECT_EQ(join(e1.port, "/ws/nowhere"), std::pair(404u, std::string()));
  EXPECT_EQ(httpRequest(e1.port, "GET", "/api/v1/rooms/nowhere").status, 404u);
  for (const char* const name : {"e2", "e3", "e4"}) {
    const Member next = start("edge", name);
    WsClient client;
    EXPECT_TRUE(client.connect("127.0.0.1", next.port)) << client.handshakeStatus() << client.handshakeBody();
  }
}

TEST_F(ClusterTest, ASecondProcessOfOneNameEndsAndTheFirstGoesOn) {
  const Member s1 = server("s1");
  Member e1 = edge("e1");
  ScriptedClient ada(e1.port);
  ada.hello();
  for (const std::string& what : {std::string("edge"), "serve --device software --scene '" + scene("pool") + "'"}) {
    for (const std::string& name : {std::string("e1"), std::string("s1")}) {
      LoggedProcess second(
          std::string(SPINDRIFT_PROGRAM) + " " + what + " --port 0 --nats " + nats_->url() + " --node " + name,
          folder_.path() / "second.log");
      EXPECT_EQ(second.wait(), 2);
      EXPECT_THAT(second.log(), testing::AllOf(HasSubstr("--node '" + name + "'"), HasSubstr("process "),
                                               HasSubstr("give each process a name of its own")));
      EXPECT_THAT(second.log(), Not(HasSubstr("is ready")));
      std::filesystem::remove(folder_.path() / "second.log");
    }
  }
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(ada.apply(splash(0.05, 0.5)));
  e1.process->signal(SIGKILL);
  e1.process->wait();
  std::filesystem::remove(folder_.path() / "e1.log");
  e1 = edge("e1");
  ScriptedClient bob(e1.port);
  bob.hello();
  EXPECT_TRUE(bob.apply(splash(0.05, 0.5)));
}

TEST_F(ClusterTest, ThoseWhoWatchBeyondTheListOfPeopleAreCountedForEverybody) {
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

TEST_F(ClusterTest, RoomsOpenAnywhereAndAreReachedFromEverywhere) {
  const Member s1 = server("s1");
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  for (const char* name : {"a", "b"}) {
    const auto opened = post(e1.port, "/api/v1/rooms", std::string(R"({"name": ")") + name + R"(", "scene": "pool"})");
    EXPECT_EQ(opened.status, 201u) << opened.body;
    ASSERT_TRUE(eventually([&] { return rooms(e1.port).find("\"" + std::string(name) + "\"") != std::string::npos; }));
  }
  EXPECT_EQ(post(s2.port, "/api/v1/rooms", R"({"name": "a", "scene": "pool"})").status, 409u) << "the name is taken";
  for (const std::uint16_t port : {s1.port, s2.port, e1.port}) {
    EXPECT_THAT(rooms(port), testing::AllOf(HasSubstr("\"main\""), HasSubstr("\"a\""), HasSubstr("\"b\"")));
    ScriptedClient client(port, "a");
    client.hello();
    EXPECT_TRUE(client.apply(splash(0.05, 0.5)));
    client.subscribe(v1::LAYER_SURFACE);
    EXPECT_TRUE(client.nextFrame(v1::LAYER_SURFACE));
  }
  ScriptedClient member(e1.port, "b");
  member.hello();
  ASSERT_TRUE(member.barrier());
  EXPECT_EQ(httpRequest(s1.port, "DELETE", "/api/v1/rooms/b").status, 204u);
  EXPECT_TRUE(member.ws().waitClosed());
  EXPECT_EQ(member.ws().closeCode(), 4404);
  EXPECT_TRUE(eventually([&] { return rooms(e1.port).find("\"b\"") == std::string::npos; }));
  WsClient gone;
  EXPECT_FALSE(gone.connect("127.0.0.1", e1.port, "/ws/b"));
  EXPECT_EQ(gone.handshakeStatus(), 404u);
}

TEST_F(ClusterTest, ARoomWhoseServerDiesGoesOnElsewhereForTheSameClients) {
  Member s1 = server("s1");
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient ada(e1.port);
  ada.hello({.name = "Ada"});
  const std::uint32_t person = ada.welcome().person_id();
  const v1::ServerMessage launched = ada.ask(spawnBoat(2.0, 0.0));
  ASSERT_TRUE(launched.has_ack());
  ASSERT_TRUE(ada.apply(setParameter("wave.damping_per_s", 0.25)));
  ada.subscribe(packed(v1::LAYER_SURFACE));
  ASSERT_TRUE(ada.nextFrame(v1::LAYER_SURFACE));

  s1.process->signal(SIGKILL);
  // All that was acknowledged is there: the boat, its owner, the parameter. The connection is the same.
  const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
  EXPECT_DOUBLE_EQ(greeting->greeting().scene().wave().damping_per_s(), 0.25);
  const auto frame = ada.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->keyframe());
  EXPECT_TRUE(ada.apply(controlBoat(launched.ack().boat_id(), 0.5, 0.0))) << "it is still hers";
  EXPECT_THAT(s2.process->log(), HasSubstr("taken over from server s1"));
  const auto people = httpRequest(e1.port, "GET", "/api/v1/rooms/main/people").body;
  EXPECT_THAT(people, HasSubstr("\"person_id\":" + std::to_string(person)));
  EXPECT_EQ(metric(s2.port, "cluster_rooms_taken_total"), 1);
  EXPECT_EQ(metric(e1.port, "cluster_lost_links_total"), 1);
}

TEST_F(ClusterTest, ARoomWhoseServerEndsInOrderMovesWithItsClients) {
  Member s1 = server("s1");
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient ada(e1.port);
  ada.hello();
  ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
  s1.process->signal(SIGTERM);
  EXPECT_EQ(s1.process->wait(), 0);
  const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
  EXPECT_TRUE(ada.apply(splash(0.05, 0.5)));
}

TEST_F(ClusterTest, APersonWhoseEdgeDiesComesBackThroughAnother) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  const Member e2 = edge("e2");
  ScriptedClient ada(e1.port);
  ada.hello({.name = "Ada"});
  const v1::Welcome before = ada.welcome();
  ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
  e1.process->signal(SIGKILL);
  EXPECT_TRUE(ada.ws().waitClosed());
  ScriptedClient again(e2.port);
  again.hello({.name = "Ada", .resume_key = before.resume_key()});
  EXPECT_TRUE(again.welcome().resumed());
  EXPECT_EQ(again.welcome().person_id(), before.person_id());
  again.subscribe(v1::LAYER_BODIES);
  EXPECT_TRUE(again.nextFrame(v1::LAYER_BODIES));
  EXPECT_TRUE(eventually([&] { return metric(s1.port, "cluster_lost_nodes_total") == 1; }));
}

TEST_F(ClusterTest, WithoutNatsRoomsGoOnAndWatchersWait) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient behind(e1.port);
  behind.hello();
  behind.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(behind.nextFrame(v1::LAYER_SURFACE));
  ScriptedClient direct(s1.port);
  direct.hello();
  direct.subscribe(v1::LAYER_SURFACE);
  nats_->kill();
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "nats_connected") == 0; }));
  EXPECT_EQ(httpRequest(e1.port, "GET", "/readyz").status, 503u);
  EXPECT_THAT(e1.process->waitForLog("the connection to NATS"), HasSubstr("broke"));
  WsClient late;
  EXPECT_FALSE(late.connect("127.0.0.1", e1.port));
  EXPECT_EQ(late.handshakeStatus(), 503u) << "at once, and not after the patience for rooms that are looked for";
  EXPECT_EQ(late.handshakeHeader("Retry-After"), "1");
  EXPECT_THAT(late.handshakeBody(), HasSubstr("NATS"));
  EXPECT_TRUE(direct.runFor(60)) << "clients of the server itself notice nothing";
  ASSERT_TRUE(eventually([&] { return behind.ask(splash(0.05, 0.5)).reject().reason() == v1::REJECT_REASON_BUSY; }));
  nats_->start();
  EXPECT_TRUE(behind.waitFor(v1::ServerMessage::kGreeting)) << "the room was reached again: " << e1.process->log();
  EXPECT_TRUE(behind.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(behind.apply(splash(0.05, 0.5)));
  EXPECT_GE(metric(e1.port, "nats_reconnects_total"), 1);
}

TEST_F(ClusterTest, AServerThatStartsAgainTakesItsRoomsBack) {
  Member s1 = server("s1");
  const Member e1 = edge("e1");
  ASSERT_EQ(post(e1.port, "/api/v1/rooms", R"({"name": "race", "scene": "pool"})").status, 201u);
  ScriptedClient ada(e1.port, "race");
  ada.hello();
  ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
  s1.process->signal(SIGKILL);
  s1.process->wait();
  s1 = server("s1");
  const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << s1.process->log() << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
}

TEST_F(ClusterTest, AnEdgePrintsAndReadsItsConfiguration) {
  ChildProcess printing(SPINDRIFT_PROGRAM, {"edge", "--nats", nats_->url(), "--node", "e9", "--print-config"});
  ASSERT_EQ(printing.wait(), 0) << printing.err();
  EXPECT_THAT(printing.out(), testing::AllOf(HasSubstr("node: \"e9\""), Not(HasSubstr("scene"))));
  folder_.write("edge.textproto", printing.out());
  const std::string file = (folder_.path() / "edge.textproto").string();
  ChildProcess again(SPINDRIFT_PROGRAM, {"edge", "--config", file, "--print-config"});
  ASSERT_EQ(again.wait(), 0) << again.err();
  EXPECT_THAT(again.out(), HasSubstr("node: \"e9\"  # file, line"));
  folder_.write("edge.textproto", "max_rooms: 3\n");
  ChildProcess wrong(SPINDRIFT_PROGRAM, {"edge", "--config", file});
  EXPECT_EQ(wrong.wait(), 2);
  EXPECT_THAT(wrong.err(), HasSubstr("max_rooms: this command has no such option"));
}

TEST_F(ClusterTest, MistakesAreNamed) {
  const auto says = [&](const std::string& arguments) {
    LoggedProcess process(std::string(SPINDRIFT_PROGRAM) + " " + arguments, folder_.path() / "mistake.log");
    EXPECT_NE(process.wait(), 0);
    const std::string log = process.log();
    std::filesystem::remove(folder_.path() / "mistake.log");
    return log;
  };
  EXPECT_THAT(says("edge"), HasSubstr("--nats nats://HOST:4222"));
  EXPECT_THAT(says("edge --node 'a b' --nats " + nats_->url()), HasSubstr("--node 'a b'"));
  const std::string refused = says("edge --nats nats://user:secret@127.0.0.1:1");
  EXPECT_THAT(refused, HasSubstr("no connection to NATS at nats://127.0.0.1:1"));
  EXPECT_THAT(refused, Not(HasSubstr("secret")));
}

}  // namespace
}  // namespace spindrift::test
