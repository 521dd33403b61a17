#include "dispersed_slope.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include <shared/bindings.h>
#include <shared/dispersion_uniforms.h>
#include <shared/groups.h>

#include <spindrift/core/half.h>

#include "create_all.h"

namespace spindrift::sim {
namespace {

using Four = std::array<double, 4>;
using Floats = std::array<float, 4>;
using Words = std::array<std::uint32_t, 4>;

constexpr auto kFloats = gpu::TexelFormat::kRGBA32F;
constexpr auto kWords = gpu::TexelFormat::kRGBA32UI;

Floats floatsOf(const Four& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(v[3])};
}

/// One texel per cell: the halves of both tables.
std::vector<Words> packed(const std::vector<Four>& first, const std::vector<Four>& second) {
  std::vector<Words> out(first.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Four& a = first[i];
    const Four& b = second[i];
    out[i] = {core::packHalves(a[0], a[1]), core::packHalves(a[2], a[3]), core::packHalves(b[0], b[1]),
              core::packHalves(b[2], b[3])};
  }
  return out;
}

/// The halo of a strip (shaders/dispersion/strip.glsl) goes around a grid with fewer cells more than once.
constexpr std::uint32_t kNarrowCount = 2 * DISPERSION_COLUMNS;

}  // namespace

core::Result<std::unique_ptr<DispersedSlope>> DispersedSlope::create(gpu::Context& ctx, const WaveLayout& layout,
                                                                     const Basin& basin, const gpu::Defines& defines,
                                                                     bool keeps_last_step) {
  using gpu::Program;
  using gpu::TexelBuffer;
  constexpr auto kScratch = gpu::BufferContent::kScratch;
  const Dispersion dispersion = layOutDispersion(layout, basin);
  // One work group takes fewer dispatches for the bottom, but has only one core.
  const std::size_t bottom = bottomOf(dispersionGrids(layout));
  bool is_narrow[2] = {false, false};
  auto out = std::unique_ptr<DispersedSlope>(new DispersedSlope(ctx, keeps_last_step));
  Creation create;
  for (std::size_t k = 0; k <= bottom; ++k) {
    const std::size_t cells = dispersion.levels[k].stiffness.size();
    Grid& grid = out->grids_.emplace_back();
    grid.count = dispersion.levels[k].count;
    create(grid.sizes, gpu::Buffer::create(ctx, "dispersion sizes", sizeof(shared::DispersionUniforms),
                                           gpu::BufferUse::kUpdatable));
    if (k > 0) {
      const CellCounts finer = dispersion.levels[k - 1].count;
      const bool is_exact = grid.count == CellCounts{finer.x / 2, finer.z / 2};
      // No pass writes the cells beyond the water: they stay 0.
      create(grid.right, TexelBuffer::create(ctx, "dispersion right side", cells, kFloats,
                                             is_exact ? kScratch : gpu::BufferContent::kZero));
      create(grid.faces, TexelBuffer::create(ctx, "dispersion faces", cells, kFloats, kScratch));
    }
    if (k == bottom) break;
    is_narrow[k == 0] = is_narrow[k == 0] || std::min(grid.count.x, grid.count.z) < kNarrowCount;
    if (dispersion.is_flat) {
      create(grid.coefficients, TexelBuffer::create(ctx, "dispersion coefficients", 2, kFloats));
    } else {
      create(grid.coefficients, TexelBuffer::create(ctx, "dispersion coefficients", cells, kWords));
      create(grid.weights, TexelBuffer::create(ctx, "dispersion weights", cells, kWords));
    }
  }
  Bottom& tables = out->bottom_;
  std::size_t bottom_cells = 0;
  for (std::size_t k = bottom; k < dispersion.levels.size(); ++k) bottom_cells += dispersion.levels[k].stiffness.size();
  create(tables.stiffness, TexelBuffer::create(ctx, "dispersion stiffness", bottom_cells, kFloats));
  create(tables.spread, TexelBuffer::create(ctx, "dispersion spread", bottom_cells, kFloats));
  create(tables.sweep, TexelBuffer::create(ctx, "dispersion sweep weights", bottom_cells, kFloats));
  create(tables.from_x, TexelBuffer::create(ctx, "dispersion weights, x faces", bottom_cells, kFloats));
  create(tables.from_z, TexelBuffer::create(ctx, "dispersion weights, z faces", bottom_cells, kFloats));
  create(out->dispersed_, TexelBuffer::create(ctx, "dispersed slope", layout.counts().total(),
                                              keeps_last_step ? kFloats : gpu::TexelFormat::kRG32F,
                                              keeps_last_step ? gpu::BufferContent::kZero : kScratch));
  for (std::size_t finest = 0; finest < 2; ++finest) {
    gpu::Defines of_grid = defines;
    of_grid.emplace_back("FINEST", std::to_string(finest));
    of_grid.emplace_back("FLAT", dispersion.is_flat ? "1" : "0");
    of_grid.emplace_back("NARROW", is_narrow[finest] ? "1" : "0");
    create(out->descend_[finest], Program::create(ctx, "dispersion/descend.comp", of_grid));
    create(out->ascend_[finest], Program::create(ctx, "dispersion/ascend.comp", of_grid));
  }
  create(tables.solve, Program::create(ctx, "dispersion/bottom.comp"));
  if (create.error()) return *create.error();
  for (std::size_t k = 0; k <= bottom; ++k) {
    Grid& grid = out->grids_[k];
    grid.sizes.uploadValue(
        shared::DispersionUniforms{.grid_nx = grid.count.x,
                                   .grid_nz = grid.count.z,
                                   .coarse_nx = k < bottom ? out->grids_[k + 1].count.x : 0,
                                   .grid_count = static_cast<std::uint32_t>(dispersion.levels.size() - k)});
  }
  out->upload(dispersion);
  return out;
}

