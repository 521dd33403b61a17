// People in a room: roles, presence, owners of boats, and resuming.
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kLagoon = R"(
  wave { resolution_count: 32 side_m: 16 depth_m: 2 }
  boats { capacity_count: 4 boats { x_m: 0 z_m: 0 } }
  stream { frame_rate_hz: 60 }
)";

constexpr const char* kOperator = "operator-operator-1";
constexpr const char* kPlayer = "player-player-player";
constexpr const char* kBrief = "brief-brief-brief-1";

class People : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kLagoon}}; }
  void adjust(service::WaterServerOptions& options) const override {
    // Most tokens are valid for long; one expires while its client is connected.
    const auto soon =
        std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()) + std::chrono::seconds(3);
    const std::time_t at = std::chrono::system_clock::to_time_t(soon);
    char until[32];
    std::strftime(until, sizeof until, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&at));
    const std::string tokens = std::string("operator ") + kOperator + "\nplayer " + kPlayer + "\nplayer " + kBrief +
                               " until=" + until + "\nplayer expired-expired-1 until=2020-01-01T00:00:00Z\n";
    auto access = access::Access::parse(tokens, "tokens", guests());
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
    options.rules.grace = grace();
  }
  virtual std::optional<core::Role> guests() const { return core::Role::kViewer; }
  virtual std::chrono::milliseconds grace() const { return std::chrono::hours(1); }

  ScriptedClient player(const std::string& name = "", const std::string& resume_key = "") {
    return person({.name = name, .token = kPlayer, .resume_key = resume_key});
  }
};
class ShortGrace : public People {
  std::chrono::milliseconds grace() const override { return std::chrono::milliseconds(50); }
};
class NoGuests : public People {
  std::optional<core::Role> guests() const override { return std::nullopt; }
};

std::vector<std::string> namesOf(const v1::People& people) {
  std::vector<std::string> names;
  for (const v1::Person& one : people.people()) names.push_back(one.name());
  return names;
}

/// Returns the first list that `wanted` accepts and drops older ones; empty if none comes.
v1::People peopleWhen(ScriptedClient& client, const std::function<bool(const v1::People&)>& wanted) {
  while (const auto message = client.waitFor(v1::ServerMessage::kPeople)) {
    if (wanted(message->people())) return message->people();
  }
  ADD_FAILURE() << "no such list of people came";
  return {};
}

std::vector<std::uint32_t> boatsOf(const v1::People& people, std::uint32_t person_id) {
  for (const v1::Person& one : people.people()) {
    if (one.person_id() == person_id) return {one.boat_ids().begin(), one.boat_ids().end()};
  }
  return {};
}

TEST_F(People, OnlookerSeesTheWaterAndIsNobodyOfTheRoom) {
  ScriptedClient ada = player("Ada");
  ScriptedClient picture(server().port(), "main?onlooker");
  picture.hello({.name = "a front page", .token = kOperator, .resume_key = ada.welcome().resume_key()});
  EXPECT_EQ(picture.welcome().role(), v1::ROLE_OPERATOR) << "its page may know";
  EXPECT_EQ(picture.welcome().person_id(), 0U);
  EXPECT_FALSE(picture.welcome().resumed());
  picture.subscribe(v1::LAYER_SURFACE);
  EXPECT_TRUE(picture.nextFrame(v1::LAYER_SURFACE));
  EXPECT_EQ(picture.rejected(splash(0.1, 1.0)).reason(), v1::REJECT_REASON_FORBIDDEN);
  EXPECT_TRUE(ada.apply(splash(0.1, 1.0))) << "the key of another connection is not taken";
  const auto room = [&] { return httpRequest(server().port(), "GET", "/api/v1/rooms/main").body; };
  EXPECT_THAT(room(), HasSubstr("\"session_count\":2"));
  EXPECT_THAT(room(), HasSubstr("\"people_count\":1"));
  const auto people = picture.waitFor(v1::ServerMessage::kPeople);
  ASSERT_TRUE(people);
  EXPECT_THAT(namesOf(people->people()), ElementsAre("Ada"));
  ASSERT_TRUE(ada.ws().close());
  EXPECT_TRUE(picture.waitFor([](const v1::ServerMessage& message) {
    return message.has_people() && message.people().people_size() == 0;
  })) << "she left, and nobody is here";
  EXPECT_THAT(room(), HasSubstr("\"people_count\":0"));
}

TEST_F(People, WelcomeHasTheRoleAndOthersListThePerson) {
  ScriptedClient ada = player("Ada");
  EXPECT_EQ(ada.welcome().role(), v1::ROLE_PLAYER);
  EXPECT_EQ(ada.welcome().person_id(), 1U);
  EXPECT_EQ(ada.welcome().resume_key().size(), 32U);
  EXPECT_FALSE(ada.welcome().resumed());
  ScriptedClient guest = client();
  EXPECT_EQ(guest.welcome().role(), v1::ROLE_VIEWER);
  const v1::People people = peopleWhen(ada, [](const v1::People& list) { return list.people_size() == 2; });
  EXPECT_THAT(namesOf(people), ElementsAre("Ada", "guest 2"));
  EXPECT_TRUE(guest.ws().close());
  peopleWhen(ada, [](const v1::People& list) { return list.people_size() == 1; });
}

