// Opens rooms: where they were kept on disk, or from the start of a scene. Lives on the thread of the house.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/rooms/room.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::rooms {

class RoomOpener {
 public:
  using TimePoint = Room::TimePoint;

  /// The arguments outlive this.
  RoomOpener(const RoomRules& rules, water::WaterBuilder& builder, RoomOutlets& outlets)
      : rules_(rules), builder_(builder), outlets_(outlets) {}

  /// A room whose water is being built, and which then goes from its snapshot to where it was.
  struct Opening {
    RoomSetup setup;               ///< how it begins if it cannot continue from any snapshot
    history::RoomPlace place{};    ///< until the room is there
    std::uint64_t generation = 0;  ///< of the snapshot from which it continues; 0: from the start of the scene
    std::future<water::WaterBuilder::Built> water{};
    std::shared_ptr<Room> room{};                    ///< null while the water is built
    std::function<void(core::Result<void>)> done{};  ///< called by the caller of begin(): open, or the error
  };

  /// Finds the room on disk and starts to build its water. Errors: those of the files; kInvalidInput if it has no scene
  /// and nothing of it on disk can be used.
  core::Result<Opening> begin(RoomSetup setup);
  /// Works until the deadline, at least for a tick; with TimePoint::max() to the end. Returns whether the room is where
  /// it was. A room that cannot continue from a snapshot continues from the one before, and begins anew, with its
  /// scene, if it cannot continue from any. Errors: those of Room.
  core::Result<bool> restore(Opening& opening, TimePoint deadline);
  /// Call it for an opening that ends with an error, or is not continued. A state on disk stays there.
  void giveUp(Opening& opening);

  /// One line: the device and why it was chosen. Empty until the first water was built.
  [[nodiscard]] const std::string& deviceLine() const { return device_line_; }

 private:
  core::Result<void> choose(Opening& opening, std::uint64_t before);
  core::Result<bool> tryRestore(Opening& opening, TimePoint deadline);

  const RoomRules& rules_;
  water::WaterBuilder& builder_;
  RoomOutlets& outlets_;
  std::string device_line_;
};

}  // namespace spindrift::rooms