void DispersedSlope::declareState(StateBuffers& out) {
  if (keeps_last_step_) out.push_back({.buffer = &dispersed_, .checkpoint = true});
  for (Grid& grid : grids_)
    if (grid.right) out.push_back({.buffer = &grid.right, .lasts = false});  // overwritten, except cells that stay 0
}

void DispersedSlope::upload(const WaveLayout& layout, const Basin& basin) {
  upload(layOutDispersion(layout, basin));
}

void DispersedSlope::upload(const Dispersion& dispersion) {
  const std::size_t bottom = grids_.size() - 1;
  for (std::size_t k = 0; k < bottom; ++k) {
    const DispersionLevel& level = dispersion.levels[k];
    if (dispersion.is_flat) {
      // The first cell is wet and its faces are open.
      grids_[k].coefficients.upload(
          std::array{floatsOf(level.stiffness[0]), floatsOf(k == 0 ? dispersion.root_c[0] : level.spread[0])});
    } else {
      grids_[k].coefficients.upload(packed(level.stiffness, k == 0 ? dispersion.root_c : level.spread));
      grids_[k].weights.upload(packed(level.from_coarse_x, level.from_coarse_z));
    }
  }
  std::vector<Floats> stiffness, spread, sweep, from_x, from_z;
  for (std::size_t k = bottom; k < dispersion.levels.size(); ++k) {
    const DispersionLevel& level = dispersion.levels[k];
    std::ranges::transform(level.stiffness, std::back_inserter(stiffness), floatsOf);
    std::ranges::transform(level.spread, std::back_inserter(spread), floatsOf);
    std::ranges::transform(sweepWeights(level), std::back_inserter(sweep), floatsOf);
    std::ranges::transform(level.from_coarse_x, std::back_inserter(from_x), floatsOf);  // none in the coarsest grid
    std::ranges::transform(level.from_coarse_z, std::back_inserter(from_z), floatsOf);
  }
  bottom_.stiffness.upload(stiffness);
  bottom_.spread.upload(spread);
  bottom_.sweep.upload(sweep);
  if (!from_x.empty()) bottom_.from_x.upload(from_x);
  if (!from_z.empty()) bottom_.from_z.upload(from_z);
}

void DispersedSlope::compute() {
  const std::size_t bottom = grids_.size() - 1;
  for (std::size_t level = 0; level < bottom; ++level) descend(level);
  solveBottom();
  for (std::size_t level = bottom; level-- > 0;) ascend(level);
}

void DispersedSlope::bindTables(std::size_t level) {
  const Grid& grid = grids_[level];
  grid.coefficients.bindTexel(DISPERSION_COEFFICIENTS);
  if (grid.weights) grid.weights.bindTexel(DISPERSION_WEIGHTS);
  if (level > 0) grid.right.bindTexel(DISPERSION_RIGHT);
}

void DispersedSlope::descend(std::size_t level) {
  bindTables(level);
  grids_[level + 1].right.bindStorage(DISPERSION_COARSE_RIGHT);
  dispatch(descend_[level == 0], level);
}

void DispersedSlope::solveBottom() {
  bottom_.stiffness.bindTexel(DISPERSION_STIFFNESS);
  bottom_.spread.bindTexel(DISPERSION_SPREAD);
  bottom_.sweep.bindTexel(DISPERSION_SWEEP);
  bottom_.from_x.bindTexel(DISPERSION_FROM_X);
  bottom_.from_z.bindTexel(DISPERSION_FROM_Z);
  grids_.back().right.bindTexel(DISPERSION_RIGHT);
  grids_.back().faces.bindStorage(DISPERSION_FACES);
  grids_.back().sizes.bindUniform(DISPERSION_UNIFORMS);
  bottom_.solve.dispatchGroups(1);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void DispersedSlope::ascend(std::size_t level) {
  bindTables(level);
  grids_[level + 1].faces.bindTexel(DISPERSION_COARSE);
  if (level == 0)
    dispersed_.bindStorage(DISPERSED);
  else
    grids_[level].faces.bindStorage(DISPERSION_FACES);
  dispatch(ascend_[level == 0], level);
}

void DispersedSlope::dispatch(gpu::Program& pass, std::size_t level) {
  const CellCounts count = grids_[level].count;
  grids_[level].sizes.bindUniform(DISPERSION_UNIFORMS);
  pass.dispatch((count.x + DISPERSION_COLUMNS - 1) / DISPERSION_COLUMNS,
                (count.z + DISPERSION_STRIP - 1) / DISPERSION_STRIP);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
