// Limits how many neighbouring cells may emit particles in a tick, so that no cell gives more water than it holds.
#pragma once

#include <cstdint>

namespace spindrift::sim {

/// At most one cell in each block of block_count x block_count cells emits per tick; then all particles of a tick
/// together take at most `taken_ratio` of a particle's volume from any cell.
struct SprayBlocks {
  std::uint32_t block_count = 1;  ///< a power of two: it divides every resolution
  double taken_ratio = 1.0;
};

/// Returns the smallest blocks for which a tick takes at most half of the depth from a cell; if there are none, the
/// largest blocks (the water is then too shallow to emit at rest). `droplet_m`: a particle's volume over a cell's area.
/// `reach_count`: a droplet is spread over 4 reach_count + 1 cells per axis, with the weights of
/// shaders/coupling/splat.glsl.
SprayBlocks sprayBlocks(std::uint32_t reach_count, double droplet_m, double depth_m);

}  // namespace spindrift::sim
