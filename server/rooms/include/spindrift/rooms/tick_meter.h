// How long the ticks of a room take, for metrics and diagnostics.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/rooms/tick_times.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::rooms {

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
  const Means& takeMeans(sim::WaterSim& water);
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
