// Server messages of the control plane, each serialized once into a buffer that all outboxes share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/level.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {

/// Values of the greeting. The scene has its defaults filled in; parameter descriptions are derived from it, and the
/// protocol version is that of kWireMajor and kWireMinor.
struct GreetingFacts {
  std::string server;  ///< program name and version
  std::string device;  ///< the device of the simulation
  std::string room;
  std::uint64_t session_id = 0;
  std::vector<v1::Layer> layers;  ///< layers that the room can send
  std::uint32_t message_max_bytes = 0;
  double commands_per_s = 0.0;
  double command_burst_count = 0.0;
  double messages_per_s = 0.0;
  double message_burst_count = 0.0;
  double hello_within_s = 0.0;
  double frame_rate_max_hz = 0.0;
  double server_time_s = 0.0;  ///< monotonic clock
  bool paused = false;
  double speed = 1.0;
  v1::BoatList boats;               ///< on the water now
  std::vector<std::string> scenes;  ///< names that ChangeScene accepts
  v1::FidelityLevels levels;        ///< that the scene can take
};

core::SharedBytes greeting(const GreetingFacts& facts, const v1::Scene& scene);
/// Makes an Ack. `boat_id`: the new boat, for SpawnBoat.
core::SharedBytes ack(std::uint64_t command_id, std::uint64_t applied_tick, std::uint32_t boat_id = 0);
core::SharedBytes reject(const CommandRejection& rejection);
core::SharedBytes parameterChanged(std::string_view path, double value, std::uint64_t applied_tick);
core::SharedBytes roomState(bool paused, double speed);
core::SharedBytes boatList(const v1::BoatList& boats);
core::SharedBytes roomEvent(v1::RoomEventKind kind, std::uint64_t tick, std::string_view text);
core::SharedBytes welcome(const v1::Welcome& welcome);
core::SharedBytes people(const v1::People& people);
core::SharedBytes strokes(const v1::Strokes& strokes);
core::SharedBytes levelChanged(core::Level level);
core::SharedBytes draining(const v1::Draining& draining);
core::SharedBytes pong(double client_time_s, double server_time_s);
core::SharedBytes refusal(std::string_view text);

}  // namespace spindrift::wire
