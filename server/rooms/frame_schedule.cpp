#include <algorithm>

#include <spindrift/rooms/frame_schedule.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using std::chrono::duration;

constexpr auto kIdleInterval = 250ms;
/// From this interval on, frames follow the wall's time.
constexpr auto kSlowInterval = 200ms;
/// Allows for rounding of sums of tick lengths.
constexpr double kTolerance_s = 1e-9;

}  // namespace

std::optional<core::LevelSet> FrameSchedule::afterTick(const Tick& tick) {
  const duration<double> interval(1.0 / tick.frame_rate_hz);
  const bool is_late = tick.end - last_frame_ >= std::max<duration<double>>(interval, kSlowInterval);
  if (next_s_ && tick.time_s + kTolerance_s < *next_s_ && !is_late) return std::nullopt;
  next_s_ = std::max(next_s_.value_or(tick.time_s) + interval.count() * tick.speed, tick.time_s);
  last_frame_ = tick.end;
  next_idle_ = tick.end + kIdleInterval;
  core::LevelSet out;
  for (const core::Level level : core::kLevels) {
    std::optional<TimePoint>& last = last_taken_[core::indexOf(level)];
    if (last && !core::takesFrameAfter(level, duration<double>(tick.scheduled - *last).count())) continue;
    last = tick.scheduled;
    out.insert(level);
  }
  return out;
}

void FrameSchedule::idleFrame(TimePoint now) {
  next_idle_ = now + kIdleInterval;
  last_frame_ = now;
  last_taken_.fill(now);
}

}  // namespace spindrift::rooms
