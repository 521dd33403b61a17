// Commands on boats, steps and scenes: their values, and rejections before they reach the room.
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

#include "commands.h"
#include "parse_command.h"

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

CommandRejection rejectionOf(const std::function<void(v1::Command&)>& fill) {
  const ClientMessage message = parseCommand(fill);
  if (const auto* rejection = std::get_if<CommandRejection>(&message)) return *rejection;
  ADD_FAILURE() << "not rejected";
  return {};
}

TEST(BoatCommands, ArriveWithTheirValuesAndNoOthers) {
  const v1::Boat boat = expectCommand([](v1::Command& c) {
                          c.mutable_spawn_boat()->mutable_boat()->set_x_m(-3);
                          c.mutable_spawn_boat()->mutable_boat()->set_rudder_ratio(0.5);
                        })
                            .spawn_boat()
                            .boat();
  EXPECT_EQ(boat.x_m(), -3.0);
  EXPECT_EQ(boat.rudder_ratio(), 0.5);
  EXPECT_FALSE(boat.has_length_m());

  const v1::ControlBoat control = expectCommand([](v1::Command& c) {
                                    c.mutable_control_boat()->set_boat_id(7);
                                    c.mutable_control_boat()->set_throttle_ratio(-1);
                                    c.mutable_control_boat()->set_rudder_ratio(0.25);
                                  }).control_boat();
  EXPECT_EQ(control.boat_id(), 7u);
  EXPECT_EQ(control.throttle_ratio(), -1.0);
  EXPECT_EQ(control.rudder_ratio(), 0.25);
  EXPECT_EQ(expectCommand([](v1::Command& c) { c.mutable_remove_boat()->set_boat_id(9); }).remove_boat().boat_id(), 9u);
}

