// The clock of a room in the hands of clients, over real connections: who holds it, who loses it, what waits for it,
// and the hash of the state.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <boost/json.hpp>
#include <fmt/format.h>

#include "server_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kClockOperator = "operator-operator-1";
constexpr const char* kPool = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  boats { capacity_count: 4 }
  stream { frame_rate_hz: 60 }
)";
/// Seeds matter: drops fall at random places and times.
constexpr const char* kStorm = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  storm { level_ratio: 1 drops_per_m2_s: 2 }
)";

class HeldClock : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kPool}, {"storm", kStorm}, {"other", kPool}}; }
  water::SceneCatalog scenes() const override {
    folder_.write("pond.textproto", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }");
    return water::SceneCatalog(folder_.path());
  }
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(fmt::format("operator {}\n", kClockOperator), "tokens", core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
    options.max_room_count = 4;
  }

  ScriptedClient chief(const std::string& name = "Ada", const std::string& room = "") {
    return person({.name = name, .token = kClockOperator}, room);
  }
  /// Sends the command without waiting for the answer.
  static void post(ScriptedClient& client, v1::Command command, std::uint64_t id) {
    v1::ClientMessage message;
    *message.mutable_command() = std::move(command);
    message.mutable_command()->set_command_id(id);
    client.send(message);
  }
  /// The answer to a command that was posted.
  static v1::ServerMessage answerTo(ScriptedClient& client, std::uint64_t id) {
    const auto answer = client.waitFor([id](const v1::ServerMessage& message) {
      return message.ack().command_id() == id || message.reject().command_id() == id;
    });
    if (!answer) ADD_FAILURE() << "no answer to command " << id;
    return answer.value_or(v1::ServerMessage());
  }
  /// Waits for the room's event and the state that goes with it.
  static std::string waitForClockEvent(ScriptedClient& client, const std::string& words) {
    const auto event = client.waitFor([&](const v1::ServerMessage& message) {
      return message.room_event().kind() == v1::ROOM_EVENT_KIND_CLOCK &&
             message.room_event().message().find(words) != std::string::npos;
    });
    return event ? event->room_event().message() : "(no event with \"" + words + "\")";
  }
  static bool waitForHolders(ScriptedClient& client, const std::vector<std::uint32_t>& person_ids) {
    return client
        .waitFor([&](const v1::ServerMessage& message) {
          const auto& holders = message.room_state().clock_person_ids();
          return message.has_room_state() && std::vector<std::uint32_t>(holders.begin(), holders.end()) == person_ids;
        })
        .has_value();
  }
  HttpAnswer http(const std::string& method, const std::string& path, const std::string& body = "",
                  const std::string& token = kClockOperator) {
    std::string headers = "Authorization: Bearer " + token + "\r\n";
    if (token.empty()) headers.clear();
    if (!body.empty()) headers += "Content-Type: application/json\r\n";
    return httpRequest(server().port(), method, "/api/v1/rooms/" + path, headers, body);
  }

  TemporaryFolder folder_;
};

TEST_F(HeldClock, RoomMakesTheTicksThatWereAskedForAndWaits) {
  ScriptedClient ada = chief();
  const auto taken = ada.apply(takeClock());
  ASSERT_TRUE(taken);
  EXPECT_TRUE(waitForHolders(ada, {ada.welcome().person_id()}));
  EXPECT_THAT(waitForClockEvent(ada, "holds"), HasSubstr("Ada (person 1) holds the clock"));
  const v1::ServerMessage done = ada.ask(waitingStep(7));
  ASSERT_TRUE(done.has_ack()) << done.reject().message();
  EXPECT_EQ(done.ack().applied_tick(), *taken + 7);
  EXPECT_TRUE(done.ack().has_state_hash());
  const v1::ServerMessage begun = ada.ask(step(3));
  EXPECT_EQ(begun.ack().applied_tick(), *taken + 7) << "without `waits` it is the tick at which it begins";
  EXPECT_FALSE(begun.ack().has_state_hash());
  EXPECT_EQ(ada.ask(waitingStep(1)).ack().applied_tick(), *taken + 11);
  EXPECT_EQ(ada.apply(splash()), *taken + 11) << "the room waits";
  ASSERT_TRUE(ada.apply(releaseClock()));
  EXPECT_TRUE(waitForHolders(ada, {}));
  EXPECT_TRUE(ada.runFor(5)) << "its own clock runs again";
}

