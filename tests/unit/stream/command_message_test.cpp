// Commands on their way back to the wire, and as Protobuf JSON.
#include <gmock/gmock.h>

#include <spindrift/stream/api_message.h>
#include <spindrift/stream/client_message.h>

namespace spindrift::stream {
namespace {

using testing::HasSubstr;

/// One of each kind, no field at its default.
std::vector<core::Action> everyAction() {
  return {core::Splash{0.5, -0.5, 1.25, 0.25, 0.125},
          core::BreakingWave{core::Side::kDirection, 0.5, 2.0, 0.25, core::WaveShape::kSwell, 45.0},
          core::BreakingWave{core::Side::kMinusZ, 0.5, 2.0, 0.25, core::WaveShape::kBreaking, 0.0},
          core::SetParameter{"wave.depth_m", 1.5},
          core::Reset{},
          core::SetPaused{true},
          core::SetSpeed{2.0},
          core::SpawnBoat{{1.0, 2.0, 90.0, 3.0, 1.0, 0.5, 0.5, 4.0, 0.5, -0.5}},
          core::ControlBoat{3, 0.5, -0.5},
          core::RemoveBoat{3},
          core::Step{7},
          core::ChangeScene{"pond"},
          core::TakeBoat{3}};
}

TEST(CommandMessage, EveryCommandComesBackAsItWas) {
  for (const core::Action& action : everyAction()) {
    const v1::Command wire = toWire(core::Command{{}, 9, action});
    const auto checked = checkCommand(wire);
    const auto* command = std::get_if<core::Command>(&checked);
    ASSERT_NE(command, nullptr) << wire.DebugString();
    EXPECT_EQ(command->command_id, 9u);
    EXPECT_EQ(command->action.index(), action.index());
    EXPECT_EQ(toWire(*command).SerializeAsString(), wire.SerializeAsString()) << wire.DebugString();
  }
  EXPECT_EQ(std::variant_size_v<core::Action>, 12u) << "a new action wants a line in everyAction()";
}

TEST(CommandMessage, JsonOfEveryCommandIsReadBack) {
  for (const core::Action& action : everyAction()) {
    const v1::Command wire = toWire(core::Command{{}, 9, action});
    const auto parsed = parseCommandJson(toJson(wire));
    const auto* command = std::get_if<core::Command>(&parsed);
    ASSERT_NE(command, nullptr) << toJson(wire);
    EXPECT_EQ(toWire(*command).SerializeAsString(), wire.SerializeAsString());
  }
}

TEST(CommandMessage, JsonThatIsNoCommandIsNamed) {
  for (const std::string& text :
       {std::string(""), std::string("nonsense"), std::string("[1]"), std::string("{\"x\": 1}"),
        std::string(100'000, '['), std::string("{\"splash\": {\"x_m\": \xff}}"),
        std::string("{\"splash\": {}, \"reset\": {}}")}) {
    const auto parsed = parseCommandJson(text);
    ASSERT_TRUE(std::holds_alternative<Malformed>(parsed)) << text.substr(0, 40);
    EXPECT_THAT(std::get<Malformed>(parsed).message, HasSubstr("Command"));
    EXPECT_LT(std::get<Malformed>(parsed).message.size(), 400u);
  }
  EXPECT_TRUE(std::holds_alternative<CommandRejection>(parseCommandJson("{}")));
}

TEST(CommandMessage, WhatTakesWhichRole) {
  using core::Role;
  EXPECT_EQ(core::roleFor(core::Splash{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::ControlBoat{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::TakeBoat{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::Reset{}), Role::kOperator);
  EXPECT_EQ(core::roleFor(core::SetParameter{}), Role::kOperator);
  EXPECT_EQ(core::roleFor(core::ChangeScene{}), Role::kOperator);
}

TEST(ApiMessage, JsonHasTheNamesOfTheProtoFilesAndEveryField) {
  v1::RoomInfo info;
  info.set_name("pond");
  info.set_tick(12);
  const std::string json = toJson(info);
  EXPECT_THAT(json, HasSubstr("\"name\":\"pond\""));
  EXPECT_THAT(json, HasSubstr("\"tick\":\"12\""));
  EXPECT_THAT(json, HasSubstr("\"real_time_factor\":0"));
}

}  // namespace
}  // namespace spindrift::stream
