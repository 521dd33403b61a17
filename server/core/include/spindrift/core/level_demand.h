// What the sessions that watch a layer need of its next frame, level by level.
#pragma once

#include <array>
#include <cstddef>

#include <spindrift/core/level.h>

namespace spindrift::core {

struct LevelDemand {
  std::size_t watcher_count = 0;
  /// One of them could take the next frame, but only a keyframe: it just came, lost a frame, or takes only some.
  bool wants_keyframe = false;
};
using LayerDemand = std::array<LevelDemand, kLevelCount>;

}  // namespace spindrift::core
