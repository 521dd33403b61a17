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

/// What a greeting says of a room. Immutable.
struct VenueView {
  std::shared_ptr<const rooms::RoomSnapshot> room;
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
  /// Null while the room cannot be reached; Sessions::roomChanged() is called when it can.
  [[nodiscard]] virtual std::shared_ptr<const VenueView> view() const = 0;
  [[nodiscard]] virtual v1::People people() const = 0;
  /// Whether new sessions may still come in: false once the room was closed.
  [[nodiscard]] virtual bool isOpen() const = 0;

  /// Called once, from any thread, perhaps before arrive() returns. The error is one line for the client.
  using Arrived = std::function<void(core::Result<rooms::Admission>)>;
  virtual void arrive(const rooms::Arrival& arrival, Arrived arrived) = 0;
  /// The session ended. Ignored for sessions that never arrived.
  virtual void leave(core::SessionId session) = 0;
  /// Sessions joined the room in the hub, or what they watch has changed.
  virtual void watchesChanged() = 0;
  /// The outcome goes to Sessions::commandApplied() or commandRejected().
  virtual void command(const rooms::Command& command) = 0;
};

}  // namespace spindrift::service
