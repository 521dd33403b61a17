#include <algorithm>

#include <spindrift/rooms/real_time_clock.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
constexpr auto kWindow = 1s;
/// A longer lag is dropped: catching up for longer would make the water visibly rush.
constexpr auto kMaxDebt = 100ms;

}  // namespace

void RealTimeClock::restart(TimePoint now) {
  due_ = now;
  start_ = now;
  ticks_.clear();
}

void RealTimeClock::ticked(TimePoint now) {
  due_ +=
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(tick_s_ / speed_));
  due_ = std::max(due_, now - kMaxDebt);
  ticks_.push_back(now);
  while (now - ticks_.front() > kWindow) ticks_.pop_front();
}

double RealTimeClock::realTimeFactor() const {
  if (ticks_.size() < 2) return 0.0;
  const std::chrono::duration<double> span = ticks_.back() - ticks_.front();
  return span.count() > 0 ? static_cast<double>(ticks_.size() - 1) * tick_s_ / span.count() : 0.0;
}

}  // namespace spindrift::rooms
