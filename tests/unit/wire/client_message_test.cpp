#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/core/text.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/wire/client_message.h>

#include "commands.h"
#include "parse_command.h"

namespace spindrift::wire {
namespace {

using core::viewOf;
using test::at;
using test::breakingWave;
using test::reset;
using test::setParameter;
using test::setPaused;
using test::setSpeed;
using test::splash;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

CommandRejection expectRejection(const ClientMessage& message) {
  if (const auto* rejection = std::get_if<CommandRejection>(&message)) return *rejection;
  ADD_FAILURE() << "not rejected, but alternative " << message.index();
  return {};
}

std::string expectMalformed(const ClientMessage& message) {
  if (const auto* malformed = std::get_if<core::Error>(&message)) return malformed->message;
  ADD_FAILURE() << "not malformed, but alternative " << message.index();
  return {};
}

TEST(ClientMessages, HelloKeepsVersionAndName) {
  v1::ClientMessage message;
  message.mutable_hello()->mutable_version()->set_major(1);
  message.mutable_hello()->mutable_version()->set_minor(7);
  message.mutable_hello()->set_client("page 0.1");
  const auto hello = std::get<v1::Hello>(parse(message));
  EXPECT_EQ(hello.version().major(), 1u);
  EXPECT_EQ(hello.version().minor(), 7u);
  EXPECT_EQ(hello.client(), "page 0.1");
  EXPECT_FALSE(checkVersion(hello.version()));
}

TEST(ClientMessages, TooLongResumeKeyIsDropped) {
  v1::ClientMessage message;
  std::string key;
  while (key.size() < kResumeKeyMaxBytes) key += "\xE2\x82\xAC";  // ends in the middle of a character at the limit
  message.mutable_hello()->set_resume_key(key);
  EXPECT_EQ(std::get<v1::Hello>(parse(message)).resume_key(), "")
      << "half a character would break messages of a cluster";
  key.resize(255);
  message.mutable_hello()->set_resume_key(key);
  EXPECT_EQ(std::get<v1::Hello>(parse(message)).resume_key(), key);
}

TEST(ClientMessages, HelloOfAnotherMajorVersionIsRefused) {
  v1::Version later;
  later.set_major(2);
  later.set_minor(3);
  const auto refusal = checkVersion(later);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, HasSubstr("wire version 2.3"));
  EXPECT_THAT(*refusal, HasSubstr("this server 1." + std::to_string(kWireMinor)));
  EXPECT_TRUE(checkVersion({})) << "a hello without a version";
}

TEST(ClientMessages, OldClientIsRefusedInARectangle) {
  const auto flume = scene::parseSceneText("wave { resolution_count: 400 side_m: 40 width_m: 1 }", "flume.textproto");
  ASSERT_TRUE(flume) << flume.error().message;
  const auto refusal = checkWater(0, *flume);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, HasSubstr("40 x 1 m"));
  EXPECT_THAT(*refusal, HasSubstr("update the client to 1.1"));
  EXPECT_FALSE(checkWater(1, *flume));
  const auto square = scene::parseSceneText("wave { resolution_count: 37 }", "pond.textproto");
  EXPECT_FALSE(checkWater(0, *square)) << "any number of cells";
  const auto box = scene::parseSceneText("particles { box_width_m: 2 }", "box.textproto");
  EXPECT_FALSE(checkWater(0, *box)) << "no planes";
}

TEST(Text, NamesLoseCharactersThatReverseOrHideText) {
  const auto clean = [](const std::string& text) { return core::cleanName(text, kPersonNameMaxBytes); };
  // Right-to-left override, isolates, marks, Arabic letter mark, zero width space, line separator, byte order mark.
  // NOLINTNEXTLINE(misc-misleading-bidirectional): what is tested
  for (const char* hidden : {"\u202E", "\u202A", "\u2066", "\u2069", "\u200E", "\u200F", "\u061C", "\u200B", "\u2028",
                             "\u2029", "\uFEFF", "\u2060", "\u0085", "\x1b", "\x7f"}) {
    EXPECT_EQ(clean(std::string("A") + hidden + "da"), "Ada") << hidden;
  }
  for (const char* blank : {"", " ", "   \t ", "\u00A0\u2003\u3000", "\u2800", "\u3164", "\u200D\u200C", "\u00AD",
                            "\uFE0F", "\u202E \u202C"}) {
    EXPECT_EQ(clean(blank), "") << blank;
  }
  EXPECT_EQ(clean("  Ada  Lovelace \u3000"), "Ada  Lovelace");
  EXPECT_EQ(clean(std::string(40, ' ') + "Ada" + std::string(40, ' ') + "x"), "Ada") << "cut, then no space at the end";
  for (const char* kept :
       {"\u2764\uFE0F", "\u0645\u06CC\u200C\u062E", "\U0001F469\u200D\U0001F680", "\u00C9va", "\u05D0\u05D1"}) {
    EXPECT_EQ(clean(kept), kept);
  }
}

