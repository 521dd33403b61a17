// How long a tick takes on this device, and would take after a change.
#pragma once

#include <spindrift/sim/derive.h>

namespace spindrift::app {

/// The most that one change may make a tick take while others are connected [ms]: rooms share a thread, and everybody
/// in them waits.
inline constexpr double kTickMax_ms = 100.0;

/// Work of a tick, as far as its cost grows with it.
struct TickWork {
  double particle_step_count = 0.0;  ///< particles times substeps
  double wave_step_count = 0.0;      ///< cells times wave steps
};
[[nodiscard]] TickWork workOf(const sim::Derived& derived);

/// A running mean of what ticks took.
class TickCost {
 public:
  /// A tick took so long.
  void note(double tick_ms);
  /// The scene is another one.
  void restart() { tick_ms_ = 0.0; }
  /// An upper estimate for a tick of the work `wanted`, of ticks that have the work `now` [ms]; 0 before any tick.
  [[nodiscard]] double predict_ms(const TickWork& now, const TickWork& wanted) const;

 private:
  double tick_ms_ = 0.0;
};

}  // namespace spindrift::app
