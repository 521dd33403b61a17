#include "greeting.h"

#include <vector>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/version.h>
#include <spindrift/wire/server_message.h>

namespace spindrift::service {
namespace {

std::vector<v1::Layer> layersOf(const v1::Scene& scene) {
  std::vector<v1::Layer> layers;
  if (scene.has_wave()) layers.push_back(v1::LAYER_SURFACE);
  if (scene.has_particles()) layers.push_back(v1::LAYER_PARTICLES);
  if (scene.has_boats()) layers.push_back(v1::LAYER_BODIES);
  if (scene.foam().surface()) layers.push_back(v1::LAYER_FOAM);
  if (scene.has_floaters()) layers.push_back(v1::LAYER_FLOATERS);
  layers.push_back(v1::LAYER_DIAGNOSTICS);
  return layers;
}

}  // namespace

core::SharedBytes greetingOf(const Venue& venue, const VenueView& view, net::SessionId session,
                             const SessionRules& rules) {
  const rooms::RoomSnapshot& room = *view.room;
  v1::Greeting greeting;
  greeting.set_server(std::string(core::nameAndVersion()));
  greeting.set_device(view.device);
  greeting.set_room(venue.name());
  greeting.set_session_id(session);
  for (const v1::Layer layer : layersOf(room.scene)) greeting.add_layers(layer);
  v1::Limits& limits = *greeting.mutable_limits();
  limits.set_message_max_bytes(static_cast<std::uint32_t>(rules.message_max_bytes));
  limits.set_commands_per_s(rules.commands_per_s);
  limits.set_command_burst_count(rules.command_burst_count);
  limits.set_messages_per_s(rules.messages_per_s);
  limits.set_message_burst_count(rules.message_burst_count);
  limits.set_hello_within_s(std::chrono::duration<double>(rules.hello_patience).count());
  limits.set_frame_rate_max_hz(kFrameRateMax_hz);
  greeting.set_server_time_s(core::monotonic_s() + view.clock_offset_s);
  greeting.mutable_room_state()->set_paused(room.paused);
  greeting.mutable_room_state()->set_speed(room.speed);
  for (const std::uint32_t person_id : room.clock_person_ids)
    greeting.mutable_room_state()->add_clock_person_ids(person_id);
  *greeting.mutable_boat_list() = room.boats;
  for (const std::string& scene : view.scenes) greeting.add_scenes(scene);
  if (view.levels.levels_size() > 0) *greeting.mutable_fidelity_levels() = view.levels;
  return wire::greeting(std::move(greeting), room.scene);
}

}  // namespace spindrift::service