TEST(BoatCommands, OutOfRangeValueIsRejectedWithItsField) {
  const auto fast = rejectionOf([](v1::Command& c) { c.mutable_control_boat()->set_throttle_ratio(1.5); });
  EXPECT_EQ(fast.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(fast.field(), "control_boat.throttle_ratio");
  EXPECT_THAT(fast.message(), HasSubstr("choose -1 to 1"));
  const auto nan = rejectionOf(
      [](v1::Command& c) { c.mutable_control_boat()->set_rudder_ratio(std::numeric_limits<double>::quiet_NaN()); });
  EXPECT_EQ(nan.reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(nan.field(), "control_boat.rudder_ratio");
  const auto wide = rejectionOf([](v1::Command& c) { c.mutable_spawn_boat()->mutable_boat()->set_beam_m(16); });
  EXPECT_EQ(wide.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(wide.field(), "spawn_boat.boat.beam_m");
}

TEST(StepCommands, TakeTheirRange) {
  EXPECT_EQ(expectCommand([](v1::Command& c) { c.mutable_step()->set_tick_count(600); }).step().tick_count(), 600u);
  for (const std::uint32_t count : {0u, 601u}) {
    const auto rejection = rejectionOf([&](v1::Command& c) { c.mutable_step()->set_tick_count(count); });
    EXPECT_EQ(rejection.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
    EXPECT_EQ(rejection.field(), "step.tick_count");
    EXPECT_THAT(rejection.message(), HasSubstr("choose 1 to 600 ticks"));
  }
}

TEST(SceneCommands, AcceptNamesButNoPaths) {
  EXPECT_EQ(
      expectCommand([](v1::Command& c) { c.mutable_change_scene()->set_name("wave_only"); }).change_scene().name(),
      "wave_only");
  for (const std::string& name : {std::string(), std::string("../etc/passwd"), std::string("a b"), std::string(65, 'a'),
                                  std::string("a\nb"), std::string(5000, 'x')}) {
    const auto rejection = rejectionOf([&](v1::Command& c) { c.mutable_change_scene()->set_name(name); });
    EXPECT_EQ(rejection.reason(), v1::REJECT_REASON_UNKNOWN_SCENE);
    EXPECT_EQ(rejection.field(), "change_scene.name");
    EXPECT_LT(rejection.message().size(), 200u);
    EXPECT_EQ(rejection.message().find('\n'), std::string::npos);
  }
}

TEST(SceneCommands, OmittedLevelIsNotALevel) {
  const auto with = [](std::optional<int> fidelity) {
    return [fidelity](v1::Command& c) {
      c.mutable_change_scene()->set_name("harbor");
      if (fidelity) c.mutable_change_scene()->set_fidelity(static_cast<v1::Fidelity>(*fidelity));
    };
  };
  EXPECT_FALSE(expectCommand(with(std::nullopt)).change_scene().has_fidelity());
  EXPECT_EQ(expectCommand(with(0)).change_scene().fidelity(), v1::FIDELITY_UNSPECIFIED);
  EXPECT_EQ(expectCommand(with(3)).change_scene().fidelity(), v1::FIDELITY_FINE);
  const auto rejection = rejectionOf(with(7));
  EXPECT_EQ(rejection.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(rejection.field(), "change_scene.fidelity");
}

v1::Scene harbour() {
  const auto scene = scene::parseSceneText(
      "wave { side_m: 16 depth_m: 1 }\nobstacles { rock { x_m: 4 } }\nboats { boats { x_m: -4 } }", "harbour");
  EXPECT_TRUE(scene) << scene.error().message;
  return *scene;
}

TEST(BoatCommands, NeedASceneWithBoats) {
  const auto scene = scene::parseSceneText("wave {}", "pool.textproto");
  ASSERT_TRUE(scene);
  const std::pair<v1::Command, std::string> cases[] = {{test::spawnBoat(0, 0), "spawn_boat"},
                                                       {test::controlBoat(1, 0, 0), "control_boat"},
                                                       {test::removeBoat(1), "remove_boat"},
                                                       {test::takeBoat(1), "take_boat"}};
  for (const auto& [command, field] : cases) {
    const auto rejection = checkAgainstScene(test::numbered(2, command), *scene);
    ASSERT_TRUE(rejection) << field;
    EXPECT_EQ(rejection->command_id(), 2u);
    EXPECT_EQ(rejection->reason(), v1::REJECT_REASON_ABSENT_PART);
    EXPECT_EQ(rejection->field(), field);
    EXPECT_FALSE(checkAgainstScene(command, harbour()));
  }
}

TEST(BoatCommands, AreRejectedWhereTheSceneForbidsABoat) {
  const auto rejectionFor = [](const std::function<void(v1::Boat&)>& change) {
    v1::Command spawn = test::spawnBoat(0, 0);
    change(*spawn.mutable_spawn_boat()->mutable_boat());
    return checkAgainstScene(spawn, harbour()).value_or(CommandRejection{});
  };
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_x_m(7.5); }).field(), "spawn_boat.boat.x_m");
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_z_m(-8.0); }).field(), "spawn_boat.boat.z_m");
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_length_m(5.0); }).field(), "spawn_boat.boat.length_m");
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_beam_m(3.0); }).field(), "spawn_boat.boat.beam_m");
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_height_m(3.0); }).field(), "spawn_boat.boat.height_m");
  const CommandRejection aground = rejectionFor([](v1::Boat& boat) { boat.set_x_m(4.0); });
  EXPECT_EQ(aground.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_THAT(aground.message(), HasSubstr("obstacles[0]"));
  EXPECT_EQ(rejectionFor([](v1::Boat& boat) { boat.set_z_m(5.0); }).reason(), v1::REJECT_REASON_UNSPECIFIED)
      << "open water";
}

TEST(SceneCommands, AndStepsAreNotCheckedAgainstTheScene) {
  for (const v1::Command& command : {test::step(5), test::changeScene("anything")})
    EXPECT_FALSE(checkAgainstScene(command, harbour()));
}

TEST(WavesInADirection, HaveTheBoundsOfWavesFromASide) {
  v1::Command fine = test::breakingWave(v1::SIDE_DIRECTION, 0.5, 3.0);
  fine.mutable_breaking_wave()->set_direction_deg(33);
  EXPECT_FALSE(checkAgainstScene(fine, harbour()));
  v1::Command high = fine;
  high.mutable_breaking_wave()->set_amplitude_m(0.95);
  EXPECT_EQ(checkAgainstScene(high, harbour())->field(), "breaking_wave.amplitude_m");
  v1::Command longer = fine;
  longer.mutable_breaking_wave()->set_length_m(17);
  EXPECT_EQ(checkAgainstScene(longer, harbour())->field(), "breaking_wave.length_m");
}

}  // namespace
}  // namespace spindrift::wire
