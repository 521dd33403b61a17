// A class of forty: a lesson that an operator gives, a race with boats that steer by what they are sent, a ball.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

constexpr const char* kOperator = "operator-operator-1";
constexpr std::size_t kPlayerCount = 40;

/// Two marks 15 m apart and two goals, on water that is as cheap as it can be for forty boats.
constexpr const char* kPond = R"(
  wave {
    resolution_count: 48 side_m: 48 depth_m: 2
    boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_REFLECT
    boundary_minus_z: WAVE_BOUNDARY_REFLECT boundary_plus_z: WAVE_BOUNDARY_REFLECT
  }
  boats { capacity_count: 40 }
  floaters { capacity_count: 8 }
  course {
    start_x_m: -2
    marks { x_m: 10 z_m: -4 radius_m: 5 }
    marks { x_m: 5 z_m: 10 radius_m: 5 }
    red_goal { x_m: -20 length_m: 2 width_m: 4 }
    blue_goal { x_m: 20 length_m: 2 width_m: 4 }
  }
  stream { frame_rate_hz: 60 }
)";

v1::Command setLesson(const v1::Lesson& lesson) {
  v1::Command out;
  *out.mutable_set_lesson()->mutable_lesson() = lesson;
  return out;
}

v1::Command mute(std::uint32_t person_id, bool muted) {
  v1::Command out;
  out.mutable_mute_person()->set_person_id(person_id);
  out.mutable_mute_person()->set_muted(muted);
  return out;
}

v1::Command startGame(v1::GameKind kind, double countdown_s = 0.0) {
  v1::Command out;
  out.mutable_start_game()->set_kind(kind);
  out.mutable_start_game()->set_laps_count(1);
  out.mutable_start_game()->set_goals_count(1);
  out.mutable_start_game()->set_countdown_s(countdown_s);
  return out;
}

v1::Command endGame() {
  v1::Command out;
  out.mutable_end_game();
  return out;
}

/// A boat without a position: the room chooses its place.
v1::Command launch() {
  v1::Command out;
  out.mutable_spawn_boat();
  return out;
}

class ClassTest : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kPond}}; }
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(std::string("operator ") + kOperator, "tokens", core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
    options.network.address_session_share = 1.0;
  }
  ScriptedClient teacher() { return person({.name = "teacher", .token = kOperator}); }

  /// The next game that `wanted` accepts; drops older ones.
  static v1::Game gameWhen(ScriptedClient& client, const std::function<bool(const v1::Game&)>& wanted) {
    while (const auto message = client.waitFor(v1::ServerMessage::kGame)) {
      if (wanted(message->game())) return message->game();
    }
    ADD_FAILURE() << "no such game came";
    return {};
  }
};

TEST_F(ClassTest, ANewcomerIsToldTheLessonAndTheGame) {
  ScriptedClient ada = client();
  const auto lesson = ada.waitFor(v1::ServerMessage::kLesson);
  ASSERT_TRUE(lesson);
  EXPECT_FALSE(lesson->lesson().frozen());
  const auto game = ada.waitFor(v1::ServerMessage::kGame);
  ASSERT_TRUE(game);
  EXPECT_EQ(game->game().kind(), v1::GAME_KIND_UNSPECIFIED);
}

TEST_F(ClassTest, OnTheLoopbackPhonesAreToldNoAddress) {
  const HttpAnswer answer = httpRequest(server().port(), "GET", "/api/v1/join");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_EQ(answer.body, "{\"urls\":[]}\n");
  EXPECT_EQ(httpRequest(server().port(), "POST", "/api/v1/join", "Content-Length: 0\r\n").status, 405U);
}

