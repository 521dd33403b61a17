// A room as its sessions see it, whether it runs in this process or in another one.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/rooms/command.h>
#include <spindrift/rooms/room.h>
#include <spindrift/rooms/roster.h>

namespace spindrift::service {

/// The part of a room that a greeting describes. Immutable.
struct VenueView {
  std::shared_ptr<const rooms::RoomSnapshot> room;
  v1::FidelityLevels levels;
  std::string device;               ///< one line: the device of the simulation
  std::vector<std::string> scenes;  ///< names that ChangeScene accepts
  v1::RoomAccess room_access;       ///< digests of tokens that were made for the room
  std::chrono::milliseconds grace{};
  double clock_offset_s = 0.0;  ///< add it to this process's monotonic clock to get that of the simulation
};

/// Thread-safe; no call blocks.
class Venue {
 public:
  virtual ~Venue() = default;

  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Returns the room's present view; null while the room cannot be reached; Sessions::roomChanged() is called when it
  /// can.
  [[nodiscard]] virtual std::shared_ptr<const VenueView> view() const = 0;
  [[nodiscard]] virtual v1::People people() const = 0;
  /// Never null; replaced by another one whenever it changes.
  [[nodiscard]] virtual std::shared_ptr<const rooms::LessonState> lesson() const = 0;
  /// Returns what the sessions of the room need of its frames; never null.
  [[nodiscard]] virtual std::shared_ptr<core::DemandTable> demand() const = 0;
  /// Returns whether new sessions may still come in: false once the room was closed.
  [[nodiscard]] virtual bool isOpen() const = 0;

  /// Called once, from any thread, perhaps before arrive() returns. The error is one line for the client.
  using Arrived = std::function<void(core::Result<rooms::Admission>)>;
  virtual void arrive(const rooms::Arrival& arrival, Arrived arrived) = 0;
  /// Removes a session that ended. Ignored for sessions that never arrived.
  virtual void leave(core::SessionId session) = 0;
  /// Sessions joined the room in the hub, or what they watch has changed.
  virtual void watchesChanged() = 0;
  /// Passes the command on; the outcome goes to Sessions::commandApplied() or commandRejected().
  virtual void command(const rooms::Command& command) = 0;
};

}  // namespace spindrift::service
