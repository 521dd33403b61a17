// A command on its way to a room, and the traits of its kind.
#pragma once

#include <cstdint>

#include <spindrift/core/sender.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

struct Command {
  core::Sender sender{};
  v1::Command message{};  ///< accepted by wire::checkCommand(), and from CommandDesk::admit() on completed
  /// RoomWater::sceneVersion() of the scene that the message was checked against; 0: none.
  std::uint64_t scene_version = 0;
  bool is_placed_by_room = false;  ///< a boat without a position of its own

  [[nodiscard]] std::uint64_t id() const { return message.command_id(); }
};

struct CommandTraits {
  core::Role role = core::Role::kOperator;  ///< lowest role that may send it
  bool is_heavy = false;                    ///< rebuilds or uploads water; such commands have a time budget
  bool is_shared = false;                   ///< equal commands of any senders that wait are carried out once
};

/// Traits of a command whose action is set.
[[nodiscard]] const CommandTraits& traitsOf(const v1::Command& command);
/// Returns the role that a command takes: that of its kind, of its tool, or for all floaters at once.
[[nodiscard]] core::Role roleFor(const v1::Command& command);

}  // namespace spindrift::rooms
