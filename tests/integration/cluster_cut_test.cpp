// A server that is cut off from NATS, and only from NATS: it lives, its own clients reach it, and its disk is there.
#include <gmock/gmock.h>

#include "cluster_fixture.h"
#include "commands.h"
#include "tcp_link.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class CutOffServer : public ClusterTest {
 protected:
  void SetUp() override {
    ClusterTest::SetUp();
    if (!IsSkipped()) link_ = std::make_unique<TcpLink>(nats_->port());
  }
  static int count(const std::string& text, const std::string& part) {
    int out = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++out;
    return out;
  }

  std::unique_ptr<TcpLink> link_;  ///< between one server and NATS
};

TEST_F(CutOffServer, KeepsItsRoomsAndRunsThemAlone) {
  Member s1 = server("s1", sharedState(), link_->port());
  const Member s2 = server("s2");
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient direct(s1.port, "main");
  direct.hello({.name = "Ada"});
  direct.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(direct.nextFrame(v1::LAYER_SURFACE));
  ScriptedClient behind(e1.port, "main");
  behind.hello({.name = "Ben"});
  ASSERT_TRUE(behind.settle());

  link_->cut();
  // The other server takes the room by the directory, and cannot lock it.
  EXPECT_THAT(s2.process->waitForLog("room main could not be taken over"), HasSubstr("taken over from server s1"));
  ASSERT_TRUE(eventually([&] { return metric(s1.port, "nats_connected") == 0; }));
  EXPECT_EQ(httpRequest(s1.port, "GET", "/readyz").status, 200u) << "its own clients need it";
  EXPECT_TRUE(direct.runFor(30)) << "clients of the server itself notice nothing";
  const v1::ServerMessage launched = direct.ask(spawnBoat(2.0, 0.0));
  EXPECT_TRUE(launched.has_ack());
  EXPECT_TRUE(eventually([&] { return behind.ask(splash(0.05, 0.5)).reject().reason() == v1::REJECT_REASON_BUSY; }));

  link_->restore();
  const auto greeting = behind.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(greeting) << "the room was reached again: " << e1.process->log();
  EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1) << "the same room";
  EXPECT_TRUE(behind.apply(splash(0.05, 0.5)));
  EXPECT_TRUE(direct.apply(controlBoat(launched.ack().boat_id(), 0.5, 0.0)));
  EXPECT_EQ(metric(s2.port, "cluster_rooms_taken_total"), 0) << s2.process->log();
  EXPECT_THAT(s2.process->log(), Not(HasSubstr("runs here now")));

  // It is entered again: the other server leaves it alone, until its server really dies.
  EXPECT_TRUE(direct.runFor(30));
  const int tries = count(s2.process->log(), "could not be taken over");
  EXPECT_TRUE(direct.runFor(60));
  EXPECT_EQ(count(s2.process->log(), "could not be taken over"), tries) << s2.process->log();
  s1.process->signal(SIGKILL);
  const auto moved = behind.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(moved) << s2.process->log();
  EXPECT_EQ(moved->greeting().boat_list().boats_size(), 1);
  EXPECT_EQ(metric(s2.port, "cluster_rooms_taken_total"), 1);
}

TEST_F(CutOffServer, TakesNoRoomsOfTheOthers) {
  const Member s1 = server("s1");
  const Member s2 = server("s2", sharedState(), link_->port());
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient ada(e1.port, "main");
  ada.hello();
  link_->cut();
  // Nobody is alive to it. What it writes now would arrive when the link is back.
  ASSERT_TRUE(eventually([&] { return metric(s2.port, "nats_connected") == 0; }));
  EXPECT_TRUE(ada.runFor(60)) << "the others notice nothing";
  link_->restore();
  ASSERT_TRUE(eventually([&] { return metric(s2.port, "nats_connected") == 1; }));
  EXPECT_TRUE(ada.runFor(60));
  EXPECT_TRUE(ada.apply(splash(0.05, 0.5)));
  EXPECT_THAT(s2.process->log(), Not(HasSubstr("taken over")));
  EXPECT_EQ(metric(e1.port, "cluster_lost_links_total"), 0);
  EXPECT_EQ(httpRequest(s2.port, "GET", "/readyz").status, 200u);
}

