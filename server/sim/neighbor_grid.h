// The uniform grid (thesis 3.6.1): counts, an exclusive prefix sum in three dispatches, and a reordering that makes
// neighbours contiguous and the order repeatable.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

#include "particle_buffers.h"

namespace spindrift::sim {

class NeighborGrid {
 public:
  static core::Result<std::unique_ptr<NeighborGrid>> create(gpu::Context& ctx, const ParticleLayout& layout,
                                                            const gpu::Defines& defines);

  /// Buffers for another layout, the same programs; an error changes nothing.
  core::Result<void> resize(const ParticleLayout& layout);

  /// Sorts position and velocity into sorted_position and sorted_velocity, by cell and then by their order before.
  void build(const ParticleBuffers& particles);

  /// First particle of each cell, cell_count + 1 entries.
  [[nodiscard]] const gpu::TexelBuffer& cellStart() const { return cell_start_; }

 private:
  NeighborGrid(gpu::Context& ctx, const ParticleLayout& layout)
      : ctx_(ctx), count_(layout.count), cell_count_(layout.cell_count) {}

  gpu::Context& ctx_;
  std::uint32_t count_;
  std::uint32_t cell_count_;
  gpu::TexelBuffer cell_count_of_, cell_start_, cell_arrival_, cell_member_, block_total_;
  gpu::Program count_program_, scan_blocks_, scan_totals_, scan_add_, scatter_, reorder_;
};

}  // namespace spindrift::sim
