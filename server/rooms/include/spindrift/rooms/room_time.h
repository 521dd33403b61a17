// The time of a room: its pace beside the wall clock, pause, single steps, sleep, and the clock that people hold. The
// caller passes the wall time in; no clock is read.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <string>

namespace spindrift::rooms {

/// Pace, pause, single steps and sleep. Compares simulated time with wall time: when the machine cannot keep up, the
/// lag is dropped; then simulated time runs slower, and realTimeFactor() reports it.
class RoomTime {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// `tick_s`: simulated seconds per tick.
  explicit RoomTime(double tick_s) : tick_s_(tick_s) {}

  void start(TimePoint now);
  /// Other water at the same speed; awake, and paused as before. `keeps_steps`: with the steps that were still to come.
  void restart(double tick_s, bool keeps_steps, TimePoint now);
  /// Continues with what was kept. `speed`: 0 for the usual one.
  void restore(double tick_s, double speed, bool is_paused, std::uint32_t steps_to_come);

  [[nodiscard]] bool isPaused() const { return is_paused_; }
  [[nodiscard]] bool isAsleep() const { return is_asleep_; }
  /// Neither paused nor asleep, and nobody holds the clock.
  [[nodiscard]] bool runs() const { return !is_paused_ && !is_asleep_ && !is_held_; }
  /// Wanted simulated seconds per wall second.
  [[nodiscard]] double speed() const { return speed_; }
  /// realTimeFactor() of a running room as a share of speed(): 1 where the machine keeps up.
  [[nodiscard]] double pace() const { return runningFactor() / speed_; }
  /// Simulated over wall time in the last second (too low right after a start); 0 in a room that stands still.
  [[nodiscard]] double realTimeFactor() const { return runs() || is_held_ ? runningFactor() : 0.0; }
  /// The same since the start, without the time in which the room stood still.
  [[nodiscard]] double meanRealTimeFactor(TimePoint now) const;
  /// When the next tick is due of a room that runs, or whose holders have asked for one.
  [[nodiscard]] TimePoint due() const { return due_; }

  /// Ends the steps that were still to come.
  void setPaused(bool is_paused, TimePoint now);
  /// Takes effect at the next tick.
  void setSpeed(double speed) { speed_ = speed; }
  /// Ticks that the paused room has still to advance.
  [[nodiscard]] std::uint32_t stepsToCome() const { return steps_to_come_; }
  void setSteps(std::uint32_t count) { steps_to_come_ = count; }
  /// Notes that such a tick is done; returns whether it was the last one.
  bool stepped() { return --steps_to_come_ == 0; }

  /// Somebody holds the clock, or nobody any more: then the room's own clock runs again.
  void setHeld(bool is_held, TimePoint now);
  /// The holders have asked for ticks, after the room has waited for them.
  void holdFrom(TimePoint now) { due_ = std::max(due_, now); }
  /// A tick that the holders have asked for, at this speed (0: as fast as the machine can), has ended.
  void heldTicked(double speed, TimePoint end);

  /// Call it at the begin of each round of the room.
  void beginRound(TimePoint now);
  /// Lets the room sleep when nobody has `watched` it for a while, and wakes it. Returns whether it fell asleep now.
  bool watchOver(bool is_watched, TimePoint now);
  /// A tick of the running room that began at `begin` and ended at `end`.
  void ticked(TimePoint begin, TimePoint end);
  /// Warns, seldom, while the machine does not keep up with the wanted speed.
  void warnIfSlow(const std::string& room, TimePoint now);

 private:
  /// Notes the end of a tick for runningFactor().
  void noteTick(TimePoint end);
  /// The next tick is due at `now`, without lag.
  void restartPace(TimePoint now);
  [[nodiscard]] double runningFactor() const;

  double tick_s_;
  double speed_ = 1.0;
  TimePoint due_{};
  std::deque<TimePoint> ticks_;  ///< end times of the ticks of the last second; bounded by what the machine makes
  bool is_paused_ = false;
  bool is_asleep_ = false;
  bool is_held_ = false;
  std::uint32_t steps_to_come_ = 0;
  TimePoint last_watched_{};
  TimePoint last_run_{};         ///< up to which running_wall_s_ counts
  double run_s_ = 0.0;           ///< simulated seconds since the start; a reset does not subtract
  double running_wall_s_ = 0.0;  ///< wall time in which the room ran
  TimePoint slow_since_{};
  TimePoint next_slow_warning_{};
};

}  // namespace spindrift::rooms