TEST_F(CutOffServer, ClosesItsRoomIfAnotherServerTookIt) {
  const Member s1 = server("s1", "", link_->port());
  const Member s2 = server("s2", "", nats_->port());
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient direct(s1.port, "main");
  direct.hello();
  ASSERT_TRUE(direct.ask(spawnBoat(2.0, 0.0)).has_ack());
  ScriptedClient behind(e1.port, "main");
  behind.hello();
  ASSERT_TRUE(behind.settle());

  link_->cut();
  const auto anew = behind.waitFor(v1::ServerMessage::kGreeting);
  ASSERT_TRUE(anew) << s2.process->log();
  EXPECT_EQ(anew->greeting().boat_list().boats_size(), 0) << "from the beginning of its scene";
  EXPECT_TRUE(direct.runFor(30)) << "and on the server that is cut off as it was";
  ASSERT_TRUE(behind.ask(spawnBoat(0.0, 2.0)).has_ack());
  ASSERT_TRUE(behind.ask(spawnBoat(2.0, 2.0)).has_ack());

  link_->restore();
  EXPECT_TRUE(direct.ws().waitClosed()) << s1.process->log();
  EXPECT_EQ(direct.ws().closeCode(), 1001) << "it connects again, and finds the other room through the same server";
  ASSERT_TRUE(eventually([&] {
    const ScriptedClient again(s1.port, "main");
    return again.isOpen() && again.greeting().boat_list().boats_size() == 2;
  })) << s1.process->log();
  EXPECT_EQ(count(s1.process->log(), "runs on server s2 as well"), 1);
  // Sessions of edges stay. Their link may have gone over to the server that came back; now only the other one answers.
  ASSERT_TRUE(eventually([&] { return behind.ask(splash(0.05, 0.5)).has_ack(); })) << e1.process->log();
  ScriptedClient late(e1.port, "main");
  EXPECT_EQ(late.greeting().boat_list().boats_size(), 2);
  late.hello();
  EXPECT_TRUE(late.runFor(60));
  EXPECT_THAT(s2.process->log(), Not(HasSubstr("as well")));
}

TEST_F(CutOffServer, ClosesItsRoomAlsoIfItDidNotNoticeTheCut) {
  const Member s1 = server("s1", "", link_->port());
  const Member s2 = server("s2", "", nats_->port());
  const Member e1 = edge("e1");
  ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
  ScriptedClient direct(s1.port, "main");
  direct.hello();
  link_->cut();
  // Back as soon as the other server has the room: its entry comes before its pulse.
  ASSERT_THAT(s2.process->waitForLog("room main: taken over"), HasSubstr("from server s1"));
  link_->restore();
  EXPECT_TRUE(direct.ws().waitClosed()) << s1.process->log();
  EXPECT_THAT(s1.process->log(), HasSubstr("runs on server s2 as well"));
  EXPECT_THAT(s2.process->log(), Not(HasSubstr("as well")));
}

TEST_F(CutOffServer, RemovesAClosedRoomAfterReconnecting) {
  const Member s1 = server("s1", "", link_->port());
  ASSERT_EQ(post(s1.port, "/api/v1/rooms", R"({"name": "race", "scene": "pool"})").status, 201u);
  link_->cut();
  ASSERT_TRUE(eventually([&] { return metric(s1.port, "nats_connected") == 0; }));
  ASSERT_EQ(httpRequest(s1.port, "DELETE", "/api/v1/rooms/race").status, 204u);
  link_->restore();
  ASSERT_TRUE(eventually([&] { return metric(s1.port, "nats_connected") == 1; }));
  HttpAnswer opened;
  ASSERT_TRUE(eventually([&] {  // its name is free
    opened = post(s1.port, "/api/v1/rooms", R"({"name": "race", "scene": "pool"})");
    return opened.status == 201u;
  })) << opened.body
      << s1.process->log();
  EXPECT_THAT(s1.process->log(), Not(HasSubstr("taken over")));
}

TEST_F(ClusterTest, ADirectoryThatNatsLostIsWrittenAnew) {
  for (const bool is_shared : {true, false}) {
    const std::string state = is_shared ? sharedState() : "";
    Member s1 = server("s1", state, nats_->port());
    const Member s2 = server("s2", state, nats_->port());
    const Member e1 = edge("e1");
    ASSERT_TRUE(eventually([&] { return metric(e1.port, "cluster_servers") == 2; }));
    ScriptedClient ada(e1.port, "main");
    ada.hello();
    ASSERT_TRUE(ada.settle());
    ASSERT_TRUE(ada.ask(spawnBoat(2.0, 0.0)).has_ack());
    nats_->kill();
    ASSERT_TRUE(eventually([&] { return ada.ask(splash(0.05, 0.5)).reject().reason() == v1::REJECT_REASON_BUSY; }));
    nats_->loseData();
    nats_->start();
    const auto greeting = ada.waitFor(v1::ServerMessage::kGreeting);
    ASSERT_TRUE(greeting) << e1.process->log();
    EXPECT_EQ(greeting->greeting().boat_list().boats_size(), 1);
    EXPECT_TRUE(ada.runFor(60));
    EXPECT_THAT(s2.process->log(), Not(HasSubstr("taken over")));
    EXPECT_EQ(post(s2.port, "/api/v1/rooms", R"({"name": "main", "scene": "pool"})").status, 409u) << "it is entered";
    s1.process->signal(SIGKILL);
    ASSERT_TRUE(ada.waitFor(v1::ServerMessage::kGreeting)) << s2.process->log();
    EXPECT_THAT(s2.process->log(), HasSubstr("taken over from server s1"));
    s2.process->signal(SIGKILL);
    e1.process->signal(SIGKILL);
    for (const char* name : {"s1", "s2", "e1"}) std::filesystem::remove(folder_.path() / (std::string(name) + ".log"));
  }
}

}  // namespace
}  // namespace spindrift::test
