// How long the ticks of a room take, for metrics and diagnostics.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::rooms {

/// Distribution of durations: counts them in buckets with fixed bounds, so that a reader takes the difference of two
/// moments.
class TickTimes {
 public:
  /// Upper bounds of the buckets [s], bound included; one more bucket has what is longer. Narrow around the intervals
  /// of 60 and 30 ticks per second.
  static constexpr std::array<double, 20> kBounds_s{0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.010,
                                                    0.012, 0.014, 0.016, 0.018, 0.020, 0.025, 0.030,
                                                    0.040, 0.060, 0.100, 0.250, 0.500, 1.000};

  void note(double tick_s) {
    std::size_t k = 0;
    while (k < kBounds_s.size() && tick_s > kBounds_s[k]) ++k;
    ++counts_[k];
    sum_s_ += tick_s;
  }

  /// Number of durations per bucket, not summed up; the last one is over all bounds.
  [[nodiscard]] const std::array<std::uint64_t, kBounds_s.size() + 1>& counts() const { return counts_; }
  [[nodiscard]] double sum_s() const { return sum_s_; }

 private:
  std::array<std::uint64_t, kBounds_s.size() + 1> counts_{};
  double sum_s_ = 0.0;
};

class TickMeter {
 public:
  void note(double step_ms) {
    times_.note(1e-3 * step_ms);
    sum_ms_ += step_ms;
    ++count_;
  }
  /// Since the room opened.
  [[nodiscard]] const TickTimes& times() const { return times_; }

  /// Means of a tick [ms] since the last call that saw one.
  struct Means {
    double step_ms = 0.0;
    std::vector<core::DiagnosticsView::PassTime> passes{};
  };
  const Means& takeMeans(sim::WaterSim& water) {
    if (count_ == 0) return last_;
    last_.step_ms = sum_ms_ / count_;
    last_.passes.clear();
    for (const gpu::PassCost& pass : water.takePassCosts()) {
      last_.passes.push_back({pass.name, pass.total_ms / count_});
    }
    sum_ms_ = 0.0;
    count_ = 0;
    return last_;
  }
  /// Other water: what was measured says nothing about it.
  void restart() {
    sum_ms_ = 0.0;
    count_ = 0;
    last_ = {};
  }

 private:
  TickTimes times_;
  double sum_ms_ = 0.0;  ///< since the last takeMeans()
  std::uint32_t count_ = 0;
  Means last_;
};

}  // namespace spindrift::rooms
