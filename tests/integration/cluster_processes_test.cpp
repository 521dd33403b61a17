// Servers and edges over NATS, as processes: rooms on several servers, and what happens when a part dies.
#include <gmock/gmock.h>

#include "cluster_fixture.h"
#include "commands.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(ClusterTest, SecondProcessOfANameEnds) {
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

TEST_F(ClusterTest, RoomOfADeadServerContinuesElsewhere) {
  Member s1 = server("s1");
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient ada(e1.port);
  ada.hello({.name = "Ada"});
  ASSERT_TRUE(ada.settle());
  const std::uint32_t person = ada.welcome().person_id();
  const v1::ServerMessage launched = ada.ask(spawnBoat(2.0, 0.0));
  ASSERT_TRUE(launched.has_ack());
  ASSERT_TRUE(ada.apply(setParameter("wave.damping_per_s", 0.25)));
  ada.subscribe(packedSurface());
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

TEST_F(ClusterTest, RoomOfAStoppedServerMoves) {
  Member s1 = server("s1");
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient ada(e1.port);
  ada.hello();
  ASSERT_TRUE(ada.settle());
  ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
  s1.process->signal(SIGTERM);
  EXPECT_EQ(s1.process->wait(), 0);
  const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
  EXPECT_TRUE(ada.apply(splash(0.05, 0.5)));
}

TEST_F(ClusterTest, PersonResumesThroughAnotherEdge) {
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

TEST_F(ClusterTest, RoomsContinueWithoutNats) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient behind(e1.port);
  behind.hello();
  ASSERT_TRUE(behind.settle());
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

TEST_F(ClusterTest, RestartedServerTakesItsRoomsBack) {
  Member s1 = server("s1");
  const Member e1 = edge("e1");
  ASSERT_EQ(post(e1.port, "/api/v1/rooms", R"({"name": "race", "scene": "pool"})").status, 201u);
  ScriptedClient ada(e1.port, "race");
  ada.hello();
  ASSERT_TRUE(ada.settle());
  ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
  s1.process->signal(SIGKILL);
  s1.process->wait();
  s1 = server("s1");
  const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << s1.process->log() << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
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
