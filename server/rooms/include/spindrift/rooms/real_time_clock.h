// When a room's next tick is due, and how fast its time really runs.
#pragma once

#include <chrono>
#include <deque>

namespace spindrift::rooms {

/// Simulated time against wall time. When the machine cannot keep up the debt is dropped: time slows, and
/// realTimeFactor() says so.
class RealTimeClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit RealTimeClock(double tick_s) : tick_s_(tick_s) {}

  /// Wanted simulated seconds per wall second; takes effect at the next tick.
  void setSpeed(double speed) { speed_ = speed; }
  [[nodiscard]] double speed() const { return speed_; }
  /// Starts (again) at `now`, without debt.
  void restart(TimePoint now);

  [[nodiscard]] TimePoint due() const { return due_; }
  /// A tick was done, ending at `now`.
  void ticked(TimePoint now);

  /// Simulated seconds per wall second over the last second (less right after a start).
  [[nodiscard]] double realTimeFactor() const;

 private:
  double tick_s_;
  double speed_ = 1.0;
  TimePoint due_{};
  TimePoint start_{};
  std::deque<TimePoint> ticks_;  ///< ends of the ticks of the last second: bounded by the tick rate times the speed
};

}  // namespace spindrift::rooms
