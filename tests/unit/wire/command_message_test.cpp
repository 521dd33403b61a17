// Commands as messages and as Protobuf JSON.
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/scene/fields.h>
#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

/// Sets every field to a value that differs from its default and is in range.
void fill(google::protobuf::Message& message) {
  using google::protobuf::FieldDescriptor;
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        fill(field.is_repeated() ? *reflection.AddMessage(&message, &field)
                                 : *reflection.MutableMessage(&message, &field));
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE: {
        const v1::ParameterOptions* options = scene::parameterOptions(field);
        const double step = options ? options->step() : 1.5;
        const double value = options ? options->default_() : 0.0;
        reflection.SetDouble(&message, &field, options && value + step > options->max() ? value - step : value + step);
        break;
      }
      case FieldDescriptor::CPPTYPE_FLOAT:
        ASSERT_TRUE(field.is_repeated()) << field.full_name();
        reflection.AddFloat(&message, &field, 1.5F);
        break;
      case FieldDescriptor::CPPTYPE_UINT32:
        reflection.SetUInt32(&message, &field, 7);
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        reflection.SetUInt64(&message, &field, ~0ull);
        break;
      case FieldDescriptor::CPPTYPE_ENUM:
        if (field.is_repeated())
          reflection.AddEnumValue(&message, &field, 2);
        else
          reflection.SetEnumValue(&message, &field, 2);
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        reflection.SetBool(&message, &field, true);
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        reflection.SetString(&message, &field, "pond");
        break;
      default:
        FAIL() << field.full_name() << ": a field of a type that no command had before";
    }
  }
}

/// One command of each kind in wire.proto, with no field at its default.
std::vector<v1::Command> everyCommand() {
  std::vector<v1::Command> out;
  const google::protobuf::OneofDescriptor& actions = *v1::Command::descriptor()->FindOneofByName("action");
  for (int i = 0; i < actions.field_count(); ++i) {
    v1::Command& command = out.emplace_back();
    command.set_command_id(9);
    fill(*v1::Command::GetReflection()->MutableMessage(&command, actions.field(i)));
  }
  return out;
}

TEST(CommandMessage, EveryCommandPassesWithItsValuesUnchanged) {
  ASSERT_GE(everyCommand().size(), 12u);
  for (const v1::Command& command : everyCommand()) {
    const auto checked = checkCommand(command);
    const auto* passed = std::get_if<v1::Command>(&checked);
    ASSERT_NE(passed, nullptr) << command.DebugString();
    EXPECT_EQ(passed->SerializeAsString(), command.SerializeAsString()) << command.DebugString();
  }
}

TEST(CommandMessage, JsonOfEveryCommandIsReadBack) {
  for (const v1::Command& command : everyCommand()) {
    const auto parsed = parseCommandJson(toJson(command));
    ASSERT_TRUE(parsed) << parsed.error().message;
    const auto* passed = std::get_if<v1::Command>(&*parsed);
    ASSERT_NE(passed, nullptr) << toJson(command);
    EXPECT_EQ(passed->SerializeAsString(), command.SerializeAsString());
  }
}

TEST(CommandMessage, JsonThatIsNotACommandIsMalformed) {
  for (const std::string& text :
       {std::string(""), std::string("nonsense"), std::string("[1]"), std::string("{\"x\": 1}"),
        std::string(100'000, '['), std::string("{\"splash\": {\"x_m\": \xff}}"),
        std::string("{\"splash\": {}, \"reset\": {}}")}) {
    const auto parsed = parseCommandJson(text);
    ASSERT_FALSE(parsed) << text.substr(0, 40);
    EXPECT_THAT(parsed.error().message, HasSubstr("Command"));
    EXPECT_LT(parsed.error().message.size(), 400u);
  }
  EXPECT_TRUE(std::holds_alternative<CommandRejection>(*parseCommandJson("{}")));
}

/// The refusal of a body, without the common part; empty if it is accepted.
std::string whyNot(const std::string& json) {
  const auto parsed = parseCommandJson(json);
  if (parsed) return "";
  constexpr std::string_view kBegin = "the body is not JSON of spindrift.v1.Command: ";
  EXPECT_TRUE(parsed.error().message.starts_with(kBegin)) << parsed.error().message;
  return parsed.error().message.substr(kBegin.size());
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

TEST(ApiMessage, ErrorNamesTheLocationAndWhatIsExpected) {
  EXPECT_EQ(whyNot(""), "it is empty; send a JSON object {...}");
  EXPECT_EQ(whyNot("[]"), "line 1, column 1: a JSON object {...} is expected, not [");
  EXPECT_EQ(whyNot("{\n  'reset': {}}"), "line 2, column 3: a name in double quotes is expected, not '");
  EXPECT_EQ(whyNot(R"({"reset":{},})"), "line 1, column 13: a name in double quotes is expected, not }");
  EXPECT_EQ(whyNot(R"({"reset":)"), "line 1, column 10: a value is expected, and the text ends");
  EXPECT_EQ(whyNot(R"({"splosh":{}})"), "splosh: Command has no such field");
  EXPECT_EQ(whyNot(R"({"splash":{"X_m":1}})"), "splash.X_m: Splash has no such field");
  EXPECT_EQ(whyNot(R"({"splash":{"x_m":1,"xM":2}})"), "splash.xM: is given twice");
  EXPECT_EQ(whyNot(R"({"command_id":1,"commandId":2,"reset":{}})"), "commandId: is given twice");
  EXPECT_EQ(whyNot(R"({"reset":null,"reset":{}})"), "reset: is given twice");
  EXPECT_EQ(whyNot("\xEF\xBB\xBF{}"), "line 1, column 1: a JSON object {...} is expected, not \\u{FEFF}");
  EXPECT_EQ(whyNot(R"({"splash":{},"reset":{}})"), "reset: cannot be given together with splash");
  EXPECT_EQ(whyNot(R"({"reset":5})"), "reset: has to be an object {...}");
  EXPECT_EQ(whyNot(R"({"splash":{"x_m":[1]}})"), "splash.x_m: has to be a number");
  EXPECT_EQ(whyNot(R"({"splash":{"depth_m":"deep"}})"), "splash.depth_m: \"deep\" is not of type double");
  EXPECT_EQ(whyNot(R"({"control_boat":{"boatId":-1}})"), "control_boat.boat_id: -1 is not of type uint32");
  EXPECT_EQ(whyNot(R"({"breaking_wave":{"side":"SIDEWAYS"}})"), "breaking_wave.side: \"SIDEWAYS\" is not of type Side");
}

TEST(ApiMessage, BoundsTheDepthOfJson) {
  std::string deep = R"({"splash":)";
  deep += std::string(1'000'000, '[');
  EXPECT_EQ(whyNot(deep), "splash: has to be an object {...}");
  std::string nested;
  for (int i = 0; i < 100'000; ++i) nested += R"({"spawn_boat":)";
  EXPECT_EQ(whyNot(nested), "spawn_boat.spawn_boat: SpawnBoat has no such field");
}

TEST(ApiMessage, JsonHasEveryFieldByItsProtoName) {
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