TEST_F(People, InvisibleNameBecomesAGuestName) {
  ScriptedClient ada = player("\u202EAda\u202C  ");
  ScriptedClient blank = player(" \u3000\u2066 \u200D");  // NOLINT(misc-misleading-bidirectional): what is tested
  const v1::People people = peopleWhen(ada, [](const v1::People& list) { return list.people_size() == 2; });
  EXPECT_THAT(namesOf(people), ElementsAre("Ada", "guest 2"));
}

TEST_F(People, MayDoWhatTheirRoleAllows) {
  ScriptedClient guest = client();
  for (const v1::Command& command : {splash(), spawnBoat(0, 4), controlBoat(1, 1, 0), takeBoat(1), reset()}) {
    const v1::Reject reject = guest.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_FORBIDDEN);
    EXPECT_THAT(reject.message(), HasSubstr("yours is viewer"));
  }
  ScriptedClient ada = player();
  EXPECT_TRUE(ada.apply(splash()));
  for (const v1::Command& command :
       {reset(), setPaused(true), setSpeed(2), step(1), changeScene("x"), setParameter("wave.depth_m", 1.5)}) {
    const v1::Reject reject = ada.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_FORBIDDEN);
    EXPECT_THAT(reject.message(), HasSubstr("operator"));
  }
  ScriptedClient chief = person({.token = kOperator});
  EXPECT_EQ(chief.welcome().role(), v1::ROLE_OPERATOR);
  EXPECT_TRUE(chief.apply(setPaused(true)));
  EXPECT_TRUE(chief.apply(reset()));
}

TEST_F(People, WrongOrExpiredTokenIsRefused) {
  for (const char* token : {"wrong-wrong-wrong-1", "expired-expired-1"}) {
    ScriptedClient stranger = person({.token = token});
    const auto refusal = stranger.waitFor(v1::ServerMessage::kRefusal);
    ASSERT_TRUE(refusal) << token;
    EXPECT_THAT(refusal->refusal().message(), Not(HasSubstr(token)));
    ASSERT_TRUE(stranger.ws().waitClosed());
    EXPECT_EQ(stranger.ws().closeCode(), 4401);
  }
}

TEST_F(NoGuests, RefusesGuestsAndAcceptsTokens) {
  ScriptedClient guest = client();
  ASSERT_TRUE(guest.ws().waitClosed());
  EXPECT_EQ(guest.ws().closeCode(), 4401);
  EXPECT_EQ(player().welcome().role(), v1::ROLE_PLAYER);
}

TEST_F(People, LeaveWhenTheirTokenExpires) {
  ScriptedClient brief = person({.token = kBrief});
  ASSERT_EQ(brief.welcome().role(), v1::ROLE_PLAYER) << "the test's server took seconds to start";
  ASSERT_TRUE(brief.ws().waitClosed());
  EXPECT_EQ(brief.ws().closeCode(), 4401);
  EXPECT_THAT(brief.ws().closeReason(), HasSubstr("expired"));
}

TEST_F(People, SayHelloOnce) {
  ScriptedClient ada = player();
  ada.hello();
  ASSERT_TRUE(ada.ws().waitClosed());
  EXPECT_EQ(ada.ws().closeCode(), 1008);
}

TEST_F(People, DriveOnlyTheirOwnBoat) {
  ScriptedClient ada = player("Ada");
  ScriptedClient bob = player("Bob");
  const std::uint32_t boat_id = ada.ask(spawnBoat(0, 4)).ack().boat_id();
  ASSERT_EQ(boat_id, 2U);
  EXPECT_TRUE(ada.apply(controlBoat(boat_id, 1, 0)));
  const v1::People people = peopleWhen(bob, [&](const v1::People& list) { return !boatsOf(list, 1).empty(); });
  EXPECT_THAT(boatsOf(people, 1), ElementsAre(boat_id));

  for (const v1::Command& command : {controlBoat(boat_id, -1, 0), removeBoat(boat_id), takeBoat(boat_id)}) {
    const v1::Reject reject = bob.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_NOT_YOURS);
    EXPECT_THAT(reject.message(), HasSubstr("person 1"));
  }
  EXPECT_EQ(ada.rejected(spawnBoat(0, -4)).reason(), v1::REJECT_REASON_HAS_BOAT);
  EXPECT_EQ(ada.rejected(takeBoat(1)).reason(), v1::REJECT_REASON_HAS_BOAT);
  ScriptedClient chief = person({.token = kOperator});
  EXPECT_EQ(chief.rejected(controlBoat(boat_id, -1, 0)).reason(), v1::REJECT_REASON_NOT_YOURS)
      << "an operator too must take the boat before steering it";
  EXPECT_TRUE(chief.apply(takeBoat(boat_id)));
  EXPECT_TRUE(chief.apply(controlBoat(boat_id, -1, 0)));
  EXPECT_EQ(ada.rejected(controlBoat(boat_id, 1, 0)).reason(), v1::REJECT_REASON_NOT_YOURS);
}