TEST_F(HeldClock, AckAnswerFrameAndRequestOfATickAgree) {
  ScriptedClient ada = chief();
  ada.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(ada.apply(splash()));
  const v1::ServerMessage done = ada.ask(waitingStep(20));
  ASSERT_TRUE(done.has_ack()) << done.reject().message();
  const std::uint64_t tick = done.ack().applied_tick();
  v1::Command query;
  query.mutable_query()->add_x_m(0.125f);
  query.mutable_query()->add_z_m(0.125f);
  EXPECT_EQ(ada.ask(query).ack().applied_tick(), tick);
  const auto answer = ada.waitFor(v1::ServerMessage::kQueryAnswer);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->query_answer().tick(), tick);
  const auto frame = ada.waitFor([&](const v1::ServerMessage& message) { return message.frame().tick() >= tick; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->frame().tick(), tick);
  EXPECT_EQ(frame->frame().state_id(), answer->query_answer().state_id());
  EXPECT_DOUBLE_EQ(frame->frame().time_s(), answer->query_answer().time_s());
  const auto surface = codec::decodeSurface(frame->frame());
  ASSERT_TRUE(surface);
  const double seen_m = surface->elevation_m[16 * 32 + 16];  // the sample whose centre the query asks for
  EXPECT_NEAR(seen_m, answer->query_answer().results(0).elevation_m(0), 0.002);
  EXPECT_GT(std::abs(seen_m), 0.004) << "the splash is there";

  const HttpAnswer hash = http("GET", "main/state_hash");
  ASSERT_EQ(hash.status, 200U) << hash.body;
  const boost::json::value json = boost::json::parse(hash.body);
  EXPECT_EQ(json.at("tick").as_string(), std::to_string(tick));
  EXPECT_EQ(json.at("state_hash").as_string(), std::to_string(done.ack().state_hash()));
  EXPECT_EQ(http("GET", "main/state_hash", "", "").status, 403U) << "guests are players";
  EXPECT_EQ(http("POST", "main/state_hash", "{}").status, 405U);
}

TEST_F(HeldClock, AllHoldersHaveToAgree) {
  ScriptedClient ada = chief();
  ScriptedClient bob = chief("Bob");
  const auto taken = ada.apply(takeClock());
  ASSERT_TRUE(taken);
  ASSERT_TRUE(bob.apply(takeClock()));
  EXPECT_TRUE(waitForHolders(bob, {ada.welcome().person_id(), bob.welcome().person_id()}));
  post(ada, waitingStep(10), 1001);
  EXPECT_EQ(bob.ask(waitingStep(4)).ack().applied_tick(), *taken + 4);
  EXPECT_EQ(ada.apply(splash()), *taken + 4) << "Ada has asked for more, Bob has not";
  post(bob, waitingStep(6), 1002);
  const v1::ServerMessage first = answerTo(ada, 1001);
  const v1::ServerMessage second = answerTo(bob, 1002);
  EXPECT_EQ(first.ack().applied_tick(), *taken + 10) << first.reject().message();
  EXPECT_EQ(second.ack().applied_tick(), *taken + 10);
  EXPECT_EQ(first.ack().state_hash(), second.ack().state_hash());
  ASSERT_TRUE(bob.apply(releaseClock()));
  EXPECT_EQ(ada.ask(waitingStep(5)).ack().applied_tick(), *taken + 15) << "Ada alone decides now";
}

