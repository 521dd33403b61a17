#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/foxglove/channels.h>
#include <spindrift/foxglove/live_session.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::foxglove {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string textOf(core::ByteView bytes) {
  return {bytes.begin(), bytes.end()};
}

core::ByteView viewOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// A session and what its client has got.
struct Client {
  std::unique_ptr<core::Translator> session = makeLiveSession("");
  std::vector<v1::ClientMessage> commands;  ///< that the server has got, the subscriptions included
  std::vector<std::string> got;             ///< by the client, since the last call

  Client() { take(session->open()); }

  void take(const core::Translator::Incoming& incoming) {
    for (const core::Bytes& message : incoming.messages) {
      ASSERT_TRUE(commands.emplace_back().ParseFromArray(message.data(), static_cast<int>(message.size())));
      EXPECT_FALSE(std::holds_alternative<core::Error>(wire::parseClientMessage(message)));
    }
    for (const core::SharedBytes& answer : incoming.answers) deliver(*answer);
  }
  void deliver(core::ByteView message) {
    for (const auto& sent : session->send(message)) got.push_back(textOf(*sent.bytes));
  }
  std::vector<std::string> says(std::string_view text) {
    got.clear();
    take(session->receive(viewOf(text), true));
    return got;
  }
  std::vector<std::string> calls(std::uint8_t service, std::uint8_t call, const std::string& request,
                                 const std::string& encoding = "json") {
    std::string message{2, static_cast<char>(service),         0, 0, 0, static_cast<char>(call), 0, 0,
                        0, static_cast<char>(encoding.size()), 0, 0, 0};
    got.clear();
    take(session->receive(viewOf(message + encoding + request), false));
    return got;
  }
  std::vector<std::string> gets(const v1::ServerMessage& message) {
    got.clear();
    deliver(viewOf(message.SerializeAsString()));
    return got;
  }
  std::vector<std::string> isGreeted(std::initializer_list<v1::Layer> layers) {
    v1::ServerMessage message;
    v1::Greeting& greeting = *message.mutable_greeting();
    greeting.set_room("pool");
    for (const v1::Layer layer : layers) greeting.add_layers(layer);
    v1::ParameterDescription& parameter = *greeting.add_parameters();
    parameter.set_path("wave.depth_m");
    parameter.set_value(2.5);
    return gets(message);
  }
};

constexpr std::uint32_t idOf(Topic topic) {
  return static_cast<std::uint32_t>(topic) + 1;
}

std::string subscription(std::uint32_t id, Topic topic) {
  return R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) + R"(,"channelId":)" +
         std::to_string(idOf(topic)) + "}]}";
}

v1::ServerMessage surface() {
  v1::ServerMessage out;
  v1::LayerFrame& frame = *out.mutable_frame();
  frame.set_layer(v1::LAYER_SURFACE);
  frame.set_keyframe(true);
  frame.set_time_s(2.0);
  frame.mutable_surface_fixed16()->set_resolution_count(1);
  frame.mutable_surface_fixed16()->set_side_m(1.0);
  frame.mutable_surface_fixed16()->set_quantum_m(0.001);
  frame.set_payload(std::string(2, 0));
  frame.set_crc32c(core::crc32c(core::viewOf(frame.payload())));
  return out;
}

TEST(LiveSession, SaysHelloAndWhatTheRoomHas) {
  Client client;
  ASSERT_THAT(client.commands, SizeIs(1));
  EXPECT_TRUE(client.commands[0].has_hello());
  const auto got = client.isGreeted({v1::LAYER_SURFACE});
  ASSERT_THAT(got, SizeIs(3));
  EXPECT_THAT(got[0], HasSubstr(R"("op":"serverInfo")"));
  EXPECT_THAT(got[1], AllOf(HasSubstr(R"("op":"advertise")"), HasSubstr(R"("topic":"/water/surface")")));
  EXPECT_THAT(got[1], testing::Not(HasSubstr("/water/foam")));
  EXPECT_THAT(got[2], AllOf(HasSubstr(R"("op":"advertiseServices")"), HasSubstr("radius_m")));
}