TEST(ClientMessages, HelloNameIsCutAtACharacterAndCleaned) {
  v1::ClientMessage message;
  message.mutable_hello()->set_client("evil\r\n\x1b[31m\x7f\xC2\x85 name");
  EXPECT_EQ(std::get<v1::Hello>(parse(message)).client(), "evil[31m name");
  // 63 bytes, then a character of three: it does not fit into 64 bytes and must not be halved.
  message.mutable_hello()->set_client(std::string(63, 'a') + "\xE2\x82\xAC");
  EXPECT_EQ(std::get<v1::Hello>(parse(message)).client(), std::string(63, 'a'));
  message.mutable_hello()->set_client(std::string(61, 'a') + "\xE2\x82\xAC" + "tail");
  EXPECT_EQ(std::get<v1::Hello>(parse(message)).client(), std::string(61, 'a') + "\xE2\x82\xAC");
}

TEST(ClientMessages, SubscribeTakesKnownLayersAndRatesInRange) {
  v1::ClientMessage message;
  message.mutable_subscribe()->set_layer(v1::LAYER_PARTICLES);
  for (const double rate_hz : {0.0, 30.0, 240.0}) {
    message.mutable_subscribe()->set_max_rate_hz(rate_hz);
    const auto subscribe = std::get<Subscribe>(parse(message));
    EXPECT_EQ(subscribe.layer, v1::LAYER_PARTICLES);
    EXPECT_EQ(subscribe.max_rate_hz, rate_hz);
  }
  for (const double rate_hz : {-1.0, 240.5, kNaN, std::numeric_limits<double>::infinity()}) {
    message.mutable_subscribe()->set_max_rate_hz(rate_hz);
    EXPECT_THAT(expectMalformed(parse(message)), HasSubstr("subscribe.max_rate_hz: "));
  }
}

TEST(ClientMessages, SubscribeToNoLayerIsMalformed) {
  v1::ClientMessage message;
  message.mutable_subscribe()->set_max_rate_hz(30);
  EXPECT_THAT(expectMalformed(parse(message)), HasSubstr("subscribe.layer: 0"));
  message.mutable_subscribe()->set_layer(static_cast<v1::Layer>(99));
  EXPECT_THAT(expectMalformed(parse(message)), HasSubstr("subscribe.layer: 99"));
}

TEST(ClientMessages, PingWithANonFiniteTimeIsMalformed) {
  v1::ClientMessage message;
  message.mutable_ping()->set_client_time_s(12.5);
  EXPECT_EQ(std::get<v1::Ping>(parse(message)).client_time_s(), 12.5);
  message.mutable_ping()->set_client_time_s(kNaN);
  EXPECT_THAT(expectMalformed(parse(message)), HasSubstr("ping.client_time_s"));
}

TEST(ClientMessages, BytesThatAreNoMessageAreMalformed) {
  EXPECT_THAT(expectMalformed(parseClientMessage({})), HasSubstr("kind"));
  EXPECT_THAT(expectMalformed(parseClientMessage(viewOf("GET / HTTP/1.1\r\n"))), HasSubstr("ClientMessage"));
  // A later client's message kind: field 15, empty.
  EXPECT_THAT(expectMalformed(parseClientMessage(viewOf(std::string("\x7a\x00", 2)))), HasSubstr("kind"));
  const std::string whole = commandMessage([](v1::Command& c) { c.mutable_splash()->set_x_m(1); }).SerializeAsString();
  EXPECT_THAT(expectMalformed(parseClientMessage(viewOf(whole.substr(0, whole.size() - 3)))),
              HasSubstr("ClientMessage"));
  EXPECT_THAT(expectMalformed(parseClientMessage(viewOf(std::string(2 * 1024 * 1024, '\0')))), HasSubstr("too big"));
}

TEST(ClientMessages, InvalidUtf8IsMalformed) {
  v1::ClientMessage message;
  message.mutable_hello()->set_client("ab");
  std::string bytes = message.SerializeAsString();
  bytes.replace(bytes.find("ab"), 2, "\xff\xfe");
  EXPECT_THAT(expectMalformed(parseClientMessage(viewOf(bytes))), HasSubstr("ClientMessage"));
}