TEST_F(HeldClock, TakingItTwiceChangesTheTerms) {
  ScriptedClient ada = chief();
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(ada.apply(takeClock(0.0, 0.2)));
  EXPECT_THAT(waitForClockEvent(ada, "lost"), HasSubstr("time-out")) << "the new one";
  EXPECT_EQ(ada.rejected(takeClock(-1.0)).field(), "take_clock.speed");
  EXPECT_EQ(ada.rejected(takeClock(std::numeric_limits<double>::quiet_NaN())).reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(ada.rejected(takeClock(0.0, 601.0)).field(), "take_clock.timeout_s");
}

TEST_F(HeldClock, TimeOfOthersIsRefusedWithTheHolder) {
  ScriptedClient ada = chief();
  ScriptedClient bob = chief("Bob");
  ASSERT_TRUE(ada.apply(takeClock()));
  for (const v1::Command& command : {setPaused(true), setSpeed(0.5), step(1), waitingStep(1)}) {
    const v1::Reject reject = bob.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_CLOCK_HELD) << command.DebugString();
    EXPECT_THAT(reject.message(), HasSubstr("Ada (person 1)"));
  }
  const HttpAnswer pause = http("POST", "main/commands", R"({"setPaused": {"paused": true}})");
  EXPECT_EQ(pause.status, 409U);
  EXPECT_THAT(pause.body, HasSubstr("CLOCK_HELD"));
  const HttpAnswer take = http("POST", "main/commands", R"({"takeClock": {}})");
  EXPECT_EQ(take.status, 403U);
  EXPECT_THAT(take.body, HasSubstr("WebSocket"));
  EXPECT_TRUE(bob.apply(splash())) << "others still act on the water";
  ASSERT_EQ(http("POST", "main/commands", R"({"releaseClock": {}})").status, 200U) << "an operator may end it";
  EXPECT_THAT(waitForClockEvent(ada, "lost"), HasSubstr("an operator released it"));
  EXPECT_TRUE(bob.apply(setPaused(true)));
}

TEST_F(HeldClock, PauseAndSpeedFromBeforeComeBack) {
  ScriptedClient ada = chief();
  ASSERT_TRUE(ada.apply(setPaused(true)));
  post(ada, waitingStep(600), 1001);
  const auto taken = ada.apply(takeClock());
  ASSERT_TRUE(taken);
  EXPECT_EQ(answerTo(ada, 1001).reject().reason(), v1::REJECT_REASON_NOT_NOW) << "the steps of the pause end";
  EXPECT_EQ(ada.ask(waitingStep(2)).ack().applied_tick(), *taken + 2);
  ASSERT_TRUE(ada.apply(releaseClock()));
  EXPECT_EQ(ada.ask(waitingStep(2)).ack().applied_tick(), *taken + 4) << "the room is paused again, and steps";
  EXPECT_EQ(ada.apply(splash()), *taken + 4);
  EXPECT_EQ(ada.rejected(releaseClock()).reason(), v1::REJECT_REASON_OUT_OF_RANGE) << "nobody holds it";
}

TEST_F(HeldClock, HolderWhoseConnectionEndsLosesIt) {
  ScriptedClient eve = chief("Eve");
  {
    ScriptedClient ada = chief();
    ASSERT_TRUE(ada.apply(takeClock()));
    ASSERT_TRUE(ada.apply(spawnBoat(0, 0))) << "so that the person stays for the grace time";
    EXPECT_THAT(waitForClockEvent(eve, "holds"), HasSubstr("Ada"));
  }
  EXPECT_THAT(waitForClockEvent(eve, "lost"), HasSubstr("Ada (person 2) lost the clock: the connection ended"));
  EXPECT_TRUE(waitForHolders(eve, {}));
  EXPECT_TRUE(eve.runFor(5));
}

TEST_F(HeldClock, SilentHolderLosesItOnlyWhileTheRoomWaits) {
  ScriptedClient ada = chief();
  const auto taken = ada.apply(takeClock(1.0, 0.3));
  ASSERT_TRUE(taken);
  const v1::ServerMessage done = ada.ask(waitingStep(60));
  EXPECT_EQ(done.ack().applied_tick(), *taken + 60) << "a second of ticks is longer than the time-out";
  EXPECT_THAT(waitForClockEvent(ada, "lost"), HasSubstr("no step came"));
  EXPECT_EQ(ada.rejected(step(1)).reason(), v1::REJECT_REASON_OUT_OF_RANGE) << "the room runs";
}

