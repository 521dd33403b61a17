// What commands do in a room: to its water, its time, and to boats and their owners.
#pragma once

#include <cstdint>
#include <utility>

#include <spindrift/rooms/command.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/water/room_water.h>

namespace spindrift::rooms {

/// Each action writes what it does to the diary first, and is rejected if the disk refuses.
class RoomActions {
 public:
  using Outcome = water::RoomWater::Outcome;

  explicit RoomActions(RoomData& room) : room_(room) {}

  /// Applies a command that changes nothing but the water.
  Outcome applyToWater(const Command& command);
  /// A parameter has another value: updates what follows from it.
  void parameterChanged(const v1::SetParameter& change);
  /// Boats were added or removed: ends the ownership of removed boats and announces the boats.
  void boatsChanged();

  /// Stops a boat whose owner has left.
  void stopBoat(std::uint32_t boat_id);

  // One per kind of command that does more; see the table in command_desk.cpp.
  Outcome reset(const Command& command);
  Outcome setPaused(const Command& command);
  Outcome setSpeed(const Command& command);
  Outcome advance(const Command& command);
  Outcome draw(const Command& command);
  Outcome spawnBoat(const Command& command);
  Outcome controlBoat(const Command& command);
  Outcome removeBoat(const Command& command);
  Outcome takeBoat(const Command& command);
  Outcome spawnFloater(const Command& command);

  /// Returns the ids that the last command gave out, once, in an Ack without anything else.
  [[nodiscard]] v1::Ack takeNewIds() { return std::exchange(new_ids_, {}); }

 private:
  [[nodiscard]] Outcome writeAhead(const Command& command) { return room_.diary.writeAhead(command.message); }
  [[nodiscard]] bool isOnTheWater(std::uint32_t boat_id) const { return room_.water->boatIds().contains(boat_id); }

  RoomData& room_;
  v1::Ack new_ids_;
};

}  // namespace spindrift::rooms