TEST(ClientMessages, UnknownFieldsAreIgnored) {
  std::string bytes = commandMessage([](v1::Command& c) { c.mutable_reset(); }).SerializeAsString();
  bytes += std::string("\xfa\x01\x03\x61\x62\x63", 6);  // field 31, "abc"
  const ClientMessage message = parseClientMessage(viewOf(bytes));
  ASSERT_TRUE(std::holds_alternative<v1::Command>(message));
  const auto& command = std::get<v1::Command>(message);
  EXPECT_TRUE(command.has_reset());
  EXPECT_TRUE(command.GetReflection()->GetUnknownFields(command).empty()) << "they would wait in the room's queue";
}

TEST(ClientMessages, CommandsArriveWithTheirValues) {
  const v1::Splash splash = expectCommand([](v1::Command& c) {
                              v1::Splash& s = *c.mutable_splash();
                              s.set_x_m(-3);
                              s.set_z_m(0);
                              s.set_radius_m(2);
                              s.set_depth_m(0.25);
                              s.set_duration_s(0.5);
                            }).splash();
  EXPECT_EQ(splash.x_m(), -3.0);
  EXPECT_EQ(splash.z_m(), 0.0);
  EXPECT_EQ(splash.radius_m(), 2.0);
  EXPECT_EQ(splash.depth_m(), 0.25);
  EXPECT_EQ(splash.duration_s(), 0.5);

  const v1::Command wave = expectCommand([](v1::Command& c) { c.mutable_breaking_wave()->set_side(v1::SIDE_PLUS_Z); });
  EXPECT_EQ(wave.breaking_wave().side(), v1::SIDE_PLUS_Z);

  const v1::Command set = expectCommand([](v1::Command& c) {
    c.mutable_set_parameter()->set_path("wave.depth_m");
    c.mutable_set_parameter()->set_value(2.5);
  });
  EXPECT_EQ(set.set_parameter().path(), "wave.depth_m");
  EXPECT_EQ(set.set_parameter().value(), 2.5);

  EXPECT_TRUE(expectCommand([](v1::Command& c) { c.mutable_set_paused()->set_paused(true); }).set_paused().paused());
  EXPECT_EQ(expectCommand([](v1::Command& c) { c.mutable_set_speed()->set_speed(0.5); }).set_speed().speed(), 0.5);
}