TEST_F(HeldClock, StepsThatEndBeforeTheirTicksAreRejected) {
  ScriptedClient ada = chief();
  ScriptedClient bob = chief("Bob");
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(bob.apply(takeClock()));  // so that Ada's steps wait
  const auto endedBy = [&](ScriptedClient& who, const v1::Command& command) {
    static std::uint64_t id = 5000;
    post(ada, waitingStep(100), ++id);
    EXPECT_TRUE(ada.barrier());
    EXPECT_TRUE(who.apply(command)) << command.DebugString();
    const v1::Reject reject = answerTo(ada, id).reject();
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_NOT_NOW) << command.DebugString();
    return reject.message();
  };
  EXPECT_THAT(endedBy(bob, reset()), HasSubstr("began again"));
  v1::Command pond;
  pond.mutable_change_scene()->set_name("pond");
  EXPECT_THAT(endedBy(bob, pond), HasSubstr("scene has changed"));
  EXPECT_THAT(endedBy(ada, releaseClock()), HasSubstr("do not hold"));
  const v1::ServerMessage after = bob.ask(waitingStep(2));
  EXPECT_TRUE(after.has_ack()) << "Bob still holds the clock";
}

TEST_F(HeldClock, PlayerHoldsItWhileAlone) {
  ScriptedClient ann = person({.name = "Ann"});
  EXPECT_EQ(ann.rejected(step(1)).reason(), v1::REJECT_REASON_FORBIDDEN);
  const auto taken = ann.apply(takeClock());
  ASSERT_TRUE(taken);
  EXPECT_EQ(ann.ask(waitingStep(3)).ack().applied_tick(), *taken + 3);
  EXPECT_EQ(ann.rejected(setPaused(true)).reason(), v1::REJECT_REASON_FORBIDDEN);
  ScriptedClient ben = person({.name = "Ben"});
  EXPECT_THAT(waitForClockEvent(ann, "lost"), HasSubstr("somebody else came"));
  EXPECT_EQ(ann.rejected(takeClock()).reason(), v1::REJECT_REASON_FORBIDDEN);
  ScriptedClient ada = chief();
  ASSERT_TRUE(ada.apply(takeClock())) << "operators may in company";
  EXPECT_EQ(ben.rejected(step(1)).reason(), v1::REJECT_REASON_FORBIDDEN);
  EXPECT_EQ(ben.rejected(releaseClock()).reason(), v1::REJECT_REASON_NOT_YOURS);
}

TEST_F(HeldClock, SpeedIsTheLowestOfTheHolders) {
  ScriptedClient ada = chief();
  ScriptedClient bob = chief("Bob");
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(bob.apply(takeClock(0.5)));
  const auto begin = std::chrono::steady_clock::now();
  post(ada, waitingStep(30), 1001);
  ASSERT_TRUE(bob.ask(waitingStep(30)).has_ack());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took.count(), 0.8) << "half a second of water at half speed, less a lag that is caught up";
}

TEST_F(HeldClock, OtherRoomsKeepTheirTurns) {
  ScriptedClient ada = chief();
  ScriptedClient eve = chief("Eve", "other");
  const auto taken = ada.apply(takeClock());
  const auto other_before = eve.apply(setSpeed(1.0));
  ASSERT_TRUE(taken && other_before);
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t held = *taken;
  for (int round = 0; round < 5; ++round) held = ada.ask(waitingStep(600)).ack().applied_tick();
  EXPECT_EQ(held, *taken + 3000);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const auto other_after = eve.apply(setSpeed(1.0));
  ASSERT_TRUE(other_after);
  // It makes a tick per pass of the thread if one is due: 60 per second, and no more than the held room.
  EXPECT_GE(static_cast<double>(*other_after - *other_before), 0.5 * std::min(3000.0, 60.0 * took.count()));
}

