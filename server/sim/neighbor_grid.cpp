#include "neighbor_grid.h"

#include <utility>

#include <shared/bindings.h>
#include <shared/groups.h>

namespace spindrift::sim {

NeighborGrid::NeighborGrid(Creation& create, const ParticleLayout& layout)
    : crowded_(create.texels("crowded particles", 2, gpu::TexelFormat::kR32UI)),
      count_(create.pass("grid/count.comp")),
      scan_totals_(create.pass("grid/scan_totals.comp")),
      scan_cells_(create.pass("grid/scan_cells.comp")),
      scatter_(create.pass("grid/scatter.comp")),
      reorder_(create.pass("grid/reorder.comp")) {
  resize(create, layout);
}

void NeighborGrid::resize(Creation& create, const ParticleLayout& layout) {
  using enum gpu::TexelFormat;
  const std::size_t fours = layout.cell_count / 4 + 1;  // scan_cells.comp takes four cells at a time
  const std::uint32_t run_count = layout.cell_count / (4 * create.context().tuning().scan_items) + 1;
  Cells fresh{.run_count = run_count,
              .count = create.texels("cell count", fours, kRGBA32UI),
              .start = create.scratch("cell start", 4 * fours, kR32UI),
              .arrival = create.scratch("cell arrival", layout.count, kRG32UI),
              .member = create.scratch("cell member", layout.count, kR32UI),
              .run_total = create.texels("run total", run_count, kR32UI)};
  if (!create.error()) cells_ = std::move(fresh);
}

void NeighborGrid::build(const ParticleBuffers& particles, const Population& population) {
  // Count the particles of each cell.
  cells_.count.bindStorage(CELL_COUNT);
  particles.position.bindTexel(POSITION);
  cells_.run_total.bindStorage(RUN_TOTAL);
  cells_.arrival.bindStorage(CELL_ARRIVAL);
  population.forParticles(count_);

  // Compute the start of each cell: exclusive prefix sum of the counts.
  cells_.count.bindTexel(CELL_COUNT);
  cells_.start.bindStorage(CELL_START);
  population.forOneGroup(scan_totals_);
  population.forScanRuns(scan_cells_, cells_.run_count);

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
