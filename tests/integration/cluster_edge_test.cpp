// An edge over NATS, as a process: what its clients see of a room that another process runs.
#include <cmath>
#include <limits>
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

/// Returns whether every delta among the frames builds on the frame before it.
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
  ada.subscribe(packedSurface());
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
  late.subscribe(packedSurface());
  EXPECT_TRUE(late.nextFrame(v1::LAYER_SURFACE));
}

/// Points of a query; the last one is outside of the pool.
v1::Command queryOfPoints(std::uint32_t query_id, std::uint32_t interval_ticks) {
  v1::Command command;
  v1::Query& query = *command.mutable_query();
  query.set_query_id(query_id);
  query.set_interval_ticks(interval_ticks);
  for (const float x_m : {0.3f, -4.1f, 900.0f}) {
    query.add_x_m(x_m);
    query.add_z_m(0.5f);
  }
  return command;
}

v1::QueryAnswer nextAnswer(ScriptedClient& client) {
  const auto message = client.waitFor([](const v1::ServerMessage& one) { return one.has_query_answer(); });
  EXPECT_TRUE(message) << "no answer came";
  return message ? message->query_answer() : v1::QueryAnswer();
}

TEST_F(ClusterTest, QueriesThroughAnEdgeAreAnsweredAsByTheServer) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient ada(e1.port);
  ada.hello({.name = "Ada"});
  ASSERT_TRUE(ada.apply(splash(0.1, 1.0)));
  ada.subscribe(packedSurface());
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(ada.nextFrame(v1::LAYER_SURFACE));
  ASSERT_TRUE(ada.apply(setPaused(true)));
  const v1::ServerMessage ack = ada.ask(queryOfPoints(7, 0));
  ASSERT_TRUE(ack.has_ack()) << ack.reject().message();
  const v1::QueryAnswer answer = nextAnswer(ada);
  EXPECT_EQ(answer.tick(), ack.ack().applied_tick());
  ASSERT_EQ(answer.results_size(), 1);
  EXPECT_EQ(answer.results(0).query_id(), 7u);
  EXPECT_TRUE(answer.results(0).last());
  EXPECT_THAT(answer.results(0).outside(), testing::ElementsAre(2u));
  EXPECT_GT(std::abs(answer.results(0).elevation_m(0)), 1e-4f) << "the water moves";

  // The server itself, and both by REST, say the same of the same tick.
  ScriptedClient ben(s1.port, "main");
  ben.hello({.name = "Ben"});
  ASSERT_TRUE(ben.ask(queryOfPoints(8, 0)).has_ack());
  v1::QueryAnswer direct = nextAnswer(ben);
  direct.mutable_results(0)->set_query_id(7);
  EXPECT_EQ(direct.SerializeAsString(), answer.SerializeAsString());
  const std::string points = R"({"x_m": [0.3, -4.1, 900], "z_m": [0.5, 0.5, 0.5]})";
  const HttpAnswer by_server = post(s1.port, "/api/v1/rooms/main/surface", points);
  EXPECT_EQ(by_server.status, 200u) << by_server.body;
  EXPECT_THAT(by_server.body, HasSubstr("\"tick\":\"" + std::to_string(answer.tick()) + "\""));
  EXPECT_EQ(post(e1.port, "/api/v1/rooms/main/surface", points).body, by_server.body);

  // A stream has every tick, and is refused, and ends, as at the server.
  ASSERT_TRUE(ada.ask(queryOfPoints(9, 1)).has_ack());
  std::uint64_t tick = nextAnswer(ada).tick();
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(ada.apply(step(1)));
    EXPECT_EQ(nextAnswer(ada).tick(), ++tick);
  }
  v1::Command bad = queryOfPoints(10, 0);
  bad.mutable_query()->set_x_m(1, std::numeric_limits<float>::infinity());
  EXPECT_EQ(ada.rejected(bad).field(), "query.x_m[1]");
  v1::Command end;
  end.mutable_query()->set_query_id(9);
  ASSERT_TRUE(ada.ask(end).has_ack());
  ASSERT_TRUE(ada.apply(step(1)));
  ASSERT_TRUE(ada.ask(queryOfPoints(11, 0)).has_ack());
  const v1::QueryAnswer last = nextAnswer(ada);
  ASSERT_EQ(last.results_size(), 1);
  EXPECT_EQ(last.results(0).query_id(), 11u) << "the stream has ended";
}

