#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/server_message.h>

#include "commands.h"

namespace spindrift::wire {
namespace {

v1::ServerMessage read(const core::SharedBytes& bytes) {
  const auto message = codec::parseServerMessage(*bytes);
  EXPECT_TRUE(message) << message.error().message;
  return message ? *message : v1::ServerMessage();
}

TEST(ServerMessages, GreetingHasAllThatAClientNeeds) {
  const auto scene = scene::parseSceneText("wave { depth_m: 2 } particles {}", "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  v1::Greeting facts;
  facts.set_server("spindrift 0.1.0");
  facts.set_device("llvmpipe");
  facts.set_room("pool");
  facts.set_session_id(17);
  facts.add_layers(v1::LAYER_SURFACE);
  facts.add_layers(v1::LAYER_PARTICLES);
  facts.mutable_limits()->set_message_max_bytes(16384);
  facts.mutable_limits()->set_commands_per_s(200);
  facts.mutable_limits()->set_frame_rate_max_hz(60);
  facts.set_server_time_s(12.5);
  facts.mutable_room_state()->set_paused(true);
  facts.mutable_room_state()->set_speed(0.5);
  facts.mutable_boat_list()->add_boats()->set_boat_id(3);
  facts.add_scenes("harbour");
  facts.add_scenes("pool");
  facts.mutable_fidelity_levels()->add_levels()->set_cost_ms_per_s(250.0);
  const v1::Greeting out = read(greeting(facts, *scene)).greeting();
  EXPECT_EQ(out.version().major(), kWireMajor);
  EXPECT_EQ(out.version().minor(), kWireMinor);
  EXPECT_EQ(out.server(), "spindrift 0.1.0");
  EXPECT_EQ(out.device(), "llvmpipe");
  EXPECT_EQ(out.room(), "pool");
  EXPECT_EQ(out.session_id(), 17u);
  ASSERT_EQ(out.layers_size(), 2);
  EXPECT_EQ(out.layers(1), v1::LAYER_PARTICLES);
  EXPECT_EQ(out.limits().message_max_bytes(), 16384u);
  EXPECT_EQ(out.limits().commands_per_s(), 200.0);
  EXPECT_EQ(out.limits().frame_rate_max_hz(), 60.0);
  EXPECT_EQ(out.scene().SerializeAsString(), scene->SerializeAsString());
  EXPECT_EQ(out.parameters_size(), static_cast<int>(scene::describeParameters(*scene).size()));
  EXPECT_EQ(out.server_time_s(), 12.5);
  EXPECT_TRUE(out.room_state().paused());
  EXPECT_EQ(out.room_state().speed(), 0.5);
  ASSERT_EQ(out.boat_list().boats_size(), 1);
  EXPECT_EQ(out.boat_list().boats(0).boat_id(), 3u);
  ASSERT_EQ(out.scenes_size(), 2);
  EXPECT_EQ(out.scenes(0), "harbour");
  ASSERT_EQ(out.fidelity_levels().levels_size(), 1);
  EXPECT_EQ(out.fidelity_levels().levels(0).cost_ms_per_s(), 250.0);
}

TEST(ServerMessages, AnswersCarryIdTickReasonAndField) {
  const v1::Ack acknowledged = read(ack(test::ackOf(7, 1234))).ack();
  EXPECT_EQ(acknowledged.command_id(), 7u);
  EXPECT_EQ(acknowledged.applied_tick(), 1234u);
  EXPECT_EQ(acknowledged.boat_id(), 0u);
  EXPECT_EQ(read(ack(test::ackOf(7, 1234, 5))).ack().boat_id(), 5u);
  EXPECT_EQ(read(ack(test::ackOf(7, 1234, 0, 6))).ack().floater_id(), 6u);
  const v1::Reject rejected =
      read(reject(rejection(v1::REJECT_REASON_OUT_OF_RANGE, "splash.x_m", "too far", 8))).reject();
  EXPECT_EQ(rejected.command_id(), 8u);
  EXPECT_EQ(rejected.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(rejected.field(), "splash.x_m");
  EXPECT_EQ(rejected.message(), "too far");
  EXPECT_EQ(read(reject(rejection(v1::REJECT_REASON_BUSY, "", "try again", 9))).reject().reason(),
            v1::REJECT_REASON_BUSY);
}

TEST(ServerMessages, StateMessagesHaveTheirValues) {
  const v1::ParameterChanged changed = read(parameterChanged("wave.depth_m", 2.5, 99)).parameter_changed();
  EXPECT_EQ(changed.path(), "wave.depth_m");
  EXPECT_EQ(changed.value(), 2.5);
  EXPECT_EQ(changed.applied_tick(), 99u);
  v1::RoomState held;
  held.set_paused(true);
  held.set_speed(2.0);
  held.set_person_id(7);
  held.add_clock_person_ids(7);
  const v1::RoomState state = read(roomState(held)).room_state();
  EXPECT_TRUE(state.paused());
  EXPECT_EQ(state.speed(), 2.0);
  EXPECT_EQ(state.person_id(), 7u);
  ASSERT_EQ(state.clock_person_ids_size(), 1);
  EXPECT_EQ(state.clock_person_ids(0), 7u);
  v1::BoatList boats;
  boats.add_boats()->set_draught_m(0.25);
  EXPECT_EQ(read(boatList(boats)).boat_list().boats(0).draught_m(), 0.25);
  const v1::RoomEvent event = read(roomEvent(v1::ROOM_EVENT_KIND_RESET, 12, "started again", 8)).room_event();
  EXPECT_EQ(event.kind(), v1::ROOM_EVENT_KIND_RESET);
  EXPECT_EQ(event.tick(), 12u);
  EXPECT_EQ(event.message(), "started again");
  EXPECT_EQ(event.person_id(), 8u);
  const v1::Pong answer = read(pong(1.5, 2.5)).pong();
  EXPECT_EQ(answer.client_time_s(), 1.5);
  EXPECT_EQ(answer.server_time_s(), 2.5);
  EXPECT_EQ(read(refusal("wrong version")).refusal().message(), "wrong version");
}

TEST(ServerMessages, MessageOfDefaultsKeepsItsKind) {
  EXPECT_TRUE(read(roomState({})).has_room_state());
  EXPECT_TRUE(read(ack({})).has_ack());
  EXPECT_TRUE(read(boatList({})).has_boat_list()) << "the last boat left";
}

}  // namespace
}  // namespace spindrift::wire
