#include "dispersed_slope.h"

#include <array>
#include <string>

#include <shared/bindings.h>
#include <shared/groups.h>

#include "create_all.h"

namespace spindrift::sim {
namespace {

using Four = std::array<double, 4>;
using Texels = std::vector<std::array<float, 4>>;

void append(Texels& out, const std::vector<Four>& values) {
  for (const Four& v : values)
    out.push_back(
        {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(v[3])});
}

/// Index of the first grid of the bottom: the first one, after the finest, that one work group holds.
std::size_t bottomOf(const Dispersion& dispersion) {
  std::size_t k = 1;
  while (dispersion.levels[k].side_count > kBottomSideMax) ++k;
  return k;
}

/// Invocations along z of a sweep.
std::uint32_t stripsOf(std::uint32_t side_count) {
  return (side_count + DISPERSION_STRIP - 1) / DISPERSION_STRIP;
}

}  // namespace

core::Result<std::unique_ptr<DispersedSlope>> DispersedSlope::create(gpu::Context& ctx, const WaveLayout& layout,
                                                                     const Basin& basin, const gpu::Defines& defines) {
  using gpu::Program;
  using gpu::TexelBuffer;
  using gpu::TexelFormat;
  constexpr auto kFour = TexelFormat::kRGBA32F;
  const Dispersion dispersion = layOutDispersion(layout, basin);
  const std::size_t bottom = bottomOf(dispersion);
  auto out = std::unique_ptr<DispersedSlope>(new DispersedSlope(ctx));
  Creation create;
  for (std::size_t k = 0; k <= bottom; ++k) {
    const std::size_t cells = dispersion.levels[k].stiffness.size();
    std::size_t table_cells = cells;
    for (std::size_t below = k + 1; k == bottom && below < dispersion.levels.size(); ++below)
      table_cells += dispersion.levels[below].stiffness.size();
    Grid& grid = out->grids_.emplace_back();
    grid.side_count = dispersion.levels[k].side_count;
    create(grid.stiffness, TexelBuffer::create(ctx, "dispersion stiffness", table_cells, kFour));
    create(grid.sweep, TexelBuffer::create(ctx, "dispersion sweep weights", table_cells, kFour));
    create(grid.from_x, TexelBuffer::create(ctx, "dispersion weights, x faces", table_cells, kFour));
    create(grid.from_z, TexelBuffer::create(ctx, "dispersion weights, z faces", table_cells, kFour));
    create(grid.faces, TexelBuffer::create(ctx, "dispersion faces", cells, kFour, gpu::BufferContent::kScratch));
    if (k > 0)
      create(grid.right, TexelBuffer::create(ctx, "dispersion right side", cells, kFour, gpu::BufferContent::kScratch));
    if (k < bottom)
      create(grid.before,
             TexelBuffer::create(ctx, "dispersion faces before", cells, kFour, gpu::BufferContent::kScratch));
  }
  const std::size_t cells = dispersion.root_c.size();
  create(out->root_c_, TexelBuffer::create(ctx, "dispersion strengths", cells, kFour));
  create(out->dispersed_,
         TexelBuffer::create(ctx, "dispersed slope", cells, TexelFormat::kRG32F, gpu::BufferContent::kScratch));
  for (std::size_t finest = 0; finest < 2; ++finest) {
    gpu::Defines of_grid = defines;
    of_grid.emplace_back("FINEST", std::to_string(finest));
    of_grid.emplace_back("UNEVEN", dispersion.is_uneven ? "1" : "0");
    create(out->start_[finest], Program::create(ctx, "dispersion/start.comp", of_grid));
    create(out->restrict_[finest], Program::create(ctx, "dispersion/restrict.comp", of_grid));
    create(out->correct_[finest], Program::create(ctx, "dispersion/correct.comp", of_grid));
    create(out->sweep_[finest], Program::create(ctx, "dispersion/sweep.comp", of_grid));
  }
  create(out->bottom_, Program::create(ctx, "dispersion/bottom.comp"));
  if (create.error()) return *create.error();
  out->upload(dispersion);
  return out;
}

void DispersedSlope::upload(const WaveLayout& layout, const Basin& basin) {
  upload(layOutDispersion(layout, basin));
}

void DispersedSlope::upload(const Dispersion& dispersion) {
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    const std::size_t end = k + 1 < grids_.size() ? k + 1 : dispersion.levels.size();
    Texels stiffness, sweep, from_x, from_z;
    for (std::size_t level = k; level < end; ++level) {
      append(stiffness, dispersion.levels[level].stiffness);
      append(sweep, sweepWeights(dispersion.levels[level]));
      append(from_x, dispersion.levels[level].from_coarse_x);
      append(from_z, dispersion.levels[level].from_coarse_z);
    }
    from_x.resize(stiffness.size());  // the coarsest grid has no weights
    from_z.resize(stiffness.size());
    grids_[k].stiffness.upload(stiffness);
    grids_[k].sweep.upload(sweep);
    grids_[k].from_x.upload(from_x);
    grids_[k].from_z.upload(from_z);
  }
  Texels root_c;
  append(root_c, dispersion.root_c);
  root_c_.upload(root_c);
}

