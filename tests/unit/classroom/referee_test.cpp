// Races and goals, counted from positions.
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/classroom/referee.h>

namespace spindrift::rooms {
namespace {

using Boat = Referee::Boat;

/// A square of marks 20 m apart, and goals at both ends of a field of 40 m.
v1::Course square() {
  v1::Course out;
  for (const auto& [x, z] : {std::pair{10.0, -10.0}, {10.0, 10.0}, {-10.0, 10.0}, {-10.0, -10.0}}) {
    v1::CourseMark& mark = *out.add_marks();
    mark.set_x_m(x);
    mark.set_z_m(z);
    mark.set_radius_m(2);
  }
  out.mutable_red_goal()->set_x_m(-20);
  out.mutable_blue_goal()->set_x_m(20);
  for (v1::CourseGoal* goal : {out.mutable_red_goal(), out.mutable_blue_goal()}) {
    goal->set_length_m(2);
    goal->set_width_m(6);
  }
  return out;
}

struct RefereeTest : testing::Test {
  Referee referee;
  std::uint64_t tick = 100;
  double time_s = 5.0;

  void start(v1::GameKind kind, double countdown_s = 0.0, std::uint32_t count = 1) {
    v1::StartGame wanted;
    wanted.set_kind(kind);
    wanted.set_laps_count(count);
    wanted.set_goals_count(count);
    wanted.set_countdown_s(countdown_s);
    referee.start(wanted, square(), tick, time_s);
  }
  void see(double at_s, const std::vector<Boat>& boats) {
    time_s = at_s;
    referee.advance(at_s);
    referee.see({.tick = ++tick, .time_s = at_s, .boats = boats});
  }
  void seeBall(std::optional<Referee::Position> ball) {
    time_s += 0.1;
    referee.advance(time_s);
    referee.see({.tick = ++tick, .time_s = time_s, .boats = {}, .ball = ball});
  }
  void putBall(std::uint32_t floater_id) {
    ASSERT_TRUE(referee.wantedBall());
    referee.ballIsPut(floater_id, tick);
  }
  /// One lap of a boat in samples that lie on the marks' far sides: straight lines between them cross every mark.
  void lap(double& at_s, std::uint32_t person_id, double leg_s) {
    for (const auto& [x, z] : {std::pair{10.0, -10.0}, {10.0, 10.0}, {-10.0, 10.0}, {-10.0, -10.0}})
      see(at_s += leg_s, {{person_id, person_id, v1::TEAM_RED, {x, z}}});
  }
  static Boat boat(std::uint32_t person_id, double x_m, double z_m, v1::Team team = v1::TEAM_UNSPECIFIED) {
    return {100 + person_id, person_id, team, {x_m, z_m}};
  }
};

TEST_F(RefereeTest, ACountdownHoldsBoatsUntilTheStart) {
  start(v1::GAME_KIND_RACE, 3.0);
  EXPECT_TRUE(referee.holdsBoats());
  EXPECT_EQ(referee.game().phase(), v1::GAME_PHASE_COUNTDOWN);
  EXPECT_DOUBLE_EQ(referee.game().begins_s(), 8.0);
  see(7.9, {boat(1, 10, -10)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 0U) << "marks count from the start on";
  referee.advance(8.0);
  EXPECT_FALSE(referee.holdsBoats());
  EXPECT_EQ(referee.game().phase(), v1::GAME_PHASE_RUNNING);
}

TEST_F(RefereeTest, MarksCountInTheirOrder) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {boat(1, 0, 0)});
  see(6.0, {boat(1, 10, 10)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 0U) << "the second one first";
  see(7.0, {boat(1, 10, -9)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 1U);
}

TEST_F(RefereeTest, AFastBoatDoesNotJumpOverAMark) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {boat(1, 0, -11)});
  see(5.1, {boat(1, 20, -11)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 1U) << "its way came within 1 m";
  see(5.2, {boat(1, 12.5, 10.1)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 1U) << "ends 2.5 m beside the next";
}

TEST_F(RefereeTest, OneStraightWayMayPassSeveralMarks) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {boat(1, 10, -20)});
  see(6.0, {boat(1, 10, 20)});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 2U);
}

TEST_F(RefereeTest, TheFirstToFinishWinsAndTheOthersAreCountedOn) {
  start(v1::GAME_KIND_RACE, 0.0, 1);
  const auto both = [&](double at_s, double x1, double z1, double x2, double z2) {
    see(at_s, {boat(1, x1, z1, v1::TEAM_RED), boat(2, x2, z2, v1::TEAM_BLUE)});
  };
  both(5, 0, -10, 0, -10);
  both(6, 10, -10, 10, -10);
  both(7, 10, 10, 10, 10);
  both(8, -10, 10, -10, 10);
  both(9, -10, 0, -10, -7);  // person 2 is nearer to the last mark
  EXPECT_EQ(referee.game().racers(0).person_id(), 2U);
  both(10, -10, -20, -10, -9);  // both finish between two samples: who crosses first counts
  const v1::Game over = referee.game();
  EXPECT_EQ(over.phase(), v1::GAME_PHASE_OVER);
  EXPECT_EQ(over.winner_person_id(), 1U);
  EXPECT_EQ(over.winner_team(), v1::TEAM_RED);
  EXPECT_NEAR(over.racers(0).finished_s(), 4.4, 1e-9) << "8 m of 20 m after the fourth second";
  EXPECT_NEAR(over.racers(1).finished_s(), 4.5, 1e-9);
  EXPECT_NEAR(over.ends_s(), 9.4, 1e-9);
  EXPECT_FALSE(referee.isWatching()) << "nobody is on the way";
}

