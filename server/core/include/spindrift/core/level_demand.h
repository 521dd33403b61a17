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
using StreamDemand = std::array<LevelDemand, kLevelCount>;

}  // namespace spindrift::core