TEST_F(ClusterTest, ClockIsHeldThroughAnEdge) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient ben(s1.port, "main");
  ben.hello({.name = "Ben"});
  const auto says = [](const std::string& words) {
    return [words](const v1::ServerMessage& message) {
      return message.room_event().kind() == v1::ROOM_EVENT_KIND_CLOCK &&
             message.room_event().message().find(words) != std::string::npos;
    };
  };
  {
    ScriptedClient ada(e1.port);
    ada.hello({.name = "Ada"});
    const auto taken = ada.apply(takeClock());
    ASSERT_TRUE(taken);
    EXPECT_TRUE(ben.waitFor(says("Ada")));
    const v1::ServerMessage done = ada.ask(waitingStep(12));
    ASSERT_TRUE(done.has_ack()) << done.reject().message();
    EXPECT_EQ(done.ack().applied_tick(), *taken + 12);
    EXPECT_TRUE(done.ack().has_state_hash());
    EXPECT_EQ(ben.rejected(setPaused(true)).reason(), v1::REJECT_REASON_CLOCK_HELD);
    ScriptedClient late(e1.port, "main");
    ASSERT_EQ(late.greeting().room_state().clock_person_ids_size(), 1);
    EXPECT_EQ(late.greeting().room_state().clock_person_ids(0), ada.welcome().person_id());
  }
  EXPECT_TRUE(ben.waitFor(says("the connection ended")));
  EXPECT_TRUE(ben.runFor(3));
}

TEST_F(ClusterTest, LatecomerSeesPausedWaterAtOnce) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient ada(e1.port);
  ada.hello();
  ada.subscribe(packedSurface());
  ASSERT_TRUE(ada.apply(splash(0.05, 0.5)));
  ASSERT_TRUE(ada.apply(setPaused(true)));
  // A paused room has four frames per second: from the sixth or so on the edge knows that they are rare.
  for (int k = 0; k < 12; ++k) ASSERT_TRUE(ada.nextFrame(v1::LAYER_SURFACE));
  int shown_count = 0;
  constexpr int kLateCount = 8;
  for (int k = 0; k < kLateCount; ++k) {
    ScriptedClient late(e1.port);
    late.hello();
    late.subscribe(packedSurface());
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
  late.subscribe(packedSurface());
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

TEST_F(ClusterTest, EdgeKeepsTheRateOfASlowClient) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient slow(e1.port);
  slow.hello();
  v1::Subscribe tenth = packedSurface();
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

TEST_F(ClusterTest, EdgePassesOnTheLevelThatAClientAsksFor) {
  const Member s1 = server("s1");
  const Member e1 = edge("e1");
  ScriptedClient one(e1.port);
  one.hello({.minor = 7});
  v1::Subscribe coarse;
  coarse.set_layer(v1::LAYER_FLOATERS);
  coarse.set_max_rate_hz(60.0);
  coarse.set_packing(v1::PACKING_PACKED);
  coarse.set_level(v1::LEVEL_COARSE);
  one.subscribe(coarse);
  codec::PackedFloaterDecoder decoder;
  for (int k = 0; k < 10; ++k) {
    const auto frame = one.nextFrame(v1::LAYER_FLOATERS);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->level(), v1::LEVEL_COARSE);
    const auto floaters = decoder.decode(*frame);
    ASSERT_TRUE(floaters) << floaters.error().message;
    EXPECT_EQ(floaters->size(), 1u);
  }
}

TEST_F(ClusterTest, EdgeAnswers503UntilItKnowsTheRooms) {
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

}  // namespace
}  // namespace spindrift::test