TEST_F(ClassTest, PlayersMayNotGiveLessonsAndOperatorsMayDoEverything) {
  ScriptedClient ada = client();
  ScriptedClient operator_ = teacher();
  for (const v1::Command& command : {setLesson({}), mute(1, true), startGame(v1::GAME_KIND_RACE), endGame()})
    EXPECT_EQ(ada.rejected(command).reason(), v1::REJECT_REASON_FORBIDDEN) << command.ShortDebugString();
  v1::Lesson frozen;
  frozen.set_frozen(true);
  ASSERT_TRUE(operator_.apply(setLesson(frozen)));
  const v1::Reject refused = ada.rejected(splash(0.2));
  EXPECT_EQ(refused.reason(), v1::REJECT_REASON_NOT_NOW);
  EXPECT_THAT(refused.message(), HasSubstr("frozen"));
  EXPECT_TRUE(operator_.apply(splash(0.2)));
  EXPECT_EQ(operator_.rejected(mute(77, true)).reason(), v1::REJECT_REASON_UNKNOWN_PERSON);
}

TEST_F(ClassTest, MutingStopsThePersonsBoat) {
  ScriptedClient ada = client();
  ScriptedClient operator_ = teacher();
  const v1::ServerMessage launched = ada.ask(launch());
  ASSERT_TRUE(launched.has_ack()) << launched.reject().message();
  const std::uint32_t boat_id = launched.ack().boat_id();
  ASSERT_TRUE(ada.apply(controlBoat(boat_id, 1, 0)));
  ASSERT_TRUE(operator_.apply(mute(ada.welcome().person_id(), true)));
  operator_.subscribe(v1::LAYER_BODIES);
  EXPECT_EQ(ada.rejected(controlBoat(boat_id, 1, 0)).reason(), v1::REJECT_REASON_NOT_NOW);
  bool stands = false;
  for (int k = 0; k < 600 && !stands; ++k) {
    const auto frame = operator_.nextFrame(v1::LAYER_BODIES);
    ASSERT_TRUE(frame);
    const auto bodies = codec::decodeBodies(*frame);
    ASSERT_TRUE(bodies);
    stands = bodies->size() == 1 && bodies->front().throttle_ratio == 0.0;
  }
  EXPECT_TRUE(stands);
  ASSERT_TRUE(operator_.apply(mute(ada.welcome().person_id(), false)));
  EXPECT_TRUE(ada.apply(controlBoat(boat_id, 1, 0)));
}

TEST_F(ClassTest, TheBallIsPutInTheMiddleAndPlayersMayNotTouchIt) {
  ScriptedClient ada = client();
  ScriptedClient operator_ = teacher();
  ASSERT_TRUE(operator_.apply(startGame(v1::GAME_KIND_BALL)));
  const v1::Game game = gameWhen(operator_, [](const v1::Game& g) { return g.ball_floater_id() != 0; });
  EXPECT_EQ(game.phase(), v1::GAME_PHASE_RUNNING);
  EXPECT_EQ(ada.rejected(holdFloater(game.ball_floater_id(), 0, 0)).reason(), v1::REJECT_REASON_NOT_NOW);
  EXPECT_EQ(ada.rejected(removeFloater(game.ball_floater_id())).reason(), v1::REJECT_REASON_NOT_NOW);
  // An operator's hand drags it into the goal that red defends.
  v1::Game over;
  for (int k = 0; k < 2000 && over.phase() != v1::GAME_PHASE_OVER; ++k) {
    const double x_m = std::max(-20.0, -0.4 * k);
    (void)operator_.ask(holdFloater(game.ball_floater_id(), x_m, 0));
    if (k % 20 == 19) {
      ASSERT_TRUE(operator_.barrier());
      over = server().simulation().find("main")->lesson()->game;
    }
  }
  EXPECT_EQ(over.blue_goals_count(), 1U);
  EXPECT_EQ(over.winner_team(), v1::TEAM_BLUE);
}

