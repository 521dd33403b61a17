#include <utility>

#include <spindrift/codec/stream.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/server_message.h>

namespace spindrift::wire {
namespace {

core::SharedBytes serialize(const v1::ServerMessage& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return core::share(std::move(bytes));
}

}  // namespace

core::SharedBytes greeting(const GreetingFacts& facts, const v1::Scene& scene) {
  v1::ServerMessage message;
  v1::Greeting& out = *message.mutable_greeting();
  out.mutable_version()->set_major(kWireMajor);
  out.mutable_version()->set_minor(kWireMinor);
  out.set_server(facts.server);
  out.set_device(facts.device);
  out.set_room(facts.room);
  out.set_session_id(facts.session_id);
  for (const v1::Layer layer : facts.layers) out.add_layers(layer);
  v1::Limits& limits = *out.mutable_limits();
  limits.set_message_max_bytes(facts.message_max_bytes);
  limits.set_commands_per_s(facts.commands_per_s);
  limits.set_command_burst_count(facts.command_burst_count);
  limits.set_messages_per_s(facts.messages_per_s);
  limits.set_message_burst_count(facts.message_burst_count);
  limits.set_hello_within_s(facts.hello_within_s);
  limits.set_frame_rate_max_hz(facts.frame_rate_max_hz);
  *out.mutable_scene() = scene::forClients(scene);
  for (v1::ParameterDescription& description : scene::describeParameters(scene)) {
    *out.add_parameters() = std::move(description);
  }
  out.set_server_time_s(facts.server_time_s);
  out.mutable_room_state()->set_paused(facts.paused);
  out.mutable_room_state()->set_speed(facts.speed);
  *out.mutable_boat_list() = facts.boats;
  for (const std::string& name : facts.scenes) out.add_scenes(name);
  if (facts.levels.levels_size() > 0) *out.mutable_fidelity_levels() = facts.levels;
  return serialize(message);
}

core::SharedBytes ack(std::uint64_t command_id, std::uint64_t applied_tick, std::uint32_t boat_id) {
  v1::ServerMessage message;
  message.mutable_ack()->set_command_id(command_id);
  message.mutable_ack()->set_applied_tick(applied_tick);
  message.mutable_ack()->set_boat_id(boat_id);
  return serialize(message);
}

core::SharedBytes reject(const CommandRejection& rejection) {
  v1::ServerMessage message;
  *message.mutable_reject() = toWire(rejection);
  return serialize(message);
}

core::SharedBytes parameterChanged(std::string_view path, double value, std::uint64_t applied_tick) {
  v1::ServerMessage message;
  v1::ParameterChanged& out = *message.mutable_parameter_changed();
  out.set_path(std::string(path));
  out.set_value(value);
  out.set_applied_tick(applied_tick);
  return serialize(message);
}

core::SharedBytes roomState(bool paused, double speed) {
  v1::ServerMessage message;
  message.mutable_room_state()->set_paused(paused);
  message.mutable_room_state()->set_speed(speed);
  return serialize(message);
}

core::SharedBytes boatList(const v1::BoatList& boats) {
  v1::ServerMessage message;
  *message.mutable_boat_list() = boats;
  return serialize(message);
}

core::SharedBytes roomEvent(v1::RoomEventKind kind, std::uint64_t tick, std::string_view text) {
  v1::ServerMessage message;
  v1::RoomEvent& out = *message.mutable_room_event();
  out.set_kind(kind);
  out.set_tick(tick);
  out.set_message(std::string(text));
  return serialize(message);
}

core::SharedBytes welcome(const v1::Welcome& welcome) {
  v1::ServerMessage message;
  *message.mutable_welcome() = welcome;
  return serialize(message);
}

core::SharedBytes strokes(const v1::Strokes& strokes) {
  v1::ServerMessage message;
  *message.mutable_strokes() = strokes;
  return serialize(message);
}

core::SharedBytes people(const v1::People& people) {
  v1::ServerMessage message;
  *message.mutable_people() = people;
  return serialize(message);
}

core::SharedBytes levelChanged(core::Level level) {
  v1::ServerMessage message;
  message.mutable_level_changed()->set_level(codec::toWire(level));
  return serialize(message);
}

core::SharedBytes draining(const v1::Draining& draining) {
  v1::ServerMessage message;
  *message.mutable_draining() = draining;
  return serialize(message);
}

core::SharedBytes pong(double client_time_s, double server_time_s) {
  v1::ServerMessage message;
  message.mutable_pong()->set_client_time_s(client_time_s);
  message.mutable_pong()->set_server_time_s(server_time_s);
  return serialize(message);
}

core::SharedBytes refusal(std::string_view text) {
  v1::ServerMessage message;
  message.mutable_refusal()->set_message(std::string(text));
  return serialize(message);
}

}  // namespace spindrift::wire
