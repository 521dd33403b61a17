// How long a tick takes on this device, and would take after a change.
#pragma once

#include <spindrift/core/scene.h>
#include <spindrift/sim/derive.h>

namespace spindrift::rooms {

/// The most that one change may make a tick take while others are connected [ms]: rooms share a thread, and everybody
/// in them waits.
inline constexpr double kTickMax_ms = 60.0;

/// The same for a scene, judged by ticks that ran beside everything else while it was built.
inline constexpr double kSceneTickMax_ms = 250.0;

/// Work of a tick, as far as its cost grows with it.
struct TickWork {
  double particle_step_count = 0.0;  ///< particles times substeps times passes of the pressure solver
  double wave_step_count = 0.0;      ///< cells times wave steps
};
[[nodiscard]] TickWork workOf(const core::Scene& scene, const sim::Derived& derived);

/// A running mean of what ticks took.
class TickCost {
 public:
  /// A tick took so long.
  void note(double tick_ms);
  /// The water is other water, of which ticks took so long while it was built.
  void restart(double tick_ms) { tick_ms_ = tick_ms; }
  /// An upper estimate for a tick of the work `wanted`, of ticks that have the work `now` [ms].
  [[nodiscard]] double predict_ms(const TickWork& now, const TickWork& wanted) const;

 private:
  double tick_ms_ = 0.0;
};

}  // namespace spindrift::rooms
