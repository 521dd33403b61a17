// Measures the duration of a tick on this device and predicts it for a change and for every fidelity level.
#pragma once

#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/water/scene_catalog.h>

namespace spindrift::water {

/// Limit of a tick's duration after a parameter change while others are connected [ms]. Rooms share a thread, so a slow
/// tick delays all of them.
inline constexpr double kTickMax_ms = 60.0;

/// The limit for a new scene. Higher, because its ticks are measured while other rooms run.
inline constexpr double kSceneTickMax_ms = 250.0;

/// Work per tick, in quantities that its duration grows with.
struct TickWork {
  double particle_step_count = 0.0;  ///< particles times substeps times passes of the pressure solver
  double wave_step_count = 0.0;      ///< cells times wave steps
  double tick_s = 0.0;
};
[[nodiscard]] TickWork workOf(const core::Scene& scene, const sim::Derived& derived);

/// Estimates the duration of a tick: a running mean while the work stays the same, scaled with the work when it
/// changes.
class TickCost {
 public:
  /// Starts for new water with the work `now`, whose ticks took this long when it was built.
  void restart(double tick_ms, const TickWork& now);
  /// Adds the duration of a tick.
  void note(double tick_ms);
  /// The work of the next ticks. Without this, a second change before the mean has followed the first would be
  /// predicted from ticks that cost less.
  void workChanged(const TickWork& now);

  /// Duration of a tick with the present work [ms].
  [[nodiscard]] double tick_ms() const { return tick_ms_; }
  /// Returns an upper estimate for a tick with the work `wanted`, at least tick_ms() [ms].
  [[nodiscard]] double predict_ms(const TickWork& wanted) const;
  /// The same, but less than tick_ms() for less work [ms].
  [[nodiscard]] double estimate_ms(const TickWork& wanted) const;

 private:
  double tick_ms_ = 0.0;
  TickWork work_;
  /// The largest work measured so far. Less work costs no more than this, however little a scaled estimate knows about
  /// the share of a tick that does not grow with the work.
  double most_ms_ = 0.0;
  TickWork most_work_;
};

/// Returns the scene `now`, with its present parameters, at another level. Errors: those of SceneCatalog::load().
core::Result<v1::Scene> sceneAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level);
/// Returns the work of that scene. Errors: those of sceneAt() and sim::derive().
core::Result<TickWork> workAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level);

/// The levels that a listed scene can take, with their work; none for other scenes. Immutable.
class LevelCosts {
 public:
  LevelCosts() = default;
  /// Reads and derives the scene at every level, which takes too long for a room's thread.
  LevelCosts(const SceneCatalog& scenes, const v1::Scene& now);

  /// Returns the levels with the time that each takes, where the scene's ticks take what `cost` has measured.
  [[nodiscard]] v1::FidelityLevels predict(const TickCost& cost) const;

 private:
  v1::Fidelity present_ = v1::FIDELITY_UNSPECIFIED;
  v1::FidelityLevels levels_;    ///< without times
  std::vector<TickWork> works_;  ///< of each of levels_
};

}  // namespace spindrift::water
