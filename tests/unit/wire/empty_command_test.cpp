// Commands that leave everything out: they take defaults that the scene permits.
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <spindrift/core/scene.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

v1::Scene sceneOf(const std::string& text) {
  const auto scene = scene::parseSceneText(text, "small.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *scene : v1::Scene{};
}

/// What becomes of a command in a scene; the command is completed.
std::optional<CommandRejection> send(v1::Command& command, const v1::Scene& scene) {
  auto checked = checkCommand(command);
  if (const auto* rejection = std::get_if<CommandRejection>(&checked)) return *rejection;
  command = std::get<v1::Command>(std::move(checked));
  return completeCommand(command, scene);
}

TEST(EmptyCommands, ArePermittedInEveryShippedScene) {
  // Reasons that need something that only the sender can know: a path, a name.
  const std::set<v1::RejectReason> needed = {v1::REJECT_REASON_UNKNOWN_PARAMETER, v1::REJECT_REASON_UNKNOWN_SCENE};
  const google::protobuf::OneofDescriptor& actions = *v1::Command::descriptor()->FindOneofByName("action");
  int taken_count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SPINDRIFT_SOURCE_DIR "/server/scenes")) {
    if (entry.path().extension() != ".textproto") continue;
    SCOPED_TRACE(entry.path().stem().string());
    const auto scene = scene::loadSceneFile(entry.path());
    ASSERT_TRUE(scene) << scene.error().message;
    for (int i = 0; i < actions.field_count(); ++i) {
      SCOPED_TRACE(actions.field(i)->name());
      v1::Command command;
      v1::Command::GetReflection()->MutableMessage(&command, actions.field(i));
      const auto rejection = send(command, *scene);
      if (!rejection) {
        ++taken_count;
      } else if (rejection->reason() == v1::REJECT_REASON_ABSENT_PART) {
        const std::string& action = actions.field(i)->name();
        const bool has_part = action == "start_game"         ? scene->course().marks_size() > 0
                              : action == "place_gauge"      ? scene->has_wave()
                              : action == "query"            ? scene->has_wave()
                              : action == "move_boat"        ? scene->has_boats() && scene->has_wave()
                              : action.ends_with("_floater") ? scene->has_floaters()
                                                             : scene->has_boats();
        EXPECT_FALSE(has_part) << rejection->message();
      } else {
        EXPECT_TRUE(needed.contains(rejection->reason())) << rejection->field() << ": " << rejection->message();
      }
    }
  }
  EXPECT_GT(taken_count, 100);
}

TEST(EmptyCommands, TakeTheDefaultsWhereTheyFit) {
  const v1::Scene wide = sceneOf("wave { side_m: 40 depth_m: 3 } boats {}");
  v1::Command splash, wave, boat, speed, step;
  splash.mutable_splash();
  wave.mutable_breaking_wave();
  boat.mutable_spawn_boat();
  speed.mutable_set_speed();
  step.mutable_step();
  for (v1::Command* command : {&splash, &wave, &boat, &speed, &step}) EXPECT_FALSE(send(*command, wide));
  EXPECT_EQ(splash.splash().radius_m(), core::Splash{}.radius_m);
  EXPECT_EQ(splash.splash().depth_m(), core::Splash{}.depth_m);
  EXPECT_FALSE(wave.breaking_wave().has_side()) << "left to the water: its open side";
  EXPECT_EQ(wave.breaking_wave().amplitude_m(), core::BreakingWave{}.amplitude_m);
  EXPECT_EQ(boat.spawn_boat().boat().length_m(), core::Boat{}.length_m);
  EXPECT_EQ(boat.spawn_boat().boat().x_m(), 0.0);
  EXPECT_EQ(speed.set_speed().speed(), 1.0);
  EXPECT_EQ(step.step().tick_count(), 1u);
}

TEST(EmptyCommands, TakeTheNearestValuesInASmallScene) {
  const v1::Scene small = sceneOf("wave { resolution_count: 32 side_m: 2 depth_m: 0.2 } boats {}");
  v1::Command splash, wave, boat;
  splash.mutable_splash();
  wave.mutable_breaking_wave();
  boat.mutable_spawn_boat();
  for (v1::Command* command : {&splash, &wave, &boat}) {
    const auto rejection = send(*command, small);
    EXPECT_FALSE(rejection) << rejection->field() << ": " << rejection->message();
  }
  EXPECT_DOUBLE_EQ(splash.splash().radius_m(), 1.0);
  EXPECT_DOUBLE_EQ(splash.splash().depth_m(), 0.9 * 0.2);
  EXPECT_DOUBLE_EQ(wave.breaking_wave().amplitude_m(), 0.9 * 0.2);
  EXPECT_DOUBLE_EQ(wave.breaking_wave().length_m(), 2.0);
  EXPECT_DOUBLE_EQ(boat.spawn_boat().boat().length_m(), 0.5);
  EXPECT_DOUBLE_EQ(boat.spawn_boat().boat().beam_m(), 0.5) << "no wider than it is long";
  EXPECT_LT(boat.spawn_boat().boat().height_m() * boat.spawn_boat().boat().density_ratio(), 0.2);
}

TEST(EmptyCommands, KeepTheValuesThatTheSenderSet) {
  const v1::Scene small = sceneOf("wave { resolution_count: 32 side_m: 2 depth_m: 0.2 }");
  v1::Command splash;
  splash.mutable_splash()->set_depth_m(0.8);
  const auto rejection = send(splash, small);
  ASSERT_TRUE(rejection);
  EXPECT_EQ(rejection->field(), "splash.depth_m");
  v1::Command gentle;
  gentle.mutable_splash()->set_depth_m(0.05);
  EXPECT_FALSE(send(gentle, small));
  EXPECT_EQ(gentle.splash().depth_m(), 0.05);
}

TEST(EmptyCommands, PutABoatBesideARockInTheMiddle) {
  const v1::Scene scene = sceneOf("wave { side_m: 16 depth_m: 1 } boats {} obstacles { rock { radius_m: 2 } }");
  v1::Command boat;
  boat.mutable_spawn_boat();
  const auto rejection = send(boat, scene);
  EXPECT_FALSE(rejection) << rejection->message();
  EXPECT_LT(std::hypot(boat.spawn_boat().boat().x_m(), boat.spawn_boat().boat().z_m()), 5.0);
  v1::Command placed;
  placed.mutable_spawn_boat()->mutable_boat()->set_x_m(0.5);
  EXPECT_TRUE(send(placed, scene)) << "the sender chose this place";
}

}  // namespace
}  // namespace spindrift::wire
