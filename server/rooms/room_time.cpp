#include <algorithm>

#include <spdlog/spdlog.h>

#include <spindrift/rooms/room_time.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// Of the measured pace.
constexpr auto kWindow = 1s;
/// A longer lag is dropped: catching up for longer would make the water visibly rush.
constexpr auto kMaxDebt = 100ms;
/// Time from the last client's leaving until a room whose scene sleeps without clients stops.
constexpr auto kSleepPatience = 2s;
constexpr double kSlowPace = 0.9;
constexpr auto kSlowPatience = 5s;
constexpr auto kSlowWarningInterval = 60s;

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void RoomTime::restartPace(TimePoint now) {
  due_ = now;
  ticks_.clear();
}

double RoomTime::runningFactor() const {
  if (ticks_.size() < 2) return 0.0;
  const double span_s = seconds(ticks_.back() - ticks_.front());
  return span_s > 0 ? static_cast<double>(ticks_.size() - 1) * tick_s_ / span_s : 0.0;
}

void RoomTime::start(TimePoint now) {
  restartPace(now);
  last_run_ = last_watched_ = now;
}

void RoomTime::restart(double tick_s, bool keeps_steps, TimePoint now) {
  restore(tick_s, speed_, is_paused_, keeps_steps ? steps_to_come_ : 0);
  start(now);
  is_asleep_ = false;
  slow_since_ = {};
}

void RoomTime::restore(double tick_s, double speed, bool is_paused, std::uint32_t steps_to_come) {
  tick_s_ = tick_s;
  speed_ = speed > 0 ? speed : 1.0;
  restartPace({});
  is_paused_ = is_paused;
  steps_to_come_ = steps_to_come;
}

double RoomTime::meanRealTimeFactor(TimePoint now) const {
  const double wall_s = running_wall_s_ + (runs() ? seconds(now - last_run_) : 0.0);
  return wall_s > 0 ? run_s_ / wall_s : 0.0;
}

void RoomTime::setPaused(bool is_paused, TimePoint now) {
  if (is_paused_ && !is_paused) restartPace(now);
  is_paused_ = is_paused;
  steps_to_come_ = 0;
}

void RoomTime::beginRound(TimePoint now) {
  if (runs()) running_wall_s_ += seconds(now - last_run_);
  last_run_ = now;
  while (is_held_ && !ticks_.empty() && now - ticks_.front() > kWindow) ticks_.pop_front();
}

void RoomTime::setHeld(bool is_held, TimePoint now) {
  is_held_ = is_held;
  slow_since_ = {};
  restartPace(now);
}

void RoomTime::noteTick(TimePoint end) {
  ticks_.push_back(end);
  while (end - ticks_.front() > kWindow) ticks_.pop_front();
}

void RoomTime::heldTicked(double speed, TimePoint end) {
  if (speed > 0)
    due_ += std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(tick_s_ / speed));
  due_ = speed > 0 ? std::max(due_, end - kMaxDebt) : end;
  noteTick(end);
}

bool RoomTime::watchOver(bool is_watched, TimePoint now) {
  if (is_watched) {
    last_watched_ = now;
    if (is_asleep_) restartPace(now);
    is_asleep_ = false;
    return false;
  }
  if (is_asleep_ || now - last_watched_ < kSleepPatience) return false;
  is_asleep_ = true;
  return true;
}

void RoomTime::ticked(TimePoint begin, TimePoint end) {
  run_s_ += tick_s_;
  running_wall_s_ += seconds(end - std::max(begin, last_run_));
  last_run_ = end;
  due_ += std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(tick_s_ / speed_));
  due_ = std::max(due_, end - kMaxDebt);
  noteTick(end);
}

void RoomTime::warnIfSlow(const std::string& room, TimePoint now) {
  const double factor = runningFactor();
  if (factor == 0.0 || factor >= kSlowPace * speed_) {
    slow_since_ = now;
    return;
  }
  if (slow_since_ == TimePoint{}) slow_since_ = now;
  if (now - slow_since_ < kSlowPatience || now < next_slow_warning_) return;
  next_slow_warning_ = now + kSlowWarningInterval;
  spdlog::warn(
      "room {}: time runs at {:.2f} of {:.2f} wanted: this machine cannot keep up; use a lower fidelity (serve --adapt "
      "does so by itself), fewer particles, or a lower speed",
      room, factor, speed_);
}

}  // namespace spindrift::rooms
