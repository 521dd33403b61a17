#include "neighbor_grid.h"

#include <shared/bindings.h>
#include <shared/groups.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<NeighborGrid>> NeighborGrid::create(gpu::Context& ctx, const ParticleLayout& layout,
                                                                 const gpu::Defines& defines, bool pooled) {
  using gpu::Program;
  auto grid = std::unique_ptr<NeighborGrid>(new NeighborGrid(ctx));
  if (auto sized = grid->resize(layout); !sized) return sized.error();
  Creation create;
  create(grid->crowded_, gpu::TexelBuffer::create(ctx, "crowded particles", 2, gpu::TexelFormat::kR32UI));
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

core::Result<void> NeighborGrid::resize(const ParticleLayout& layout) {
  using gpu::TexelBuffer;
  using gpu::TexelFormat;
  const std::size_t blocks = layout.cell_count / SCAN_BLOCK + 1;
  TexelBuffer counts, start, arrival, member, total;
  Creation create;
  create(counts, TexelBuffer::create(ctx_, "cell count", layout.cell_count + 1, TexelFormat::kR32UI,
                                     gpu::BufferContent::kScratch));
  create(start, TexelBuffer::create(ctx_, "cell start", layout.cell_count + 1, TexelFormat::kR32UI,
                                    gpu::BufferContent::kScratch));
  create(arrival,
         TexelBuffer::create(ctx_, "cell arrival", layout.count, TexelFormat::kRG32UI, gpu::BufferContent::kScratch));
  create(member,
         TexelBuffer::create(ctx_, "cell member", layout.count, TexelFormat::kR32UI, gpu::BufferContent::kScratch));
  create(total, TexelBuffer::create(ctx_, "block total", blocks, TexelFormat::kR32UI, gpu::BufferContent::kScratch));
  if (create.error()) return *create.error();
  cell_count_of_ = std::move(counts);
  cell_start_ = std::move(start);
  cell_arrival_ = std::move(arrival);
  cell_member_ = std::move(member);
  block_total_ = std::move(total);
  return {};
}

void NeighborGrid::build(const ParticleBuffers& particles, const Population& population) {
  // One buffer of the pool holds both the group counts of the next pass and the words that this pass writes.
  const auto readers =
      population.pool() ? gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect : gpu::Barrier::kStorageAndTexel;
  const auto next = [&] { ctx_.barrier(readers); };
  population.bind();

  if (population.pool()) {
    cell_count_of_.bindStorage(CELL_COUNT);
    population.forCells(clear_);
    next();
  } else {
    cell_count_of_.clear();
  }

  // Count the particles of each cell.
  particles.position.bindTexel(POSITION);
  cell_count_of_.bindStorage(CELL_COUNT);
  cell_arrival_.bindStorage(CELL_ARRIVAL);
  population.forParticles(count_program_);
  next();

  // Compute the start of each cell: exclusive prefix sum of the counts.
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

  // Move the particles to their cells.
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
  crowded_.bindStorage(CROWDED);
}

}  // namespace spindrift::sim
