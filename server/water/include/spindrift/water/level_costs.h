// What the water of a room costs at each fidelity level, and how far off it is there.
#pragma once

#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/water/scene_catalog.h>
#include <spindrift/water/tick_cost.h>

namespace spindrift::water {

/// Work of a scene at a level.
struct LevelWork {
  TickWork per_tick;
  double tick_s = 0.0;
};

/// Returns the scene `now`, with its present parameters, at another level. Errors: those of SceneCatalog::load().
core::Result<v1::Scene> sceneAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level);
/// Returns the work of that scene. Errors: those of sceneAt() and sim::derive().
core::Result<LevelWork> workAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level);

/// The levels that a listed scene can take, with their work; none for other scenes. Immutable.
class LevelCosts {
 public:
  LevelCosts() = default;
  /// Reads and derives the scene at every level, which takes too long for the simulation thread.
  LevelCosts(const SceneCatalog& scenes, const v1::Scene& now);

  /// Returns the levels with the time that each takes, where the scene's ticks take what `cost` has measured.
  [[nodiscard]] v1::FidelityLevels predict(const TickCost& cost) const;

 private:
  v1::Fidelity present_ = v1::FIDELITY_UNSPECIFIED;
  v1::FidelityLevels levels_;     ///< without times
  std::vector<LevelWork> works_;  ///< of each of levels_
};

}  // namespace spindrift::water
