// Demand for the next frame of a layer, per level, by the sessions that watch it.
#pragma once

#include <array>
#include <cstddef>

#include <spindrift/core/level.h>

namespace spindrift::core {

struct LevelDemand {
  std::size_t watcher_count = 0;
  /// At least one session can take the next frame only as a keyframe: it is new, lost a frame, or skips frames.
  bool wants_keyframe = false;
  bool has_newcomer = false;  ///< at least one session has had no frame of the layer yet
};
/// Indexed by Level.
using StreamDemand = std::array<LevelDemand, kLevelCount>;

/// Returns the demand for the data of each level by a frame that only the levels in `due` take. `asked`: by the level
/// that sessions ask for, which has the data of kFull where it does not downsample the layer (`reduced_count`).
constexpr StreamDemand demandOfFrame(const StreamDemand& asked, std::uint32_t reduced_count,
                                     LevelSet due = LevelSet::all()) {
  StreamDemand out{};
  for (const Level level : kLevels) {
    if (!due.contains(level)) continue;
    const LevelDemand& one = asked[indexOf(level)];
    LevelDemand& of_data = out[indexOf(effectiveLevel(level, reduced_count))];
    of_data.watcher_count += one.watcher_count;
    of_data.wants_keyframe = of_data.wants_keyframe || one.wants_keyframe;
    of_data.has_newcomer = of_data.has_newcomer || one.has_newcomer;
  }
  return out;
}

}  // namespace spindrift::core