TEST_F(People, TakeABoatWithoutOwner) {
  ScriptedClient ada = player();
  ScriptedClient bob = player();
  EXPECT_EQ(ada.rejected(controlBoat(1, 1, 0)).reason(), v1::REJECT_REASON_NOT_YOURS);
  EXPECT_EQ(ada.rejected(takeBoat(9)).reason(), v1::REJECT_REASON_UNKNOWN_BOAT);
  EXPECT_TRUE(ada.apply(takeBoat(1)));
  EXPECT_TRUE(ada.apply(takeBoat(1))) << "it is theirs already";
  EXPECT_EQ(bob.rejected(takeBoat(1)).reason(), v1::REJECT_REASON_NOT_YOURS);
  EXPECT_TRUE(ada.apply(controlBoat(1, 1, 0)));
  EXPECT_TRUE(ada.apply(removeBoat(1)));
  EXPECT_TRUE(ada.apply(spawnBoat(0, 4))) << "a person without a boat may launch one";
}

TEST_F(People, ResumeWithTheirBoatWhichHasStopped) {
  ScriptedClient bob = player("Bob");
  bob.subscribe(v1::LAYER_BODIES);
  ScriptedClient ada = player("Ada");
  const v1::Welcome first = ada.welcome();
  const std::uint32_t boat_id = ada.ask(spawnBoat(0, 4)).ack().boat_id();
  ASSERT_TRUE(ada.apply(controlBoat(boat_id, 1, 0.5)));
  ada.ws().vanish();
  const auto isAway = [&](const v1::People& list) {
    return std::ranges::any_of(list.people(), [&](const v1::Person& p) { return p.name() == "Ada" && p.away(); });
  };
  EXPECT_THAT(boatsOf(peopleWhen(bob, isAway), first.person_id()), ElementsAre(boat_id));
  const auto throttle = [&]() -> double {
    const auto frame = bob.nextFrame(v1::LAYER_BODIES);
    if (!frame) return -1.0;
    const auto bodies = codec::decodeBodies(*frame);
    if (!bodies) return -1.0;
    for (const auto& body : *bodies) {
      if (body.boat_id == boat_id) return body.throttle_ratio;
    }
    return -1.0;
  };
  double now = throttle();
  for (int k = 0; k < 600 && now != 0.0; ++k) now = throttle();
  EXPECT_EQ(now, 0.0) << "the boat is not steered any more";
  EXPECT_EQ(bob.rejected(takeBoat(boat_id)).reason(), v1::REJECT_REASON_NOT_YOURS);

  ScriptedClient again = player("", first.resume_key());
  EXPECT_TRUE(again.welcome().resumed());
  EXPECT_EQ(again.welcome().person_id(), first.person_id());
  EXPECT_TRUE(again.apply(controlBoat(boat_id, 1, 0)));
}

TEST_F(People, ResumeWhileTheOldConnectionHangsAndReplaceIt) {
  ScriptedClient ada = player();
  const std::uint32_t boat_id = ada.ask(spawnBoat(0, 4)).ack().boat_id();
  ScriptedClient again = player("", ada.welcome().resume_key());
  EXPECT_TRUE(again.welcome().resumed());
  ASSERT_TRUE(ada.ws().waitClosed());
  EXPECT_EQ(ada.ws().closeCode(), 4409);
  EXPECT_TRUE(again.apply(controlBoat(boat_id, 1, 0)));
}

TEST_F(ShortGrace, HandsTheBoatOverWhenItsPersonStaysAway) {
  ScriptedClient bob = player("Bob");
  ScriptedClient ada = player("Ada");
  const v1::Welcome first = ada.welcome();
  const std::uint32_t boat_id = ada.ask(spawnBoat(0, 4)).ack().boat_id();
  // She stays until he has her in a list: a person who joins and leaves between two lists is in neither.
  peopleWhen(bob, [&](const v1::People& list) { return list.people_size() == 2; });
  ada.ws().vanish();
  peopleWhen(bob, [&](const v1::People& list) { return list.people_size() == 1; });
  EXPECT_TRUE(bob.apply(takeBoat(boat_id)));
  EXPECT_TRUE(bob.apply(controlBoat(boat_id, 1, 0)));
  EXPECT_FALSE(player("", first.resume_key()).welcome().resumed()) << "the grace time is over";
}

TEST_F(People, LoseTheirBoatsWhenAResetRemovesThem) {
  ScriptedClient ada = player();
  ASSERT_TRUE(ada.apply(spawnBoat(0, 4)));
  ScriptedClient chief = person({.token = kOperator});
  ASSERT_TRUE(chief.apply(reset()));
  EXPECT_TRUE(ada.apply(spawnBoat(0, 4))) << "the boat is gone, so another may come";
}

}  // namespace
}  // namespace spindrift::test