TEST(LiveSession, WatchesALayerInPlainFormWhileAChannelOfItIsSubscribed) {
  Client client;
  client.isGreeted({v1::LAYER_SURFACE});
  client.commands.clear();
  EXPECT_THAT(client.says(subscription(7, Topic::kSurface)), IsEmpty());
  ASSERT_THAT(client.commands, SizeIs(1));
  const v1::Subscribe& asked = client.commands[0].subscribe();
  EXPECT_EQ(asked.layer(), v1::LAYER_SURFACE);
  EXPECT_EQ(asked.packing(), v1::PACKING_PLAIN);
  EXPECT_EQ(asked.level(), v1::LEVEL_MEDIUM);
  EXPECT_EQ(asked.max_rate_hz(), kLiveRate_hz);
  client.says(subscription(8, Topic::kSurfaceLayer));
  ASSERT_THAT(client.commands, SizeIs(2)) << "for a frame of the new channel, even if the room stands still";
  client.says(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  EXPECT_THAT(client.commands, SizeIs(2));
  client.says(R"({"op":"unsubscribe","subscriptionIds":[8]})");
  ASSERT_THAT(client.commands, SizeIs(3));
  EXPECT_EQ(client.commands[2].subscribe().max_rate_hz(), 0.0);
}

TEST(LiveSession, DataHasItsSubscriptionAndItsTime) {
  Client client;
  client.isGreeted({v1::LAYER_SURFACE});
  EXPECT_THAT(client.gets(surface()), IsEmpty()) << "nothing was subscribed to";
  client.says(subscription(0x01020304, Topic::kSurface));
  const auto got = client.gets(surface());
  ASSERT_THAT(got, SizeIs(2));
  const std::string two_seconds("\x00\x94\x35\x77\x00\x00\x00\x00", 8);
  EXPECT_EQ(got[0], "\x02" + two_seconds);
  EXPECT_EQ(got[1].substr(0, 13), std::string("\x01\x04\x03\x02\x01", 5) + two_seconds);
  EXPECT_THAT(client.gets(surface()), SizeIs(1)) << "the time is the same";
}

TEST(LiveSession, ChannelsOfLayersThatTheNextSceneLacksEnd) {
  Client client;
  client.isGreeted({v1::LAYER_SURFACE, v1::LAYER_FOAM});
  client.says(subscription(1, Topic::kFoam));
  const auto got = client.isGreeted({v1::LAYER_SURFACE, v1::LAYER_BODIES});
  ASSERT_THAT(got, SizeIs(2));
  EXPECT_THAT(got[0], AllOf(HasSubstr(R"("op":"unadvertise")"), HasSubstr("[2,12]")));
  EXPECT_THAT(got[1], AllOf(HasSubstr(R"("op":"advertise")"), HasSubstr("/boats")));
  EXPECT_THAT(client.says(subscription(1, Topic::kFoam)), ElementsAre(HasSubstr("there is no channel 2")));
  EXPECT_THAT(client.says(subscription(1, Topic::kBoats)), IsEmpty()) << "the id is free again";
}

TEST(LiveSession, CallsAreCommandsWhoseAnswersComeBack) {
  Client client;
  client.isGreeted({});
  client.commands.clear();
  EXPECT_THAT(client.calls(1, 9, R"({"x_m":1.5,"z_m":-2})"), IsEmpty());
  ASSERT_THAT(client.commands, SizeIs(1));
  const v1::Command command = client.commands[0].command();
  EXPECT_EQ(command.splash().x_m(), 1.5);
  EXPECT_FALSE(command.splash().has_depth_m()) << "the server fills it in";
  v1::ServerMessage ack;
  ack.mutable_ack()->set_command_id(command.command_id());
  ack.mutable_ack()->set_applied_tick(77);
  EXPECT_THAT(client.gets(ack),
              ElementsAre(std::string("\x03\x01\0\0\0\x09\0\0\0\x04\0\0\0json", 17) + R"({"applied_tick":77})"));
  EXPECT_THAT(client.gets(ack), IsEmpty()) << "it was answered";

  client.calls(2, 10, "");
  ASSERT_TRUE(client.commands.back().command().has_reset());
  v1::ServerMessage reject;
  reject.mutable_reject()->set_command_id(client.commands.back().command().command_id());
  reject.mutable_reject()->set_message("viewers only watch");
  EXPECT_THAT(client.gets(reject), ElementsAre(AllOf(HasSubstr("serviceCallFailure"), HasSubstr("viewers only watch")),
                                               AllOf(HasSubstr(R"("op":"status")"), HasSubstr("viewers only watch"))));
}

TEST(LiveSession, RefusesCallsThatMakeNoSenseWithTheirIds) {
  Client client;
  client.isGreeted({});
  client.commands.clear();
  const auto refused = [](const std::string& why) {
    return ElementsAre(AllOf(HasSubstr("serviceCallFailure"), HasSubstr(R"("callId":5)"), HasSubstr(why)));
  };
  EXPECT_THAT(client.calls(3, 5, "{}"), refused("there is no service 3"));
  EXPECT_THAT(client.calls(1, 5, "{}", "cdr"), refused("encoding 'cdr' is not supported"));
  EXPECT_THAT(client.calls(1, 5, "{"), refused("not a JSON object"));
  EXPECT_THAT(client.calls(1, 5, R"({}},"reset":{)"), refused("not a JSON object"));
  EXPECT_THAT(client.calls(1, 5, R"({"radius_m":1e9})"), refused("splash.radius_m"));
  EXPECT_THAT(client.commands, IsEmpty());
  for (std::size_t i = 0; i < kLiveCommandMaxCount; ++i) EXPECT_THAT(client.calls(1, 1, "{}"), IsEmpty());
  EXPECT_THAT(client.calls(1, 5, "{}"), refused("64 commands are under way"));
}

TEST(LiveSession, ParametersAreAnsweredOnceAllOfThemAreSet) {
  Client client;
  client.isGreeted({});
  client.commands.clear();
  EXPECT_THAT(client.says(R"({"op":"getParameters","parameterNames":[],"id":"a"})"),
              ElementsAre(AllOf(HasSubstr("wave.depth_m"), HasSubstr("2.5E0"), HasSubstr(R"("id":"a")"))));
  client.says(R"({"op":"subscribeParameterUpdates","parameterNames":["wave.depth_m","other"]})");
  EXPECT_THAT(client.says(R"({"op":"setParameters","id":"b","parameters":[{"name":"wave.depth_m","value":3},
                              {"name":"other","value":1}]})"),
              IsEmpty());
  ASSERT_THAT(client.commands, SizeIs(2));
  v1::ServerMessage changed, ack, reject;
  changed.mutable_parameter_changed()->set_path("wave.depth_m");
  changed.mutable_parameter_changed()->set_value(3.0);
  EXPECT_THAT(client.gets(changed), ElementsAre(HasSubstr(R"("value":3E0)")));
  ack.mutable_ack()->set_command_id(client.commands[0].command().command_id());
  EXPECT_THAT(client.gets(ack), IsEmpty());
  reject.mutable_reject()->set_command_id(client.commands[1].command().command_id());
  reject.mutable_reject()->set_message("unknown");
  EXPECT_THAT(client.gets(reject), ElementsAre(HasSubstr("unknown"), HasSubstr(R"("id":"b")")));
}

