#include "neighbor_grid.h"

#include <shared/bindings.h>
#include <shared/groups.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<NeighborGrid>> NeighborGrid::create(gpu::Context& ctx, const ParticleLayout& layout,
                                                                 const gpu::Defines& defines, bool pooled) {
  using gpu::Program;
  using gpu::TexelBuffer;
  using gpu::TexelFormat;
  auto grid = std::unique_ptr<NeighborGrid>(new NeighborGrid(ctx));
  const std::size_t blocks = layout.cell_count / SCAN_BLOCK + 1;
  Creation create;
  create(grid->cell_count_of_, TexelBuffer::create(ctx, "cell count", layout.cell_count + 1, TexelFormat::kR32UI));
  create(grid->cell_start_, TexelBuffer::create(ctx, "cell start", layout.cell_count + 1, TexelFormat::kR32UI));
  create(grid->cell_arrival_, TexelBuffer::create(ctx, "cell arrival", layout.count, TexelFormat::kRG32UI));
  create(grid->cell_member_, TexelBuffer::create(ctx, "cell member", layout.count, TexelFormat::kR32UI));
  create(grid->block_total_, TexelBuffer::create(ctx, "block total", blocks, TexelFormat::kR32UI));
  if (pooled) create(grid->clear_, Program::create(ctx, "grid/clear.comp", defines));
  create(grid->count_program_, Program::create(ctx, "grid/count.comp", defines));
  create(grid->scan_blocks_, Program::create(ctx, "grid/scan_blocks.comp", defines));
  create(grid->scan_totals_, Program::create(ctx, "grid/scan_totals.comp", defines));
  create(grid->scan_add_, Program::create(ctx, "grid/scan_add.comp", defines));
  create(grid->scatter_, Program::create(ctx, "grid/scatter.comp", defines));
  create(grid->reorder_, Program::create(ctx, "grid/reorder.comp", defines));
  if (create.error()) return *create.error();
  return grid;
}

void NeighborGrid::build(const ParticleBuffers& particles, const Population& population) {
  const auto next = [&] { ctx_.barrier(gpu::Barrier::kStorageAndTexel); };
  population.bind();

  if (population.pool()) {
    cell_count_of_.bindStorage(CELL_COUNT);
    population.forCells(clear_);
    next();
  } else {
    cell_count_of_.clear();
    ctx_.barrier(gpu::Barrier::kBufferUpdate);
  }

  // How many particles are in each cell.
  particles.position.bindTexel(POSITION);
  cell_count_of_.bindStorage(CELL_COUNT);
  cell_arrival_.bindStorage(CELL_ARRIVAL);
  population.forParticles(count_program_);
  next();

  // Where each cell starts: exclusive prefix sum of the counts.
  cell_count_of_.bindTexel(CELL_COUNT);
  cell_start_.bindStorage(CELL_START);
  block_total_.bindStorage(BLOCK_TOTAL);
  population.forScanBlocks(scan_blocks_);
  next();
  population.forOneGroup(scan_totals_);
  next();
  block_total_.bindTexel(BLOCK_TOTAL);
  population.forCells(scan_add_);
  next();

  // Particles move to their cells.
  cell_arrival_.bindTexel(CELL_ARRIVAL);
  cell_start_.bindTexel(CELL_START);
  cell_member_.bindStorage(CELL_MEMBER);
  population.forParticles(scatter_);
  next();
  particles.velocity.bindTexel(VELOCITY);
  cell_member_.bindTexel(CELL_MEMBER);
  particles.sorted_position.bindStorage(SORTED_POSITION);
  particles.sorted_velocity.bindStorage(SORTED_VELOCITY);
  population.forParticles(reorder_);
  next();
}

}  // namespace spindrift::sim
