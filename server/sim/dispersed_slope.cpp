#include "dispersed_slope.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
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

/// Cells that a strip computes with beyond its own, to either side (shaders/dispersion/strip.glsl).
constexpr int kReach = 4;

/// The invocations of whole work groups.
std::uint32_t inGroups(std::size_t strips) {
  return static_cast<std::uint32_t>((strips + DISPERSION_GROUP - 1) / DISPERSION_GROUP * DISPERSION_GROUP);
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

/// Returns the weights of the face behind cell i of n, in both coarse faces along its axis, where no wall is near.
/// Coarse faces at sides have none.
std::uint32_t openWeights(int i, int n, bool is_periodic) {
  static const std::uint32_t kWhole = core::packHalves(1.0, 0.0);
  static const std::uint32_t kBoth = core::packHalves(0.5, 0.5);
  static const std::uint32_t kBehind = core::packHalves(0.0, 0.5);
  static const std::uint32_t kAhead = core::packHalves(0.5, 0.0);
  if (i % 2 != 0) return kWhole;
  if (is_periodic) return kBoth;
  return i == n - 2 ? kBehind : (i == 0 ? kAhead : kBoth);
}

/// Returns a value if the strip at cell (first_x, first_z) is steady: every face that it computes with may use the
/// coefficients of its second row, and weights without walls. 0, or DISPERSION_SIDES_WITHOUT_SPREAD if there is no
/// spread beside sides across z.
std::optional<std::uint32_t> steadiness(const DispersionLevel& level, const std::vector<Words>& coefficients,
                                        const std::vector<Words>& weights, const StripShape& strip, int first_x,
                                        int first_z) {
  const int nx = static_cast<int>(level.count.x);
  const int nz = static_cast<int>(level.count.z);
  // Nothing passes a side that is not periodic, so what is beyond it does not matter.
  const auto range = [](int first, std::uint32_t count, int n, bool is_periodic) {
    const std::array out{first - kReach, std::min(first + static_cast<int>(count), n) + kReach + 1};
    return is_periodic ? out : std::array{std::max(out[0], 0), std::min(out[1], n)};
  };
  const auto [begin_x, end_x] = range(first_x, strip.cells.x, nx, strip.is_periodic_x);
  const auto [begin_z, end_z] = range(first_z, strip.cells.z, nz, strip.is_periodic_z);
  // The shader closes the faces at sides itself.
  const auto isLast = [](int i, int n, bool is_periodic) { return !is_periodic && i == n - 1; };
  if (first_z + 1 >= nz || isLast(first_z + 1, nz, strip.is_periodic_z)) return {};
  bool keeps_spread = true;
  bool lacks_spread = true;
  for (int x = begin_x; x < end_x; ++x) {
    const Words& wanted = coefficients[level.index(x, first_z + 1)];
    for (int z = begin_z; z < end_z; ++z) {
      const std::size_t i = level.index(x, z);
      Words here = coefficients[i];
      const bool is_last = isLast(z, nz, strip.is_periodic_z);
      if (is_last) here[0] = (here[0] & 0xffff) | (wanted[0] & 0xffff0000);
      if (is_last && level.spread.empty()) here[3] = wanted[3];
      if ((is_last || (z == 0 && !strip.is_periodic_z)) && !level.spread.empty()) {
        keeps_spread = keeps_spread && here[2] == wanted[2] && here[3] == wanted[3];
        lacks_spread = lacks_spread && here[2] == 0 && here[3] == 0;
        here[2] = wanted[2];
        here[3] = wanted[3];
      }
      const Words& w = weights[i];
      const bool is_open_x =
          isLast(x, nx, strip.is_periodic_x) || (w[0] == openWeights(x, nx, strip.is_periodic_x) && w[1] == 0);
      const bool is_open_z = is_last || (w[2] == 0 && w[3] == openWeights(z, nz, strip.is_periodic_z));
      if (here != wanted || !is_open_x || !is_open_z || (!keeps_spread && !lacks_spread)) return {};
    }
  }
  return keeps_spread ? 0 : DISPERSION_SIDES_WITHOUT_SPREAD;
}

/// Returns whether all faces that a strip owns are closed, and those of the coarser grid that it sums up for.
bool isClosed(const DispersionLevel& level, const DispersionLevel& coarser, const StripShape& strip,
              std::uint32_t first_x, std::uint32_t first_z) {
  const auto areClosed = [](const DispersionLevel& grid, std::uint32_t begin_x, std::uint32_t end_x,
                            std::uint32_t begin_z, std::uint32_t end_z) {
    for (std::uint32_t z = begin_z; z < std::min(end_z, grid.count.z); ++z) {
      for (std::uint32_t x = begin_x; x < std::min(end_x, grid.count.x); ++x) {
        const Four& stiffness = grid.stiffness[x + std::size_t{grid.count.x} * z];
        if (stiffness[0] > 0.0 || stiffness[1] > 0.0) return false;
      }
    }
    return true;
  };
  const std::uint32_t end_x = first_x + strip.cells.x;
  const std::uint32_t end_z = first_z + strip.cells.z;
  return areClosed(level, first_x, end_x, first_z, end_z) &&
         areClosed(coarser, first_x / 2, end_x / 2, first_z / 2, end_z / 2);
}

/// Returns the strips of a grid as words for DISPERSION_STRIPS, in whole groups, by whether they are steady, which
/// only those of the finest grid are: on the others a second program saves nothing. Those of dry ground are left out:
/// what they would write stays 0.
std::array<std::vector<std::uint32_t>, 2> stripLists(const DispersionLevel& level, const DispersionLevel& coarser,
                                                     const std::vector<Words>& coefficients,
                                                     const std::vector<Words>& weights, const StripShape& strip,
                                                     bool is_finest) {
  constexpr std::uint32_t kNone = 0xffffffff;
  std::array<std::vector<std::uint32_t>, 2> out;
  const CellCounts count = strip.stripsOf(level.count);
  for (std::uint32_t z = 0; z < count.z; ++z) {
    for (std::uint32_t x = 0; x < count.x; ++x) {
      if (isClosed(level, coarser, strip, x * strip.cells.x, z * strip.cells.z)) continue;
      std::optional<std::uint32_t> steady;
      if (is_finest)
        steady = steadiness(level, coefficients, weights, strip, static_cast<int>(x * strip.cells.x),
                            static_cast<int>(z * strip.cells.z));
      out[steady.has_value()].push_back(x | steady.value_or(0) | z << 16);
    }
  }
  for (auto& words : out) words.resize(inGroups(words.size()), kNone);
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
    : strip_{.cells = {create.context().tuning().dispersion_columns, create.context().tuning().dispersion_strip},
             .is_periodic_x = layout.is_periodic_x,
             .is_periodic_z = layout.is_periodic_z},
      is_flat_(dispersion.is_flat),
      keeps_last_step_(keeps_last_step) {
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
      // No pass writes the cells beyond the water, and strips of dry ground: they stay 0.
      const auto content = is_exact && is_flat_ ? gpu::BufferContent::kScratch : gpu::BufferContent::kZero;
      grid.right = create.texels("dispersion right side", cells, kFloats, content);
      grid.faces = create.texels("dispersion faces", cells, kFloats, content);
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
      for (Strips& strips : grid.strips)
        strips.list =
            create.texels("dispersion strips", inGroups(strip_.stripsOf(grid.count).total()), gpu::TexelFormat::kR32UI);
    }
  }
  std::size_t bottom_cells = 0;
  for (std::size_t k = bottom; k < dispersion.levels.size(); ++k) bottom_cells += dispersion.levels[k].stiffness.size();
  for (const BottomTable& table : kBottomTables)
    bottom_tables_.push_back(create.texels(table.name, bottom_cells, kFloats));
  dispersed_ =
      create.texels("dispersed slope", layout.counts().total(), keeps_last_step ? kFloats : gpu::TexelFormat::kRG32F,
                    keeps_last_step || !is_flat_ ? gpu::BufferContent::kZero : gpu::BufferContent::kScratch);
  for (std::size_t finest = 0; finest < 2; ++finest) {
    for (const bool steady : {false, true}) {
      if (is_flat_ ? !steady : steady && finest == 0) continue;
      const gpu::Defines of_grid{{"FINEST", std::to_string(finest)},
                                 {"FLAT", is_flat_ ? "1" : "0"},
                                 {"STEADY", steady ? "1" : "0"},
                                 {"NARROW", is_narrow[finest] ? "1" : "0"}};
      descend_[finest][steady] = create.pass("dispersion/descend.comp", of_grid);
      ascend_[finest][steady] = create.pass("dispersion/ascend.comp", of_grid);
    }
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
  out.push_back({.buffer = &dispersed_, .lasts = keeps_last_step_, .checkpoint = keeps_last_step_});
  for (Grid& grid : grids_) {
    if (!grid.right) continue;
    // Overwritten, except cells that stay 0.
    out.push_back({.buffer = &grid.right, .lasts = false});
    out.push_back({.buffer = &grid.faces, .lasts = false});
  }
}

void DispersedSlope::upload(const Dispersion& dispersion) {
  const std::size_t bottom = grids_.size() - 1;
  if (!is_flat_) {
    // Ground may have become dry; that of a nonlinear bulk, whose last step is state, does not change.
    for (std::size_t k = 1; k <= bottom; ++k) grids_[k].right.clear(), grids_[k].faces.clear();
    if (!keeps_last_step_) dispersed_.clear();
  }
  for (std::size_t k = 0; k < bottom; ++k) {
    const DispersionLevel& level = dispersion.levels[k];
    if (is_flat_) {
      // The first cell is wet and its faces are open.
      grids_[k].coefficients.upload(
          std::array{floatsOf(level.stiffness[0]), floatsOf(k == 0 ? dispersion.root_c[0] : level.spread[0])});
    } else {
      const std::vector<Words> coefficients = packed(level.stiffness, k == 0 ? dispersion.root_c : level.spread);
      const std::vector<Words> weights = packed(level.from_coarse_x, level.from_coarse_z);
      grids_[k].coefficients.upload(coefficients);
      grids_[k].weights.upload(weights);
      const auto lists = stripLists(level, dispersion.levels[k + 1], coefficients, weights, strip_, k == 0);
      for (std::size_t steady = 0; steady < 2; ++steady) {
        Strips& strips = grids_[k].strips[steady];
        strips.count = static_cast<std::uint32_t>(lists[steady].size());
        if (strips.count > 0) strips.list.upload(lists[steady]);
      }
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

void DispersedSlope::run(Pass (&passes)[2], std::size_t level) {
  const Grid& grid = grids_[level];
  grid.sizes.bindUniform(DISPERSION_UNIFORMS);
  if (is_flat_) return passes[1].run(strip_.stripsOf(grid.count));
  for (std::size_t steady = 0; steady < 2; ++steady) {
    const Strips& strips = grid.strips[steady];
    if (strips.count == 0) continue;
    strips.list.bindTexel(DISPERSION_STRIPS);
    passes[steady].run(strips.count);
  }
}

}  // namespace spindrift::sim
