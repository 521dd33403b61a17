// What a room tells the outside and asks it for: the one way out of a room. The service's gateway implements it and
// alone knows sessions and the wire.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <spindrift/core/command.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/level.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

class Room;

/// The levels of each layer that some session watches, in any packing.
struct WatchedLayers {
  using Levels = std::array<bool, core::kLevelCount>;  ///< by core::indexOf()
  Levels surface{};
  Levels particles{};
  Levels foam{};
  bool bodies = false;
  bool diagnostics = false;
};

/// Called on the simulation thread; must not block. What changed is told once per round, before the answers to the
/// commands that changed it.
class RoomOutlets {
 public:
  virtual ~RoomOutlets() = default;

  /// The room's scene was replaced; its snapshot is the new one already.
  virtual void sceneChanged(const Room& room) = 0;
  virtual void timeChanged(const Room& room, bool paused, double speed) = 0;
  virtual void parameterChanged(const Room& room, const std::string& path, double value) = 0;
  virtual void boatsChanged(const Room& room, const v1::BoatList& boats) = 0;
  virtual void peopleChanged(const Room& room, const v1::People& people) = 0;
  /// Somebody put the scene back to its start.
  virtual void wasReset(const Room& room) = 0;
  /// The watchdog or a new device brought the water back; `how` is one line for people.
  virtual void hasRecovered(const Room& room, const std::string& how) = 0;
  /// The room is about to be destroyed.
  virtual void closed(const Room& room) = 0;

  /// `boat_id`: of SpawnBoat, the new boat; 0 otherwise.
  virtual void commandApplied(const core::Command& command, std::uint64_t tick, std::uint32_t boat_id) = 0;
  /// The rejection has the command's number.
  virtual void commandRejected(const core::Command& command, const wire::CommandRejection& rejection) = 0;

  /// A frame with what watched() asked for. It holds a slot of the device's memory until it is dropped.
  virtual void frameReady(const Room& room, core::FrameView frame) = 0;
  /// `counts`: of the room's frames now.
  [[nodiscard]] virtual WatchedLayers watched(const Room& room, const core::ReducedCounts& counts) const = 0;
  /// Sessions in the room; in all rooms.
  [[nodiscard]] virtual std::size_t sessionCount(const Room& room) const = 0;
  [[nodiscard]] virtual std::size_t sessionCount() const = 0;
};

}  // namespace spindrift::rooms
