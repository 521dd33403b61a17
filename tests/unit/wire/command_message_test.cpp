// Conversion of commands to the wire and to Protobuf JSON.
#include <set>

#include <gmock/gmock.h>

#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

/// One command of each kind, with no field at its default.
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

TEST(CommandMessage, EveryCommandRoundTrips) {
  for (const core::Action& action : everyAction()) {
    const v1::Command wire = toWire(core::Command{{}, 9, action});
    const auto checked = checkCommand(wire);
    const auto* command = std::get_if<core::Command>(&checked);
    ASSERT_NE(command, nullptr) << wire.DebugString();
    EXPECT_EQ(command->command_id, 9u);
    EXPECT_EQ(command->action.index(), action.index());
    EXPECT_EQ(toWire(*command).SerializeAsString(), wire.SerializeAsString()) << wire.DebugString();
  }
  std::set<std::size_t> kinds;
  for (const core::Action& action : everyAction()) kinds.insert(action.index());
  EXPECT_EQ(kinds.size(), std::variant_size_v<core::Action>) << "everyAction() lacks a kind";
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

TEST(CommandMessage, JsonThatIsNotACommandIsMalformed) {
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

TEST(CommandMessage, EachCommandNeedsItsRole) {
  using core::Role;
  EXPECT_EQ(core::roleFor(core::Splash{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::ControlBoat{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::TakeBoat{}), Role::kPlayer);
  EXPECT_EQ(core::roleFor(core::Reset{}), Role::kOperator);
  EXPECT_EQ(core::roleFor(core::SetParameter{}), Role::kOperator);
  EXPECT_EQ(core::roleFor(core::ChangeScene{}), Role::kOperator);
}

/// The refusal of a body, without the common part; empty if it is accepted.
std::string whyNot(const std::string& json) {
  const auto parsed = parseCommandJson(json);
  const auto* malformed = std::get_if<Malformed>(&parsed);
  if (malformed == nullptr) return "";
  constexpr std::string_view kBegin = "the body is no JSON of spindrift.v1.Command: ";
  EXPECT_TRUE(malformed->message.starts_with(kBegin)) << malformed->message;
  return malformed->message.substr(kBegin.size());
}

TEST(ApiMessage, AcceptsTheJsonOfRfc8259) {
  for (const char* json :
       {R"({"reset":{}})", " \t\r\n{ \"reset\" : { } , \"command_id\" : 7 } \n", R"({"commandId":"7","reset":{}})",
        R"({"splash":{"x_m":-0.5e+1,"zM":1E-2,"radius_m":"0.5","depthM":null}})", R"({"splash":{"depth_m":"NaN"}})",
        R"({"set_parameter":{"path":"a\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00 \u00C4 é","value":0}})", R"({"reset":null})",
        R"({"set_paused":{"paused":true}})", R"({"breaking_wave":{"side":2,"shape":"WAVE_SHAPE_SWELL"}})"}) {
    EXPECT_EQ(whyNot(json), "") << json;
  }
}

TEST(ApiMessage, RefusesJsonThatRfc8259Forbids) {
  for (const char* json : {"",
                           " ",
                           "{'reset':{}}",
                           R"({"reset":{},})",
                           R"({,"reset":{}})",
                           R"({reset:{}})",
                           R"({"reset" {}})",
                           R"({"reset":{}}})",
                           R"({"reset":{}} x)",
                           R"({"reset":{}}{"reset":{}})",
                           R"({"reset":{})",
                           R"({"reset":})",
                           R"({"command_id":01})",
                           R"({"command_id":+1})",
                           R"({"command_id":1.})",
                           R"({"splash":{"x_m":.5}})",
                           R"({"splash":{"x_m":1e}})",
                           R"({"splash":{"x_m":-}})",
                           R"({"splash":{"x_m":NaN}})",
                           R"({"splash":{"x_m":Infinity}})",
                           R"({"splash":{"x_m":0x10}})",
                           R"({"set_paused":{"paused":True}})",
                           R"({"set_paused":{"paused":tru}})",
                           R"({"reset":{}/* why */})",
                           "{\"set_parameter\":{\"path\":\"a\nb\"}}",
                           R"({"set_parameter":{"path":"\x"}})",
                           R"({"set_parameter":{"path":"\u12g4"}})",
                           R"({"set_parameter":{"path":"\u12)",
                           "{\"set_parameter\":{\"path\":\"\xff\"}}",
                           "\xef\xbb\xbf{}",
                           R"({"set_parameter":{"path":"open)"}) {
    EXPECT_NE(whyNot(json), "") << json;
  }
}

TEST(ApiMessage, ReportsThePlaceAndWhatIsExpected) {
  EXPECT_EQ(whyNot(""), "it is empty; send a JSON object {...}");
  EXPECT_EQ(whyNot("[]"), "line 1, column 1: a JSON object {...} is expected, not [");
  EXPECT_EQ(whyNot("{\n  'reset': {}}"), "line 2, column 3: a name in double quotes is expected, not '");
  EXPECT_EQ(whyNot(R"({"reset":{},})"), "line 1, column 13: a name in double quotes is expected, not }");
  EXPECT_EQ(whyNot(R"({"reset":)"), "line 1, column 10: a value is expected, and the text ends");
  EXPECT_EQ(whyNot(R"({"splosh":{}})"), "splosh: Command has no such field");
  EXPECT_EQ(whyNot(R"({"splash":{"X_m":1}})"), "splash.X_m: Splash has no such field");
  EXPECT_EQ(whyNot(R"({"splash":{"x_m":1,"xM":2}})"), "splash.xM: is given twice");
  EXPECT_EQ(whyNot(R"({"splash":{},"reset":{}})"), "reset: cannot be given together with splash");
  EXPECT_EQ(whyNot(R"({"reset":5})"), "reset: has to be an object {...}");
  EXPECT_EQ(whyNot(R"({"splash":{"x_m":[1]}})"), "splash.x_m: has to be a number");
  EXPECT_EQ(whyNot(R"({"splash":{"depth_m":"deep"}})"), "splash.depth_m: \"deep\" is no double");
  EXPECT_EQ(whyNot(R"({"control_boat":{"boatId":-1}})"), "control_boat.boat_id: -1 is no uint32");
  EXPECT_EQ(whyNot(R"({"breaking_wave":{"side":"SIDEWAYS"}})"), "breaking_wave.side: \"SIDEWAYS\" is no Side");
}

TEST(ApiMessage, BoundsTheDepthOfJson) {
  std::string deep = R"({"splash":)";
  deep += std::string(1'000'000, '[');
  EXPECT_EQ(whyNot(deep), "splash: has to be an object {...}");
  std::string nested;
  for (int i = 0; i < 100'000; ++i) nested += R"({"spawn_boat":)";
  EXPECT_EQ(whyNot(nested), "spawn_boat.spawn_boat: SpawnBoat has no such field");
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
}  // namespace spindrift::wire