void DispersedSlope::compute(const gpu::TexelBuffer& elevation, const gpu::TexelBuffer* pressure_head) {
  elevation.bindTexel(ELEVATION);
  if (pressure_head) pressure_head->bindTexel(PRESSURE_HEAD);
  root_c_.bindTexel(DISPERSION_ROOT_C);
  const std::size_t bottom = grids_.size() - 1;
  for (std::size_t level = 0; level < bottom; ++level) descend(level);
  solveBottom();
  for (std::size_t level = bottom; level-- > 0;) ascend(level);
}

void DispersedSlope::bindTables(const Grid& grid, bool is_finest) {
  grid.stiffness.bindTexel(DISPERSION_STIFFNESS);
  grid.sweep.bindTexel(DISPERSION_SWEEP);
  grid.from_x.bindTexel(DISPERSION_FROM_X);
  grid.from_z.bindTexel(DISPERSION_FROM_Z);
  if (!is_finest) grid.right.bindTexel(DISPERSION_RIGHT);
}

void DispersedSlope::descend(std::size_t level) {
  Grid& grid = grids_[level];
  const bool is_finest = level == 0;
  const std::uint32_t n = grid.side_count;
  bindTables(grid, is_finest);
  grid.faces.bindStorage(DISPERSION_FACES);
  start_[is_finest].dispatch(n, stripsOf(n));
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);

  grid.faces.bindTexel(DISPERSION_FACES);
  grids_[level + 1].right.bindStorage(DISPERSION_COARSE_RIGHT);
  restrict_[is_finest].dispatch(n / 2, n / 2);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void DispersedSlope::solveBottom() {
  bindTables(grids_.back(), false);
  grids_.back().faces.bindStorage(DISPERSION_FACES);
  bottom_.dispatchGroups(1);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void DispersedSlope::ascend(std::size_t level) {
  Grid& grid = grids_[level];
  const bool is_finest = level == 0;
  const std::uint32_t n = grid.side_count;
  bindTables(grid, is_finest);
  grid.faces.bindTexel(DISPERSION_BEFORE);
  grids_[level + 1].faces.bindTexel(DISPERSION_COARSE);
  grid.before.bindStorage(DISPERSION_FACES);
  correct_[is_finest].dispatch(n, stripsOf(n));
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);

  grid.before.bindTexel(DISPERSION_BEFORE);
  if (is_finest)
    dispersed_.bindStorage(DISPERSED);
  else
    grid.faces.bindStorage(DISPERSION_FACES);
  sweep_[is_finest].dispatch(n, stripsOf(n));
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