TEST(ClientMessages, CommandOutOfRangeIsRejectedWithItsField) {
  const auto wide = expectRejection(parseCommand([](v1::Command& c) { c.mutable_splash()->set_radius_m(101); }));
  EXPECT_EQ(wide.command_id(), 42u);
  EXPECT_EQ(wide.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(wide.field(), "splash.radius_m");
  EXPECT_THAT(wide.message(), HasSubstr("101 m is above the maximum of 100 m"));

  const auto nan = expectRejection(parseCommand([](v1::Command& c) { c.mutable_splash()->set_x_m(kNaN); }));
  EXPECT_EQ(nan.reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(nan.field(), "splash.x_m");

  const auto side = expectRejection(
      parseCommand([](v1::Command& c) { c.mutable_breaking_wave()->set_side(static_cast<v1::Side>(9)); }));
  EXPECT_EQ(side.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(side.field(), "breaking_wave.side");

  for (const double speed : {0.0, 0.09, 4.1}) {
    const auto rejection =
        expectRejection(parseCommand([&](v1::Command& c) { c.mutable_set_speed()->set_speed(speed); }));
    EXPECT_EQ(rejection.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
    EXPECT_EQ(rejection.field(), "set_speed.speed");
    EXPECT_THAT(rejection.message(), HasSubstr("choose 0.1 to 4"));
  }
}

TEST(ClientMessages, ParameterWithoutNameOrNumberIsRejected) {
  const auto nan = expectRejection(parseCommand([](v1::Command& c) {
    c.mutable_set_parameter()->set_path("wave.depth_m");
    c.mutable_set_parameter()->set_value(kNaN);
  }));
  EXPECT_EQ(nan.reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(nan.field(), "wave.depth_m");
  EXPECT_EQ(expectRejection(parseCommand([](v1::Command& c) { c.mutable_set_parameter(); })).reason(),
            v1::REJECT_REASON_UNKNOWN_PARAMETER);
  const auto endless = expectRejection(
      parseCommand([](v1::Command& c) { c.mutable_set_parameter()->set_path(std::string(5000, 'p')); }));
  EXPECT_EQ(endless.reason(), v1::REJECT_REASON_UNKNOWN_PARAMETER);
  EXPECT_LT(endless.field().size() + endless.message().size(), 300u);
}

TEST(ClientMessages, AnUnknownCommandIsRejectedWithItsId) {
  const auto rejection = expectRejection(parseCommand([](v1::Command&) {}));
  EXPECT_EQ(rejection.command_id(), 42u);
  EXPECT_EQ(rejection.reason(), v1::REJECT_REASON_MALFORMED);
}

v1::Scene smallPool() {
  const auto scene = scene::parseSceneText("wave { side_m: 4 depth_m: 1 }", "pool.textproto");
  EXPECT_TRUE(scene);
  return *scene;
}

struct SceneLimit {
  const char* name;
  v1::Command command;
  const char* field;
  v1::RejectReason reason;
};

class ForbiddenByTheScene : public testing::TestWithParam<SceneLimit> {};

TEST_P(ForbiddenByTheScene, IsRejectedWithItsField) {
  const auto rejection = checkAgainstScene(test::numbered(6, GetParam().command), smallPool());
  ASSERT_TRUE(rejection);
  EXPECT_EQ(rejection->command_id(), 6u);
  EXPECT_EQ(rejection->field(), GetParam().field);
  EXPECT_EQ(rejection->reason(), GetParam().reason);
  EXPECT_FALSE(rejection->message().empty());
}

const SceneLimit kSceneLimits[] = {
    {"Deep", at(0, 0, splash(0.91, 1)), "splash.depth_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"OutsideX", at(-2.1, 0, splash(0.5, 1)), "splash.x_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"OutsideZ", at(0, 2.1, splash(0.5, 1)), "splash.z_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"Wide", at(0, 0, splash(0.5, 2.1)), "splash.radius_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"High", breakingWave(v1::SIDE_PLUS_X, 0.95, 1), "breaking_wave.amplitude_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"Long", breakingWave(v1::SIDE_PLUS_X, 0.5, 4.5), "breaking_wave.length_m", v1::REJECT_REASON_OUT_OF_RANGE},
    {"AbsentParameter", setParameter("foam.lifetime_s", 1), "foam.lifetime_s", v1::REJECT_REASON_ABSENT_PART},
    {"UnknownParameter", setParameter("wave.colour", 1), "wave.colour", v1::REJECT_REASON_UNKNOWN_PARAMETER},
    {"RestartParameter", setParameter("wave.side_m", 8), "wave.side_m", v1::REJECT_REASON_NEEDS_RESTART},
    {"ParameterOutOfRange", setParameter("wave.depth_m", 101), "wave.depth_m", v1::REJECT_REASON_OUT_OF_RANGE},
};

INSTANTIATE_TEST_SUITE_P(ClientMessages, ForbiddenByTheScene, testing::ValuesIn(kSceneLimits),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(ClientMessages, BoxOfParticlesLimitsEffects) {
  // 8,000 particles in 20 layers on 4 m x 2 m: a spacing of 0.141 m, 2.83 m deep.
  const auto scene =
      scene::parseSceneText("particles { count: 8000 layers_count: 20 box_side_m: 4 box_width_m: 2 }", "box.textproto");
  ASSERT_TRUE(scene);
  EXPECT_FALSE(checkAgainstScene(at(0, 0, splash(2.5, 0.9)), *scene));
  const auto deep = checkAgainstScene(at(0, 0, splash(2.6, 0.9)), *scene);
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->field(), "splash.depth_m");
  EXPECT_THAT(deep->message(), HasSubstr("2.8284"));
  const auto wide = checkAgainstScene(at(0, 0, splash(0.5, 1.1)), *scene);
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->field(), "splash.radius_m");
}

TEST(ClientMessages, CommandsThatTheSceneAllowsPass) {
  const v1::Command fine[] = {at(2, -2, splash(0.9, 2)),
                              breakingWave(v1::SIDE_MINUS_Z, 0.9, 4),
                              setParameter("wave.depth_m", 3),
                              reset(),
                              setPaused(true),
                              setSpeed(2)};
  for (const v1::Command& command : fine) {
    const auto rejection = checkAgainstScene(command, smallPool());
    EXPECT_FALSE(rejection) << command.ShortDebugString() << ": " << rejection->message();
  }
}

}  // namespace
}  // namespace spindrift::wire
