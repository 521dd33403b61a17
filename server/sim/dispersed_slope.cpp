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

/// Index of the first grid of the bottom, which one work group solves: it takes fewer dispatches, but a group has one
/// core. Not the finest grid.
std::size_t bottomOf(const Dispersion& dispersion) {
  std::size_t k = 1;
  while (k + 1 < dispersion.levels.size() && dispersion.levels[k].side_count > DISPERSION_BOTTOM_SIDE) ++k;
  return k;
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
    create(grid.from_x, TexelBuffer::create(ctx, "dispersion weights, x faces", table_cells, kFour));
    create(grid.from_z, TexelBuffer::create(ctx, "dispersion weights, z faces", table_cells, kFour));
    if (k > 0) {
      create(grid.right, TexelBuffer::create(ctx, "dispersion right side", cells, kFour, gpu::BufferContent::kScratch));
      create(grid.faces, TexelBuffer::create(ctx, "dispersion faces", cells, kFour, gpu::BufferContent::kScratch));
    }
    if (k == bottom)
      create(out->bottom_weights_, TexelBuffer::create(ctx, "dispersion sweep weights", table_cells, kFour));
  }
  const std::size_t cells = dispersion.root_c.size();
  create(out->root_c_, TexelBuffer::create(ctx, "dispersion strengths", cells, kFour));
  create(out->dispersed_,
         TexelBuffer::create(ctx, "dispersed slope", cells, TexelFormat::kRG32F, gpu::BufferContent::kScratch));
  for (std::size_t finest = 0; finest < 2; ++finest) {
    gpu::Defines of_grid = defines;
    of_grid.emplace_back("FINEST", std::to_string(finest));
    of_grid.emplace_back("FLAT", dispersion.is_flat ? "1" : "0");
    of_grid.emplace_back("UNEVEN", dispersion.is_uneven ? "1" : "0");
    create(out->descend_[finest], Program::create(ctx, "dispersion/descend.comp", of_grid));
    create(out->ascend_[finest], Program::create(ctx, "dispersion/ascend.comp", of_grid));
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
    Texels stiffness, weights, from_x, from_z;
    for (std::size_t level = k; level < end; ++level) {
      append(stiffness, dispersion.levels[level].stiffness);
      append(weights, sweepWeights(dispersion.levels[level]));
      append(from_x, dispersion.levels[level].from_coarse_x);
      append(from_z, dispersion.levels[level].from_coarse_z);
    }
    from_x.resize(stiffness.size());  // the coarsest grid has no weights
    from_z.resize(stiffness.size());
    grids_[k].stiffness.upload(stiffness);
    if (k + 1 == grids_.size()) bottom_weights_.upload(weights);
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
  grid.from_x.bindTexel(DISPERSION_FROM_X);
  grid.from_z.bindTexel(DISPERSION_FROM_Z);
  if (!is_finest) grid.right.bindTexel(DISPERSION_RIGHT);
}

void DispersedSlope::descend(std::size_t level) {
  const Grid& grid = grids_[level];
  const bool is_finest = level == 0;
  bindTables(grid, is_finest);
  grids_[level + 1].right.bindStorage(DISPERSION_COARSE_RIGHT);
  dispatch(descend_[is_finest], grid);
}

void DispersedSlope::solveBottom() {
  bindTables(grids_.back(), false);
  bottom_weights_.bindTexel(DISPERSION_SWEEP);
  grids_.back().faces.bindStorage(DISPERSION_FACES);
  bottom_.dispatchGroups(1);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void DispersedSlope::ascend(std::size_t level) {
  const Grid& grid = grids_[level];
  const bool is_finest = level == 0;
  bindTables(grid, is_finest);
  grids_[level + 1].faces.bindTexel(DISPERSION_COARSE);
  if (is_finest)
    dispersed_.bindStorage(DISPERSED);
  else
    grid.faces.bindStorage(DISPERSION_FACES);
  dispatch(ascend_[is_finest], grid);
}

void DispersedSlope::dispatch(gpu::Program& pass, const Grid& grid) {
  const auto over = [&](std::uint32_t count) { return (grid.side_count + count - 1) / count; };
  pass.dispatch(over(DISPERSION_COLUMNS), over(DISPERSION_STRIP));
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
