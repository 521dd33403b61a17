// What a lesson allows to players, and how it limits their force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/classroom/lesson.h>
#include <spindrift/rooms/roster.h>

#include "commands.h"

namespace spindrift::rooms {
namespace {

using core::Role;
using testing::HasSubstr;

v1::Command thrown() {
  v1::Command out = test::spawnFloater(0, 0);
  out.mutable_spawn_floater()->mutable_floater()->set_velocity_x_mps(4);
  return out;
}

v1::Command rain() {
  v1::Command out = test::stroke(1, 0, 0, 0);
  out.mutable_stroke()->set_tool(v1::STROKE_TOOL_RAIN);
  return out;
}

v1::RejectReason reasonOf(const v1::Lesson& lesson, const v1::Command& command, bool is_muted = false,
                          Role role = Role::kPlayer) {
  const auto refused = refuse(lesson, is_muted, role, command);
  return refused ? refused->reason() : v1::REJECT_REASON_UNSPECIFIED;
}

TEST(Lesson, EveryCommandOfAPlayerThatChangesTheWaterHasATool) {
  EXPECT_EQ(toolOf(test::stroke(1, 0, 0, 0)), v1::TOOL_FINGER);
  EXPECT_EQ(toolOf(rain()), v1::TOOL_RAIN);
  EXPECT_EQ(toolOf(test::splash()), v1::TOOL_SPLASH);
  EXPECT_EQ(toolOf(test::breakingWave(v1::SIDE_PLUS_X, 0.2, 3)), v1::TOOL_WAVE);
  EXPECT_EQ(toolOf(test::spawnFloater(0, 0)), v1::TOOL_FLOAT);
  EXPECT_EQ(toolOf(thrown()), v1::TOOL_THROW);
  EXPECT_EQ(toolOf(test::holdFloater(1, 0, 0)), v1::TOOL_FLOAT);
  EXPECT_EQ(toolOf(test::removeFloater(1)), v1::TOOL_FLOAT);
  for (const v1::Command& command :
       {test::spawnBoat(0, 0), test::controlBoat(1, 1, 0), test::takeBoat(1), test::removeBoat(1)})
    EXPECT_EQ(toolOf(command), v1::TOOL_BOAT) << command.ShortDebugString();
  EXPECT_EQ(toolOf(test::reset()), v1::TOOL_UNSPECIFIED);
}

TEST(Lesson, TheDefaultAllowsEverything) {
  for (const v1::Command& command : {test::splash(), rain(), thrown(), test::spawnBoat(0, 0)})
    EXPECT_EQ(reasonOf({}, command), v1::REJECT_REASON_UNSPECIFIED);
}

TEST(Lesson, FrozenAndMutedPlayersAreRefusedAndOperatorsAreNot) {
  v1::Lesson frozen;
  frozen.set_frozen(true);
  EXPECT_EQ(reasonOf(frozen, test::splash()), v1::REJECT_REASON_NOT_NOW);
  EXPECT_EQ(reasonOf({}, test::splash(), true), v1::REJECT_REASON_NOT_NOW);
  EXPECT_EQ(reasonOf(frozen, test::splash(), true, Role::kOperator), v1::REJECT_REASON_UNSPECIFIED);
}

TEST(Lesson, OnlyToolsThatAreHandedOutAreTakenAndTheRefusalNamesTheOther) {
  v1::Lesson lesson;
  lesson.add_tools(v1::TOOL_BOAT);
  EXPECT_EQ(reasonOf(lesson, test::controlBoat(1, 1, 0)), v1::REJECT_REASON_UNSPECIFIED);
  const auto refused = refuse(lesson, false, Role::kPlayer, rain());
  ASSERT_TRUE(refused);
  EXPECT_THAT(refused->message(), testing::AllOf(HasSubstr("rain is not handed out"), HasSubstr("an operator")));
}

TEST(Lesson, GaugesNeedNoToolButTheRightToCommand) {
  v1::Lesson lesson;
  lesson.add_tools(v1::TOOL_BOAT);
  for (const v1::Command& command : {test::placeGauge(0, 0), test::removeGauge(1)}) {
    EXPECT_EQ(reasonOf(lesson, command), v1::REJECT_REASON_UNSPECIFIED);
    EXPECT_EQ(reasonOf(lesson, command, true), v1::REJECT_REASON_NOT_NOW) << "muted";
  }
  lesson.set_frozen(true);
  EXPECT_EQ(reasonOf(lesson, test::placeGauge(0, 0)), v1::REJECT_REASON_NOT_NOW);
}

TEST(Lesson, ForceScalesWhatACommandDoesAndStaysInRange) {
  v1::Command splash = test::splash(0.8);
  limitForce(0.5, splash);
  EXPECT_DOUBLE_EQ(splash.splash().depth_m(), 0.4);
  EXPECT_DOUBLE_EQ(splash.splash().radius_m(), 1.5);
  v1::Command flat = test::splash(0.0012);
  limitForce(0.05, flat);
  EXPECT_DOUBLE_EQ(flat.splash().depth_m(), 0.0001) << "the least that the field takes";
  v1::Command finger = test::stroke(1, 0, 0, 0);
  finger.mutable_stroke()->mutable_points(0)->set_pressure_ratio(0.6);
  limitForce(0.5, finger);
  EXPECT_DOUBLE_EQ(finger.stroke().points(0).pressure_ratio(), 0.3);
  v1::Command boat = test::controlBoat(1, -1, 1);
  limitForce(0.25, boat);
  EXPECT_DOUBLE_EQ(boat.control_boat().throttle_ratio(), -0.25);
  EXPECT_DOUBLE_EQ(boat.control_boat().rudder_ratio(), 1.0);
  v1::Command stone = thrown();
  stone.mutable_spawn_floater()->mutable_floater()->set_size_m(1);
  stone.mutable_spawn_floater()->mutable_floater()->set_y_m(4.5);
  limitForce(0.5, stone);
  EXPECT_DOUBLE_EQ(stone.spawn_floater().floater().velocity_x_mps(), 2.0);
  EXPECT_DOUBLE_EQ(stone.spawn_floater().floater().y_m(), 2.5);
  v1::Command same = test::splash(0.8);
  limitForce(1.0, same);
  EXPECT_DOUBLE_EQ(same.splash().depth_m(), 0.8);
}

struct LessonOfARoom : testing::Test {
  Roster roster{std::chrono::seconds(10)};
  std::uint32_t arrive(core::SessionId session, Role role = Role::kPlayer, const std::string& key = "") {
    return roster.arrive({.session = session, .role = role, .resume_key = key}).person_id;
  }
  int countOf(v1::Team team) const {
    const v1::People people = roster.people();
    return static_cast<int>(std::ranges::count(people.people(), team, &v1::Person::team));
  }
};

TEST_F(LessonOfARoom, TeamsAreDealtEquallyAndWhoComesInGetsTheSmallerOne) {
  for (core::SessionId session = 1; session <= 5; ++session) arrive(session);
  arrive(6, Role::kOperator);
  v1::Lesson lesson;
  lesson.set_teams(true);
  roster.setLesson(lesson);
  EXPECT_EQ(countOf(v1::TEAM_RED) + countOf(v1::TEAM_BLUE), 5);
  EXPECT_EQ(countOf(v1::TEAM_RED), 3);
  arrive(7);
  EXPECT_EQ(countOf(v1::TEAM_BLUE), 3);
  EXPECT_TRUE(roster.setTeam(1, v1::TEAM_BLUE));
  roster.setLesson(lesson);
  EXPECT_EQ(countOf(v1::TEAM_BLUE), 4) << "teams that last are not dealt again";
  EXPECT_FALSE(roster.setTeam(99, v1::TEAM_RED));
  roster.setLesson({});
  EXPECT_EQ(countOf(v1::TEAM_UNSPECIFIED), 7);
}

TEST_F(LessonOfARoom, AMutedPersonStaysMutedThroughANewPageAndARestart) {
  const Admission first = roster.arrive({.session = 1, .role = Role::kPlayer});
  EXPECT_TRUE(roster.mute(first.person_id, true));
  EXPECT_FALSE(roster.mute(99, true));
  const Roster::Clock::time_point now{};
  roster.leave(1, now);
  EXPECT_EQ(arrive(2, Role::kPlayer, first.resume_key), first.person_id);
  EXPECT_TRUE(roster.refuse({.person_id = first.person_id, .role = Role::kPlayer}, test::splash()));
  v1::Lesson lesson;
  lesson.set_frozen(true);
  roster.setLesson(lesson);
  Roster other{std::chrono::seconds(10)};
  other.restore(roster.kept(), now);
  EXPECT_TRUE(other.lesson().frozen());
  EXPECT_TRUE(other.people().people(0).muted());
}

}  // namespace
}  // namespace spindrift::rooms
