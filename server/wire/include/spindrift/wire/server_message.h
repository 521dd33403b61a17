// Server messages of the control plane, each serialized once into a buffer that all outboxes share.
#pragma once

#include <cstdint>
#include <string_view>

#include <spindrift/core/bytes.h>
#include <spindrift/core/level.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {

/// Completes the greeting with the protocol version, the scene as clients get it, and the descriptions of its
/// parameters. `scene` has its defaults filled in.
core::SharedBytes greeting(v1::Greeting greeting, const v1::Scene& scene);
core::SharedBytes ack(const v1::Ack& ack);
core::SharedBytes reject(const CommandRejection& rejection);
core::SharedBytes parameterChanged(std::string_view path, double value, std::uint64_t applied_tick);
/// `person_id`: who caused it; 0: nobody in the room.
core::SharedBytes roomState(const v1::RoomState& state);
core::SharedBytes boatList(const v1::BoatList& boats);
core::SharedBytes roomEvent(v1::RoomEventKind kind, std::uint64_t tick, std::string_view text,
                            std::uint32_t person_id = 0);
core::SharedBytes welcome(const v1::Welcome& welcome);
core::SharedBytes people(const v1::People& people);
core::SharedBytes strokes(const v1::Strokes& strokes);
core::SharedBytes lesson(const v1::Lesson& lesson);
core::SharedBytes queryAnswer(const v1::QueryAnswer& answer);
core::SharedBytes game(const v1::Game& game);
core::SharedBytes levelChanged(core::Level level);
core::SharedBytes draining(const v1::Draining& draining);
core::SharedBytes pong(double client_time_s, double server_time_s);
core::SharedBytes refusal(std::string_view text);

}  // namespace spindrift::wire