TEST_F(ClassTest, ALeverThatIsHeldBeforeTheCountdownCountsAtTheStart) {
  ScriptedClient ada = client();
  ScriptedClient operator_ = teacher();
  const std::uint32_t boat_id = ada.ask(launch()).ack().boat_id();
  ASSERT_TRUE(ada.apply(controlBoat(boat_id, 0.5, 0)));
  ASSERT_TRUE(operator_.apply(startGame(v1::GAME_KIND_RACE, 1.0)));
  const double begins_s =
      gameWhen(operator_, [](const v1::Game& g) { return g.phase() == v1::GAME_PHASE_COUNTDOWN; }).begins_s();
  operator_.subscribe(v1::LAYER_BODIES);
  double throttle_ratio = 0.0;
  for (int k = 0; k < 2000 && throttle_ratio == 0.0; ++k) {
    const auto frame = operator_.nextFrame(v1::LAYER_BODIES);
    ASSERT_TRUE(frame);
    const auto bodies = codec::decodeBodies(*frame);
    ASSERT_TRUE(bodies);
    ASSERT_EQ(bodies->size(), 1U);
    throttle_ratio = bodies->front().throttle_ratio;
    EXPECT_TRUE(throttle_ratio == 0.0 || frame->time_s() >= begins_s);
  }
  EXPECT_NEAR(throttle_ratio, 0.5, 0.01);
}

TEST_F(ClassTest, AResetEndsTheGame) {
  ScriptedClient operator_ = teacher();
  ASSERT_TRUE(operator_.apply(startGame(v1::GAME_KIND_RACE, 60)));
  (void)gameWhen(operator_, [](const v1::Game& g) { return g.phase() == v1::GAME_PHASE_COUNTDOWN; });
  ASSERT_TRUE(operator_.apply(reset()));
  (void)gameWhen(operator_, [](const v1::Game& g) { return g.kind() == v1::GAME_KIND_UNSPECIFIED; });
}

/// Forty clients with a boat each.
class FullClass : public ClassTest {
 protected:
  void SetUp() override {
    ClassTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    operator_.emplace(teacher());
    for (std::size_t k = 0; k < kPlayerCount; ++k) {
      players_.push_back(client());
      const v1::ServerMessage launched = players_.back().ask(launch());
      ASSERT_TRUE(launched.has_ack()) << launched.reject().message();
      boat_ids_.push_back(launched.ack().boat_id());
    }
  }
  /// Boats by their ids, as the next frame shows them.
  std::map<std::uint32_t, codec::BodySample> boats() {
    std::map<std::uint32_t, codec::BodySample> out;
    const auto frame = operator_->nextFrame(v1::LAYER_BODIES);
    if (!frame) return out;
    time_s_ = frame->time_s();
    if (const auto bodies = codec::decodeBodies(*frame)) {
      for (const codec::BodySample& one : *bodies) out[one.boat_id] = one;
    }
    return out;
  }

  std::optional<ScriptedClient> operator_;
  std::vector<ScriptedClient> players_;
  std::vector<std::uint32_t> boat_ids_;
  double time_s_ = 0.0;
};

TEST_F(FullClass, BoatsWithoutAPositionAreLaunchedBesideEachOther) {
  operator_->subscribe(v1::LAYER_BODIES);
  std::map<std::uint32_t, codec::BodySample> now;
  while (now.size() < kPlayerCount) {
    now = boats();
    ASSERT_FALSE(HasFailure());
  }
  for (const auto& [id, one] : now) {
    EXPECT_NEAR(one.heading_rad, 0.0, 0.2);
    for (const auto& [other_id, other] : now) {
      if (other_id == id) continue;
      EXPECT_GT(std::hypot(one.position_m[0] - other.position_m[0], one.position_m[2] - other.position_m[2]), 1.0)
          << id << " and " << other_id;
    }
  }
}

