// Decides when a room makes a frame and which levels of detail take it. The caller passes the times in; no clock is
// read.
#pragma once

#include <array>
#include <chrono>
#include <optional>

#include <spindrift/core/level.h>

namespace spindrift::rooms {

class FrameSchedule {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// A tick of a running room.
  struct Tick {
    double time_s = 0.0;    ///< simulation time at its end
    TimePoint scheduled{};  ///< when it was due: evenly spaced in a room that keeps up
    TimePoint end{};
    double speed = 1.0;          ///< simulated seconds per wall second
    double frame_rate_hz = 0.0;  ///< per wall second
  };
  /// Returns the levels that take a frame of the state after the tick; nullopt if no frame is due. Frames follow
  /// simulated time. Where the machine cannot keep up they would become as rare as slow ticks make them: then they
  /// follow the wall's, at most as often as the scene says.
  [[nodiscard]] std::optional<core::LevelSet> afterTick(const Tick& tick);

  /// Returns when a paused room makes its next frame, which all levels take: newcomers see its water.
  [[nodiscard]] TimePoint idleDue() const { return next_idle_; }
  /// Notes such a frame.
  void idleFrame(TimePoint now);
  /// The frame of a paused room found no free slot, or shows what a command asked for: makes the next one at `when`.
  void setIdleDue(TimePoint when) { next_idle_ = when; }

  /// Makes a frame after the next tick, whatever the rate was before: time began again, or the rate has changed.
  void restart() { next_s_.reset(); }

 private:
  std::optional<double> next_s_;  ///< simulation time of the next frame; nullopt: at once
  TimePoint next_idle_{};         ///< wall time, while paused
  TimePoint last_frame_{};        ///< wall time
  std::array<std::optional<TimePoint>, core::kLevelCount> last_taken_{};  ///< by level, as Tick::scheduled
};

}  // namespace spindrift::rooms