TEST_F(RefereeTest, LapsAreCountedAndTheBestOneIsKept) {
  start(v1::GAME_KIND_RACE, 0.0, 3);
  double at_s = 5.0;
  see(at_s, {boat(7, 0, 0)});
  lap(at_s, 7, 4.0);
  EXPECT_EQ(referee.game().racers(0).laps_count(), 1U);
  const double first_s = referee.game().racers(0).lap_best_s();
  lap(at_s, 7, 2.0);
  EXPECT_LT(referee.game().racers(0).lap_best_s(), first_s);
  const double best_s = referee.game().racers(0).lap_best_s();
  EXPECT_NEAR(best_s, 8.0, 0.5);
  lap(at_s, 7, 3.0);
  EXPECT_EQ(referee.game().racers(0).lap_best_s(), best_s);
  EXPECT_EQ(referee.game().winner_person_id(), 7U);
}

TEST_F(RefereeTest, WhoLeavesIsTakenOffTheListAndTheRaceRunsOn) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {boat(1, 0, 0), boat(2, 1, 0)});
  see(6.0, {boat(2, 10, -10)});
  ASSERT_EQ(referee.game().racers_size(), 1);
  EXPECT_EQ(referee.game().racers(0).person_id(), 2U);
  EXPECT_EQ(referee.game().phase(), v1::GAME_PHASE_RUNNING);
  see(7.0, {});
  EXPECT_EQ(referee.game().racers_size(), 0);
  EXPECT_TRUE(referee.isWatching());
}

TEST_F(RefereeTest, ANewBoatOfAPersonComesFromNowhere) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {{1, 1, v1::TEAM_UNSPECIFIED, {0, -10}}});
  see(6.0, {{2, 1, v1::TEAM_UNSPECIFIED, {20, -10}}});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 0U) << "no straight line joins the two";
  see(7.0, {{1, 1, v1::TEAM_UNSPECIFIED, {10, -10}}, {2, 1, v1::TEAM_UNSPECIFIED, {20, 0}}});
  EXPECT_EQ(referee.game().racers(0).next_mark(), 0U) << "the boat with which he races is elsewhere";
}

TEST_F(RefereeTest, BoatsWithoutOwnersAndPositionsThatAreNoNumbersDoNotRace) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {{1, 0, v1::TEAM_UNSPECIFIED, {10, -10}}});
  see(6.0, {boat(1, std::numeric_limits<double>::quiet_NaN(), 0)});
  EXPECT_EQ(referee.game().racers_size(), 0);
}

TEST_F(RefereeTest, SamplesFromBeforeTheGameDoNotCount) {
  see(5.0, {boat(1, 10, -10)});
  start(v1::GAME_KIND_RACE);
  const std::vector<Boat> boats{boat(1, 10, -10)};
  referee.see({.tick = tick - 1, .time_s = 60.0, .boats = boats});
  EXPECT_EQ(referee.game().racers_size(), 0) << "a frame that was on its way when the scene began again";
}

TEST_F(RefereeTest, AGoalCountsForTheOtherTeamAndTheBallIsPutBack) {
  start(v1::GAME_KIND_BALL, 0.0, 2);
  ASSERT_TRUE(referee.wantedBall());
  EXPECT_EQ(referee.wantedBall()->x_m, 0.0);
  putBall(7);
  EXPECT_FALSE(referee.wantedBall());
  seeBall(Referee::Position{0, 0});
  seeBall(Referee::Position{-20, 1});
  EXPECT_EQ(referee.game().blue_goals_count(), 1U) << "red defends the goal at -x";
  EXPECT_EQ(referee.game().phase(), v1::GAME_PHASE_RUNNING);
  seeBall(Referee::Position{-20, 1});
  EXPECT_EQ(referee.game().blue_goals_count(), 1U) << "the ball in the goal counts once";
  putBall(8);
  seeBall(Referee::Position{0, 0});
  seeBall(Referee::Position{-25, 0});
  EXPECT_EQ(referee.game().blue_goals_count(), 2U) << "it flew through";
  EXPECT_EQ(referee.game().phase(), v1::GAME_PHASE_OVER);
  EXPECT_EQ(referee.game().winner_team(), v1::TEAM_BLUE);
  EXPECT_FALSE(referee.wantedBall());
}

TEST_F(RefereeTest, ALostBallIsPutBackWithoutAGoal) {
  start(v1::GAME_KIND_BALL);
  putBall(7);
  referee.see({.tick = tick, .time_s = time_s});
  EXPECT_FALSE(referee.wantedBall()) << "a frame from before it was put there";
  seeBall(std::nullopt);
  EXPECT_TRUE(referee.wantedBall());
  EXPECT_EQ(referee.game().red_goals_count() + referee.game().blue_goals_count(), 0U);
}

TEST_F(RefereeTest, TheEndForgetsTheGame) {
  start(v1::GAME_KIND_RACE);
  see(5.0, {boat(1, 0, 0)});
  referee.end();
  EXPECT_EQ(referee.game().SerializeAsString(), v1::Game().SerializeAsString());
  EXPECT_FALSE(referee.isWatching());
}

TEST_F(RefereeTest, TheListOfRacersIsBounded) {
  start(v1::GAME_KIND_RACE);
  std::vector<Boat> boats;
  for (std::uint32_t person = 1; person <= 500; ++person) boats.push_back(boat(person, 0, 0));
  see(6.0, boats);
  EXPECT_EQ(referee.game().racers_size(), 128);
}

}  // namespace
}  // namespace spindrift::rooms
