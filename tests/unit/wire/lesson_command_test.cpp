// Lessons, teams and games as clients send them, hostile ones among them.
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

constexpr const char* kWater =
    "wave { side_m: 20 resolution_count: 64 depth_m: 2 boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: "
    "WAVE_BOUNDARY_REFLECT boundary_minus_z: WAVE_BOUNDARY_REFLECT boundary_plus_z: WAVE_BOUNDARY_REFLECT } ";
constexpr const char* kMarks = "marks { x_m: 5 radius_m: 2 } marks { x_m: -5 radius_m: 2 } ";
constexpr const char* kGoals = "red_goal { x_m: -8 width_m: 4 } blue_goal { x_m: 8 width_m: 4 } ";

/// The rejection of a command for a scene; or none, with the command completed.
CommandRejection complete(v1::Command& command, const std::string& parts) {
  const auto scene = scene::parseSceneText(kWater + parts, "small.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  auto checked = checkCommand(command);
  if (const auto* rejection = std::get_if<CommandRejection>(&checked)) return *rejection;
  command = std::get<v1::Command>(std::move(checked));
  return completeCommand(command, scene ? *scene : v1::Scene{}).value_or(CommandRejection{});
}

v1::Command game(v1::GameKind kind) {
  v1::Command out;
  out.mutable_start_game()->set_kind(kind);
  return out;
}

TEST(LessonCommands, DefaultsAreFilledInAndNoTeamStaysNone) {
  v1::Command lesson;
  lesson.mutable_set_lesson();
  EXPECT_EQ(complete(lesson, "").reason(), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(lesson.set_lesson().lesson().force_ratio(), 1.0);
  v1::Command team;
  team.mutable_set_team()->set_person_id(3);
  EXPECT_EQ(complete(team, "").reason(), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(team.set_team().team(), v1::TEAM_UNSPECIFIED);
  v1::Command race;
  race.mutable_start_game();
  EXPECT_EQ(complete(race, "boats {} course { " + std::string(kMarks) + "}").reason(), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(race.start_game().kind(), v1::GAME_KIND_RACE);
  EXPECT_EQ(race.start_game().laps_count(), 2U);
}

TEST(LessonCommands, ForceThatIsNoShareIsRefused) {
  for (const double force : {std::numeric_limits<double>::quiet_NaN(), 0.0, -1.0, 1.5}) {
    v1::Command command;
    command.mutable_set_lesson()->mutable_lesson()->set_force_ratio(force);
    const CommandRejection refused = complete(command, "");
    EXPECT_EQ(refused.field(), "set_lesson.lesson.force_ratio") << force;
  }
}

TEST(LessonCommands, ToolsAreKnownAndNamedOnce) {
  v1::Command command;
  v1::Lesson& lesson = *command.mutable_set_lesson()->mutable_lesson();
  lesson.add_tools(v1::TOOL_BOAT);
  lesson.add_tools(v1::TOOL_BOAT);
  EXPECT_THAT(complete(command, "").message(), HasSubstr("TOOL_BOAT is named twice"));
  lesson.clear_tools();
  lesson.add_tools(static_cast<v1::Tool>(99));
  EXPECT_EQ(complete(command, "").field(), "set_lesson.lesson.tools");
  lesson.clear_tools();
  for (int k = 0; k < 5000; ++k) lesson.add_tools(v1::TOOL_UNSPECIFIED);
  EXPECT_EQ(complete(command, "").reason(), v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST(LessonCommands, GamesNeedWhatTheyArePlayedWith) {
  const auto reasonOf = [](v1::GameKind kind, const std::string& parts) {
    v1::Command command = game(kind);
    return complete(command, parts).reason();
  };
  const std::string marks = kMarks, goals = kGoals;
  EXPECT_EQ(reasonOf(v1::GAME_KIND_RACE, ""), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_EQ(reasonOf(v1::GAME_KIND_RACE, "boats {} course { " + goals + "}"), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_EQ(reasonOf(v1::GAME_KIND_RACE, "boats {} course { " + marks + "}"), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(reasonOf(v1::GAME_KIND_BALL, "boats {} course { " + marks + "}"), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_EQ(reasonOf(v1::GAME_KIND_BALL, "boats {} course { " + goals + "}"), v1::REJECT_REASON_ABSENT_PART)
      << "no floaters";
  EXPECT_EQ(reasonOf(v1::GAME_KIND_BALL, "boats {} floaters {} course { " + goals + "}"),
            v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(reasonOf(static_cast<v1::GameKind>(7), "boats {}"), v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST(LessonCommands, CountsOutOfRangeAreRefused) {
  v1::Command none = game(v1::GAME_KIND_RACE);
  none.mutable_start_game()->set_laps_count(0);
  EXPECT_EQ(complete(none, "").field(), "start_game.laps_count");
  v1::Command many = game(v1::GAME_KIND_RACE);
  many.mutable_start_game()->set_goals_count(4'000'000'000U);
  EXPECT_EQ(complete(many, "").field(), "start_game.goals_count");
  v1::Command late = game(v1::GAME_KIND_RACE);
  late.mutable_start_game()->set_countdown_s(std::numeric_limits<double>::infinity());
  EXPECT_EQ(complete(late, "").field(), "start_game.countdown_s");
}

TEST(LessonCommands, AreReadAsJson) {
  const auto parsed = parseCommandJson(
      R"({"set_lesson": {"lesson": {"frozen": true, "tools": ["TOOL_BOAT", "TOOL_RAIN"], "force_ratio": 0.5}}})");
  ASSERT_TRUE(parsed) << parsed.error().message;
  const auto* command = std::get_if<v1::Command>(&*parsed);
  ASSERT_NE(command, nullptr);
  EXPECT_EQ(command->set_lesson().lesson().tools_size(), 2);
  EXPECT_TRUE(parseCommandJson(R"({"startGame": {"kind": "GAME_KIND_BALL", "goalsCount": 3}})"));
}

}  // namespace
}  // namespace spindrift::wire
