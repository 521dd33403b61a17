// Schedules a room's ticks and measures its real-time factor.
#pragma once

#include <chrono>
#include <deque>

namespace spindrift::rooms {

/// Compares simulated time with wall time. When the machine cannot keep up, the lag is dropped: simulated time runs
/// slower, and realTimeFactor() reports it.
class RealTimeClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit RealTimeClock(double tick_s) : tick_s_(tick_s) {}

  /// Sets the wanted simulated seconds per wall second; takes effect at the next tick.
  void setSpeed(double speed) { speed_ = speed; }
  [[nodiscard]] double speed() const { return speed_; }
  /// Starts (again) at `now`, without lag.
  void restart(TimePoint now);

  [[nodiscard]] TimePoint due() const { return due_; }
  /// Notes that a tick ended at `now`.
  void ticked(TimePoint now);

  /// Returns simulated seconds per wall second over the last second (too low right after a start).
  [[nodiscard]] double realTimeFactor() const;

 private:
  double tick_s_;
  double speed_ = 1.0;
  TimePoint due_{};
  TimePoint start_{};
  std::deque<TimePoint> ticks_;  ///< end times of the ticks of the last second; bounded by tick rate times speed
};

}  // namespace spindrift::rooms
