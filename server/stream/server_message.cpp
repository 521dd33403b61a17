#include <utility>

#include <spindrift/stream/parameters.h>
#include <spindrift/stream/server_message.h>

namespace spindrift::stream {
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
  *out.mutable_scene() = scene;
  for (v1::ParameterDescription& description : describeParameters(scene)) {
    *out.add_parameters() = std::move(description);
  }
  out.set_server_time_s(facts.server_time_s);
  out.mutable_room_state()->set_paused(facts.paused);
  out.mutable_room_state()->set_speed(facts.speed);
  *out.mutable_boat_list() = facts.boats;
  for (const std::string& name : facts.scenes) out.add_scenes(name);
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

core::SharedBytes people(const v1::People& people) {
  v1::ServerMessage message;
  *message.mutable_people() = people;
  return serialize(message);
}

core::SharedBytes levelChanged(core::Level level) {
  v1::ServerMessage message;
  message.mutable_level_changed()->set_level(toWire(level));
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

core::SharedBytes diagnostics(const core::FrameView& frame) {
  if (!frame.diagnostics) return nullptr;
  const core::DiagnosticsView& in = *frame.diagnostics;
  v1::ServerMessage message;
  v1::Diagnostics& out = *message.mutable_diagnostics();
  out.set_tick(frame.tick);
  out.set_time_s(frame.time_s);
  out.set_step_ms(in.step_ms);
  out.set_real_time_factor(in.real_time_factor);
  out.set_substeps_count(in.substeps_count);
  out.set_particle_count(in.particle_count);
  out.set_max_particle_speed_mps(in.max_particle_speed_mps);
  out.set_max_elevation_m(in.max_elevation_m);
  out.set_kinetic_energy_j(in.kinetic_energy_j);
  out.set_potential_energy_j(in.potential_energy_j);
  out.set_wave_energy_j(in.wave_energy_j);
  out.set_mean_density_ratio(in.mean_density_ratio);
  out.set_max_density_ratio(in.max_density_ratio);
  out.set_nonfinite_count(in.nonfinite_count);
  out.set_escaped_count(in.escaped_count);
  out.set_recovered_count(in.recovered_count);
  out.set_boat_count(in.boat_count);
  out.set_volume_error_units(in.volume_error_units);
  out.set_emitted_m3(in.emitted_m3);
  out.set_absorbed_m3(in.absorbed_m3);
  out.set_breaking_ratio(in.breaking_ratio);
  out.set_state_id(frame.state_id);
  for (const core::DiagnosticsView::PassTime& pass : in.passes) {
    v1::Diagnostics::PassTime& time = *out.add_passes();
    time.set_name(pass.name);
    time.set_ms(pass.ms);
  }
  return serialize(message);
}

}  // namespace spindrift::stream