TEST_F(HeldClock, StepsThatWaitAreBounded) {
  ScriptedClient ada = chief();
  ScriptedClient bob = chief("Bob");
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(bob.apply(takeClock()));
  for (std::uint64_t k = 0; k < 65; ++k) post(ada, waitingStep(1), 2000 + k);
  const v1::Reject full = answerTo(ada, 2064).reject();
  EXPECT_EQ(full.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_EQ(full.field(), "step.waits");
  EXPECT_THAT(full.message(), HasSubstr("64"));
  const v1::Reject ticks = ada.rejected(step(600));
  EXPECT_EQ(ticks.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_EQ(ticks.field(), "step.tick_count");
  ASSERT_TRUE(bob.ask(waitingStep(64)).has_ack());
  for (std::uint64_t k = 0; k < 64; ++k) EXPECT_TRUE(answerTo(ada, 2000 + k).has_ack()) << k;
}

TEST_F(HeldClock, SeedAndCommandsMakeTheHash) {
  ScriptedClient ada = chief("Ada", "storm");
  ASSERT_TRUE(ada.apply(takeClock()));
  const auto hashOf = [&](std::uint64_t seed, double depth_m) {
    EXPECT_TRUE(ada.apply(seededReset(seed)));
    EXPECT_TRUE(ada.ask(waitingStep(30)).has_ack());
    EXPECT_TRUE(ada.apply(splash(depth_m)));
    const v1::ServerMessage done = ada.ask(waitingStep(90));
    EXPECT_TRUE(done.has_ack()) << done.reject().message();
    return done.ack().state_hash();
  };
  const std::uint64_t first = hashOf(7, 0.3);
  ASSERT_TRUE(ada.ask(waitingStep(11)).has_ack());
  EXPECT_EQ(hashOf(7, 0.3), first);
  EXPECT_NE(hashOf(8, 0.3), first) << "another seed";
  EXPECT_NE(hashOf(7, 0.31), first) << "another command";
  EXPECT_EQ(hashOf(0, 0.3), first) << "0 is the seed that the scene has now";
}

TEST_F(HeldClock, SeededResetBeginsAsANewRoomDoes) {
  ScriptedClient ada = chief();
  ASSERT_TRUE(ada.apply(takeClock()));
  const auto hashOf = [&](const v1::Command& begin) {
    EXPECT_TRUE(ada.apply(begin));
    const v1::ServerMessage boat = ada.ask(spawnBoat(1, 1));
    EXPECT_TRUE(boat.has_ack()) << boat.reject().message();
    return std::pair(boat.ack().boat_id(), ada.ask(waitingStep(20)).ack().state_hash());
  };
  const auto first = hashOf(seededReset(3));
  EXPECT_EQ(first.first, 1u);
  const auto second = hashOf(reset());
  EXPECT_EQ(second.first, 2u) << "without a seed the numbers continue";
  EXPECT_EQ(hashOf(seededReset(3)), first);
}

TEST_F(HeldClock, StepsWaitInAPausedRoomToo) {
  ScriptedClient ada = chief();
  const auto paused = ada.apply(setPaused(true));
  ASSERT_TRUE(paused);
  const v1::ServerMessage done = ada.ask(waitingStep(5));
  ASSERT_TRUE(done.has_ack()) << done.reject().message();
  EXPECT_EQ(done.ack().applied_tick(), *paused + 5);
  EXPECT_TRUE(done.ack().has_state_hash());
  post(ada, waitingStep(600), 1001);
  ASSERT_TRUE(ada.apply(setPaused(false)));
  const v1::ServerMessage ended = answerTo(ada, 1001);
  // On a fast machine the ticks may have been done before.
  if (ended.has_reject()) {
    EXPECT_EQ(ended.reject().reason(), v1::REJECT_REASON_NOT_NOW);
  }
  const HttpAnswer rest = http("POST", "main/commands", R"({"setPaused": {"paused": true}})");
  ASSERT_EQ(rest.status, 200U);
  const HttpAnswer stepped = http("POST", "main/commands", R"({"step": {"tickCount": 3, "waits": true}})");
  EXPECT_EQ(stepped.status, 200U) << stepped.body;
  EXPECT_THAT(stepped.body, HasSubstr("state_hash"));
}

TEST_F(HeldClock, NewcomersAreToldWhoHoldsIt) {
  ScriptedClient ada = chief();
  ASSERT_TRUE(ada.apply(takeClock()));
  ASSERT_TRUE(ada.barrier());
  ScriptedClient eve(server().port());
  EXPECT_THAT(eve.greeting().room_state().clock_person_ids(), ElementsAre(ada.welcome().person_id()));
  ASSERT_TRUE(ada.apply(releaseClock()));
  ScriptedClient zoe(server().port());
  EXPECT_THAT(zoe.greeting().room_state().clock_person_ids(), IsEmpty());
}

}  // namespace
}  // namespace spindrift::test