TEST(LiveSession, TimeDoesNotGoBackButForAReset) {
  Client client;
  client.isGreeted({v1::LAYER_SURFACE});
  client.says(subscription(1, Topic::kSurface));
  EXPECT_THAT(client.gets(surface()), SizeIs(2));
  v1::ServerMessage earlier = surface();
  earlier.mutable_frame()->set_time_s(1.0);
  EXPECT_THAT(client.gets(earlier), SizeIs(1)) << "a frame that another layer has overtaken";
  v1::ServerMessage reset;
  reset.mutable_room_event()->set_kind(v1::ROOM_EVENT_KIND_RESET);
  client.gets(reset);
  EXPECT_THAT(client.gets(earlier), SizeIs(2));
}

TEST(LiveSession, BrokenMessagesDoNoHarm) {
  std::mt19937 random(1);
  const std::vector<std::string> texts{
      subscription(1, Topic::kSurface),
      R"({"op":"unsubscribe","subscriptionIds":[1,2]})",
      R"({"op":"setParameters","id":"b","parameters":[{"name":"wave.depth_m","value":3}]})",
      R"({"op":"getParameters","parameterNames":["wave.depth_m"],"id":"a"})",
      std::string("\x02\x01\0\0\0\x09\0\0\0\x04\0\0\0json{\"x_m\":1}", 26),
      surface().SerializeAsString()};
  Client client;
  client.isGreeted({v1::LAYER_SURFACE});
  for (int i = 0; i < 20'000; ++i) {
    std::string message = texts[random() % texts.size()];
    for (std::size_t k = random() % 4; k > 0 && !message.empty(); --k) {
      const std::size_t at = random() % message.size();
      if (random() % 3 == 0)
        message.erase(at, random() % 8);
      else
        message[at] = static_cast<char>(random());
    }
    const auto incoming = client.session->receive(viewOf(message), random() % 2 == 0);
    EXPECT_LE(incoming.answers.size(), 2u) << "a status and what was asked for";
    EXPECT_LE(incoming.messages.size(), 1u);
    for (const core::SharedBytes& answer : incoming.answers) EXPECT_THAT(client.session->send(*answer), SizeIs(1));
    for (const core::Bytes& said : incoming.messages)
      EXPECT_FALSE(std::holds_alternative<core::Error>(wire::parseClientMessage(said)));
    EXPECT_LE(client.session->send(viewOf(message)).size(), 3u);
  }
}

}  // namespace
}  // namespace spindrift::foxglove
