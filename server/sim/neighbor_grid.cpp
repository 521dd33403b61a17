#include "neighbor_grid.h"

#include <utility>

#include <shared/bindings.h>
#include <shared/groups.h>

namespace spindrift::sim {

NeighborGrid::NeighborGrid(Creation& create, const ParticleLayout& layout)
    : crowded_(create.texels("crowded particles", 2, gpu::TexelFormat::kR32UI)),
      clear_(create.pass("grid/clear.comp")),
      count_(create.pass("grid/count.comp")),
      scan_blocks_(create.pass("grid/scan_blocks.comp")),
      scan_totals_(create.pass("grid/scan_totals.comp")),
      scan_add_(create.pass("grid/scan_add.comp")),
      scatter_(create.pass("grid/scatter.comp")),
      reorder_(create.pass("grid/reorder.comp")) {
  resize(create, layout);
}

void NeighborGrid::resize(Creation& create, const ParticleLayout& layout) {
  using enum gpu::TexelFormat;
  const std::uint32_t block_count = layout.cell_count / (SCAN_GROUP * create.context().tuning().scan_items) + 1;
  Cells fresh{.block_count = block_count,
              .count = create.scratch("cell count", layout.cell_count + 1, kR32UI),
              .start = create.scratch("cell start", layout.cell_count + 1, kR32UI),
              .arrival = create.scratch("cell arrival", layout.count, kRG32UI),
              .member = create.scratch("cell member", layout.count, kR32UI),
              .block_total = create.scratch("block total", block_count, kR32UI)};
  if (!create.error()) cells_ = std::move(fresh);
}

void NeighborGrid::build(const ParticleBuffers& particles, const Population& population) {
  // Count the particles of each cell.
  cells_.count.bindStorage(CELL_COUNT);
  population.forCells(clear_);
  particles.position.bindTexel(POSITION);
  cells_.arrival.bindStorage(CELL_ARRIVAL);
  population.forParticles(count_);

  // Compute the start of each cell: exclusive prefix sum of the counts.
  cells_.count.bindTexel(CELL_COUNT);
  cells_.start.bindStorage(CELL_START);
  cells_.block_total.bindStorage(BLOCK_TOTAL);
  population.forScanBlocks(scan_blocks_, cells_.block_count);
  population.forOneGroup(scan_totals_);
  cells_.block_total.bindTexel(BLOCK_TOTAL);
  population.forCells(scan_add_);

  // Move the particles to their cells.
  cells_.arrival.bindTexel(CELL_ARRIVAL);
  cells_.start.bindTexel(CELL_START);
  cells_.member.bindStorage(CELL_MEMBER);
  population.forParticles(scatter_);
  particles.velocity.bindTexel(VELOCITY);
  cells_.member.bindTexel(CELL_MEMBER);
  particles.sorted_position.bindStorage(SORTED_POSITION);
  particles.sorted_velocity.bindStorage(SORTED_VELOCITY);
  population.forParticles(reorder_);
  crowded_.bindStorage(CROWDED);
}

}  // namespace spindrift::sim
