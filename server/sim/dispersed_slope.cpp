#include "dispersed_slope.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include <shared/bindings.h>
#include <shared/dispersion_uniforms.h>
#include <shared/groups.h>

#include <spindrift/core/half.h>
#include <spindrift/core/parallel.h>

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
  core::forRangesInParallel(out.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Four& a = first[i];
      const Four& b = second[i];
      out[i] = {core::packHalves(a[0], a[1]), core::packHalves(a[2], a[3]), core::packHalves(b[0], b[1]),
                core::packHalves(b[2], b[3])};
    }
  });
  return out;
}

/// A table of the bottom, and its texels of one grid.
struct BottomTable {
  const char* name;
  std::uint32_t unit;
  std::vector<Four> (*of)(const DispersionLevel&);
};
constexpr BottomTable kBottomTables[] = {
    {"dispersion stiffness", DISPERSION_STIFFNESS, [](const DispersionLevel& level) { return level.stiffness; }},
    {"dispersion spread", DISPERSION_SPREAD, [](const DispersionLevel& level) { return level.spread; }},
    {"dispersion sweep weights", DISPERSION_SWEEP, sweepWeights},
    // None in the coarsest grid.
    {"dispersion weights, x faces", DISPERSION_FROM_X,
     [](const DispersionLevel& level) { return level.from_coarse_x; }},
    {"dispersion weights, z faces", DISPERSION_FROM_Z,
     [](const DispersionLevel& level) { return level.from_coarse_z; }}};

}  // namespace

DispersedSlope::DispersedSlope(Creation& create, const WaveLayout& layout, const Dispersion& dispersion,
                               bool keeps_last_step)
    : tuning_(create.context().tuning()), keeps_last_step_(keeps_last_step) {
  // One work group takes fewer dispatches for the bottom, but has only one core.
  const std::size_t bottom = bottomOf(dispersionGrids(layout));
  bool is_narrow[2] = {false, false};
  for (std::size_t k = 0; k <= bottom; ++k) {
    const std::size_t cells = dispersion.levels[k].stiffness.size();
    Grid& grid = grids_.emplace_back();
    grid.count = dispersion.levels[k].count;
    grid.sizes = create.uniforms<shared::DispersionUniforms>("dispersion sizes");
    if (k > 0) {
      const CellCounts finer = dispersion.levels[k - 1].count;
      const bool is_exact = grid.count == CellCounts{finer.x / 2, finer.z / 2};
      // No pass writes the cells beyond the water: they stay 0.
      grid.right = create.texels("dispersion right side", cells, kFloats,
                                 is_exact ? gpu::BufferContent::kScratch : gpu::BufferContent::kZero);
      grid.faces = create.scratch("dispersion faces", cells, kFloats);
    }
    if (k == bottom) break;
    // The halo of a strip (shaders/dispersion/strip.glsl) goes around a grid with fewer cells more than once.
    constexpr std::uint32_t kNarrowCount = 8;
    is_narrow[k == 0] = is_narrow[k == 0] || std::min(grid.count.x, grid.count.z) < kNarrowCount;
    if (dispersion.is_flat) {
      grid.coefficients = create.texels("dispersion coefficients", 2, kFloats);
    } else {
      grid.coefficients = create.texels("dispersion coefficients", cells, kWords);
      grid.weights = create.texels("dispersion weights", cells, kWords);
    }
  }
  std::size_t bottom_cells = 0;
  for (std::size_t k = bottom; k < dispersion.levels.size(); ++k) bottom_cells += dispersion.levels[k].stiffness.size();
  for (const BottomTable& table : kBottomTables)
    bottom_tables_.push_back(create.texels(table.name, bottom_cells, kFloats));
  dispersed_ =
      create.texels("dispersed slope", layout.counts().total(), keeps_last_step ? kFloats : gpu::TexelFormat::kRG32F,
                    keeps_last_step ? gpu::BufferContent::kZero : gpu::BufferContent::kScratch);
  for (std::size_t finest = 0; finest < 2; ++finest) {
    const gpu::Defines of_grid{{"FINEST", std::to_string(finest)},
                               {"FLAT", dispersion.is_flat ? "1" : "0"},
                               {"NARROW", is_narrow[finest] ? "1" : "0"}};
    descend_[finest] = create.pass("dispersion/descend.comp", of_grid);
    ascend_[finest] = create.pass("dispersion/ascend.comp", of_grid);
  }
  solve_bottom_ = create.plainPass("dispersion/bottom.comp");
  if (create.error()) return;
  for (std::size_t k = 0; k <= bottom; ++k) {
    Grid& grid = grids_[k];
    grid.sizes.uploadValue(
        shared::DispersionUniforms{.grid_nx = grid.count.x,
                                   .grid_nz = grid.count.z,
                                   .coarse_nx = k < bottom ? grids_[k + 1].count.x : 0,
                                   .grid_count = static_cast<std::uint32_t>(dispersion.levels.size() - k)});
  }
  upload(dispersion);
}

void DispersedSlope::declareState(StateBuffers& out) {
  if (keeps_last_step_) out.push_back({.buffer = &dispersed_, .checkpoint = true});
  for (Grid& grid : grids_)
    if (grid.right) out.push_back({.buffer = &grid.right, .lasts = false});  // overwritten, except cells that stay 0
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
  for (std::size_t table = 0; table < bottom_tables_.size(); ++table) {
    std::vector<Floats> texels;
    for (std::size_t k = bottom; k < dispersion.levels.size(); ++k)
      std::ranges::transform(kBottomTables[table].of(dispersion.levels[k]), std::back_inserter(texels), floatsOf);
    if (!texels.empty()) bottom_tables_[table].upload(texels);
  }
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
  run(descend_[level == 0], level);
}

void DispersedSlope::solveBottom() {
  for (std::size_t table = 0; table < bottom_tables_.size(); ++table)
    bottom_tables_[table].bindTexel(kBottomTables[table].unit);
  grids_.back().right.bindTexel(DISPERSION_RIGHT);
  grids_.back().faces.bindStorage(DISPERSION_FACES);
  grids_.back().sizes.bindUniform(DISPERSION_UNIFORMS);
  solve_bottom_.runGroups(1);
}

void DispersedSlope::ascend(std::size_t level) {
  bindTables(level);
  grids_[level + 1].faces.bindTexel(DISPERSION_COARSE);
  if (level == 0)
    dispersed_.bindStorage(DISPERSED);
  else
    grids_[level].faces.bindStorage(DISPERSION_FACES);
  run(ascend_[level == 0], level);
}

void DispersedSlope::run(Pass& pass, std::size_t level) {
  const CellCounts count = grids_[level].count;
  grids_[level].sizes.bindUniform(DISPERSION_UNIFORMS);
  pass.run((count.x + tuning_.dispersion_columns - 1) / tuning_.dispersion_columns,
           (count.z + tuning_.dispersion_strip - 1) / tuning_.dispersion_strip);
}

}  // namespace spindrift::sim
