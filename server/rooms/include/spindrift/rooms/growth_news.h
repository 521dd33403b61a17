// When a counter that grows is worth telling people about.
#pragma once

#include <chrono>
#include <cstdint>

namespace spindrift::rooms {

/// News of growth, at most one an interval; growth in between is told with the next.
class GrowthNews {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit GrowthNews(std::chrono::steady_clock::duration interval) : interval_(interval) {}

  /// Whether to tell `count` now; then it counts as told.
  [[nodiscard]] bool tell(std::uint64_t count, TimePoint now) {
    if (count == told_count_ || now < next_) return false;
    told_count_ = count;
    next_ = now + interval_;
    return true;
  }
  /// The counter begins again.
  void restart(std::uint64_t count) { told_count_ = count; }

 private:
  std::chrono::steady_clock::duration interval_;
  std::uint64_t told_count_ = 0;
  TimePoint next_{};
};

}  // namespace spindrift::rooms
