// The uniform grid (thesis 3.6.1): counts, an exclusive prefix sum in two dispatches, and a reordering after which
// neighbours are contiguous and the order is reproducible.
#pragma once

#include <spindrift/sim_setup/derive.h>

#include "creation.h"
#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class NeighborGrid {
 public:
  NeighborGrid(Creation& create, const ParticleLayout& layout);

  /// Replaces the buffers for another layout and keeps the programs; an error changes nothing.
  void resize(Creation& create, const ParticleLayout& layout);

  /// Sorts position and velocity into sorted_position and sorted_velocity, by cell and then by their previous order (in
  /// a pool by position). Absorbed particles are dropped. Particles whose position is not finite come last and are in
  /// no cell. In a cell of more than ORDERED_MAX particles (grid_hash.glsl) the order is not reproducible.
  void build(const ParticleBuffers& particles, const Population& population);

  /// Index of the first particle of each cell, cell_count + 1 entries, and up to 3 without a meaning.
  [[nodiscard]] const gpu::TexelBuffer& cellStart() const { return cells_.start; }
  /// Two words, see grid/candidates.glsl: number of particles, summed over the substeps since creation, with more
  /// neighbour candidates than the search limit, modulo 2^32. build() binds it for the passes that count.
  [[nodiscard]] const gpu::TexelBuffer& crowded() const { return crowded_; }
  void declareState(StateBuffers& out) {
    // Counts and totals are 0 between two builds.
    for (gpu::TexelBuffer* buffer : {&crowded_, &cells_.count, &cells_.run_total})
      out.push_back({.buffer = buffer, .lasts = false});
  }

 private:
  struct Cells {
    std::uint32_t run_count = 0;  ///< runs of cells of the prefix sum
    gpu::TexelBuffer count, start, arrival, member, run_total;
  };

  Cells cells_;
  gpu::TexelBuffer crowded_;
  Pass count_, scan_totals_, scan_cells_, scatter_, reorder_;
};

}  // namespace spindrift::sim
