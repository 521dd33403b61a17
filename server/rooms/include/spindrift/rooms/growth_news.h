// Rate limit for reports of a growing counter.
#pragma once

#include <chrono>
#include <cstdint>

namespace spindrift::rooms {

/// Reports growth at most once per interval; the next report includes all growth in between.
class GrowthNews {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit GrowthNews(std::chrono::steady_clock::duration interval) : interval_(interval) {}

  /// Returns whether to report `count` now; if so, it counts as reported.
  [[nodiscard]] bool tell(std::uint64_t count, TimePoint now) {
    if (count == told_count_ || now < next_) return false;
    told_count_ = count;
    next_ = now + interval_;
    return true;
  }
  /// Sets a new starting value of the counter.
  void restart(std::uint64_t count) { told_count_ = count; }

 private:
  std::chrono::steady_clock::duration interval_;
  std::uint64_t told_count_ = 0;
  TimePoint next_{};
};

}  // namespace spindrift::rooms
