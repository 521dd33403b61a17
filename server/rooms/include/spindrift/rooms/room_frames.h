// The frames of a room: requests them from the water when they are due and watched, and passes finished ones on.
#pragma once

#include <cstdint>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/level.h>
#include <spindrift/rooms/room_data.h>

namespace spindrift::rooms {

class RoomFrames {
 public:
  using TimePoint = FrameSchedule::TimePoint;

  explicit RoomFrames(RoomData& room) : room_(room) {}

  /// Requests the frame after a tick of a room that makes them at this speed, if it is due.
  void afterTick(TimePoint scheduled, TimePoint end, double speed);
  /// Requests the frame of a paused room, if it is due.
  void whilePaused(TimePoint now);
  /// Passes on the frames that the device has finished.
  void handOver();
  /// Other water: what was requested before is not wanted any more.
  void restart();

  /// Returns the diagnostics layer of the present state.
  [[nodiscard]] core::DiagnosticsView diagnostics();
  /// Number of frames that were due and found no free slot in device memory.
  [[nodiscard]] std::uint64_t droppedCount() const { return dropped_count_; }

 private:
  /// Shows the referee of a game where boats and ball are.
  void showReferee(const core::FrameView& frame);
  /// Requests what is watched, also by a referee, of a frame that these levels take.
  void request(TimePoint now, core::LevelSet due);

  RoomData& room_;
  bool wants_diagnostics_ = false;
  std::uint64_t dropped_count_ = 0;
};

}  // namespace spindrift::rooms