TEST_F(FullClass, TeamsAreEqual) {
  v1::Lesson teams;
  teams.set_teams(true);
  ASSERT_TRUE(operator_->apply(setLesson(teams)));
  const auto isDealt = [](const v1::ServerMessage& message) {
    const auto count = [&](v1::Team team) {
      return std::ranges::count(message.people().people(), team, &v1::Person::team);
    };
    return message.has_people() && count(v1::TEAM_RED) == 20 && count(v1::TEAM_BLUE) == 20;
  };
  EXPECT_TRUE(operator_->waitFor(isDealt));
}

TEST_F(FullClass, OneOfThoseWhoSteerRoundTheMarksWinsTheRace) {
  constexpr std::size_t kSteeredCount = 4;
  v1::Lesson only_boats;
  only_boats.add_tools(v1::TOOL_BOAT);
  ASSERT_TRUE(operator_->apply(setLesson(only_boats)));
  EXPECT_EQ(players_[0].rejected(splash(0.2)).reason(), v1::REJECT_REASON_NOT_NOW);
  ASSERT_TRUE(operator_->apply(setSpeed(4)));
  operator_->subscribe(v1::LAYER_BODIES);
  ASSERT_TRUE(operator_->apply(startGame(v1::GAME_KIND_RACE, 2.0)));
  // Those who push the lever too early wait for the start.
  for (std::size_t k = 0; k < kSteeredCount; ++k) ASSERT_TRUE(players_[k].apply(controlBoat(boat_ids_[k], 1, 0)));
  const rooms::Room& room = *server().simulation().find("main");
  v1::Game game = room.lesson()->game;
  bool moved_early = false;
  for (int k = 0; k < 20'000 && game.phase() != v1::GAME_PHASE_OVER; ++k) {
    const auto now = boats();
    ASSERT_FALSE(now.empty());
    game = room.lesson()->game;  // as the clients are told it
    for (std::size_t person = 0; person < kSteeredCount; ++person) {
      const auto boat = now.find(boat_ids_[person]);
      ASSERT_NE(boat, now.end());
      if (game.begins_s() > 0 && time_s_ < game.begins_s()) {
        moved_early = moved_early || boat->second.throttle_ratio != 0.0;
        continue;
      }
      const auto racer =
          std::ranges::find(game.racers(), players_[person].welcome().person_id(), &v1::Racer::person_id);
      if (racer == game.racers().end() || game.phase() != v1::GAME_PHASE_RUNNING) continue;
      const v1::CourseMark& mark = operator_->greeting().scene().course().marks(static_cast<int>(racer->next_mark()));
      const double wanted =
          std::atan2(mark.z_m() - boat->second.position_m[2], mark.x_m() - boat->second.position_m[0]);
      const double turn = std::remainder(wanted - boat->second.heading_rad, 2 * std::numbers::pi);
      ASSERT_TRUE(players_[person].apply(controlBoat(boat_ids_[person], 1, std::clamp(2 * turn, -1.0, 1.0))));
    }
  }
  EXPECT_FALSE(moved_early);
  ASSERT_EQ(game.phase(), v1::GAME_PHASE_OVER) << game.ShortDebugString();
  EXPECT_GE(game.winner_person_id(), players_.front().welcome().person_id());
  EXPECT_LT(game.winner_person_id(), players_[kSteeredCount].welcome().person_id());
  EXPECT_EQ(game.racers(0).person_id(), game.winner_person_id());
  EXPECT_EQ(game.racers(0).laps_count(), 1U);
  EXPECT_GT(game.racers(0).lap_best_s(), 1.0);
  EXPECT_NEAR(game.ends_s() - game.begins_s(), game.racers(0).finished_s(), 1e-6);
  EXPECT_EQ(game.racers_size(), static_cast<int>(kPlayerCount));
  const v1::Game told = gameWhen(*operator_, [](const v1::Game& g) { return g.phase() == v1::GAME_PHASE_OVER; });
  EXPECT_EQ(told.winner_person_id(), game.winner_person_id());
}

}  // namespace
}  // namespace spindrift::test
