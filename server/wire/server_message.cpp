#include <utility>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/server_message.h>

namespace spindrift::wire {
namespace {

/// Returns the bytes of a message with this part.
template <typename Part>
core::SharedBytes messageWith(Part* (v1::ServerMessage::*mutablePart)(), Part part) {
  v1::ServerMessage message;
  *(message.*mutablePart)() = std::move(part);
  return codec::serialized(message);
}

}  // namespace

core::SharedBytes greeting(v1::Greeting greeting, const v1::Scene& scene) {
  greeting.mutable_version()->set_major(kWireMajor);
  greeting.mutable_version()->set_minor(kWireMinor);
  *greeting.mutable_scene() = scene::forClients(scene);
  for (v1::ParameterDescription& description : scene::describeParameters(scene)) {
    *greeting.add_parameters() = std::move(description);
  }
  return messageWith(&v1::ServerMessage::mutable_greeting, std::move(greeting));
}

core::SharedBytes ack(const v1::Ack& ack) {
  return messageWith(&v1::ServerMessage::mutable_ack, ack);
}

core::SharedBytes reject(const CommandRejection& rejection) {
  return messageWith(&v1::ServerMessage::mutable_reject, rejection);
}

core::SharedBytes parameterChanged(std::string_view path, double value, std::uint64_t applied_tick) {
  v1::ParameterChanged out;
  out.set_path(std::string(path));
  out.set_value(value);
  out.set_applied_tick(applied_tick);
  return messageWith(&v1::ServerMessage::mutable_parameter_changed, std::move(out));
}

core::SharedBytes roomState(const v1::RoomState& state) {
  return messageWith(&v1::ServerMessage::mutable_room_state, state);
}

core::SharedBytes boatList(const v1::BoatList& boats) {
  return messageWith(&v1::ServerMessage::mutable_boat_list, boats);
}

core::SharedBytes roomEvent(v1::RoomEventKind kind, std::uint64_t tick, std::string_view text,
                            std::uint32_t person_id) {
  v1::RoomEvent out;
  out.set_kind(kind);
  out.set_tick(tick);
  out.set_message(std::string(text));
  out.set_person_id(person_id);
  return messageWith(&v1::ServerMessage::mutable_room_event, std::move(out));
}

core::SharedBytes welcome(const v1::Welcome& welcome) {
  return messageWith(&v1::ServerMessage::mutable_welcome, welcome);
}

core::SharedBytes people(const v1::People& people) {
  return messageWith(&v1::ServerMessage::mutable_people, people);
}

core::SharedBytes strokes(const v1::Strokes& strokes) {
  return messageWith(&v1::ServerMessage::mutable_strokes, strokes);
}

core::SharedBytes lesson(const v1::Lesson& lesson) {
  return messageWith(&v1::ServerMessage::mutable_lesson, lesson);
}

core::SharedBytes game(const v1::Game& game) {
  return messageWith(&v1::ServerMessage::mutable_game, game);
}

core::SharedBytes queryAnswer(const v1::QueryAnswer& answer) {
  return messageWith(&v1::ServerMessage::mutable_query_answer, answer);
}

core::SharedBytes levelChanged(core::Level level) {
  v1::LevelChanged out;
  out.set_level(codec::toWire(level));
  return messageWith(&v1::ServerMessage::mutable_level_changed, std::move(out));
}

core::SharedBytes draining(const v1::Draining& draining) {
  return messageWith(&v1::ServerMessage::mutable_draining, draining);
}

core::SharedBytes pong(double client_time_s, double server_time_s) {
  v1::Pong out;
  out.set_client_time_s(client_time_s);
  out.set_server_time_s(server_time_s);
  return messageWith(&v1::ServerMessage::mutable_pong, std::move(out));
}

core::SharedBytes refusal(std::string_view text) {
  v1::Refusal out;
  out.set_message(std::string(text));
  return messageWith(&v1::ServerMessage::mutable_refusal, std::move(out));
}

}  // namespace spindrift::wire
