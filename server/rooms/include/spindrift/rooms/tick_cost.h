// Measures the duration of a tick on this device and predicts it for a change.
#pragma once

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::rooms {

/// Limit of a tick's duration after a parameter change while others are connected [ms]. Rooms share a thread, so a slow
/// tick delays all of them.
inline constexpr double kTickMax_ms = 60.0;

/// The limit for a new scene. Higher, because its ticks are measured while other rooms run.
inline constexpr double kSceneTickMax_ms = 250.0;

/// Work per tick, in quantities that its duration grows with.
struct TickWork {
  double particle_step_count = 0.0;  ///< particles times substeps times passes of the pressure solver
  double wave_step_count = 0.0;      ///< cells times wave steps
};
[[nodiscard]] TickWork workOf(const core::Scene& scene, const sim::Derived& derived);

/// A running mean of tick durations.
class TickCost {
 public:
  /// Adds the duration of a tick.
  void note(double tick_ms);
  /// Starts again for new water, whose ticks took this long when it was built.
  void restart(double tick_ms) { tick_ms_ = tick_ms; }
  /// Returns an upper estimate for a tick with the work `wanted`, from measured ticks with the work `now` [ms].
  [[nodiscard]] double predict_ms(const TickWork& now, const TickWork& wanted) const;

 private:
  double tick_ms_ = 0.0;
};

}  // namespace spindrift::rooms
