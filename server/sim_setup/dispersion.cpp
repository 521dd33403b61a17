#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <spindrift/core/half.h>
#include <spindrift/core/parallel.h>
#include <spindrift/sim_setup/dispersion.h>

#include "dispersion_grid.h"

namespace spindrift::sim {
namespace {

using Four = std::array<double, 4>;

constexpr std::uint32_t kCoarsestSideCount = 4;

/// Fitted coefficients by depth in cells, a factor of sqrt(2) apart. Printed by tests/tools/fit_dispersion.cpp.
struct FittedPoles {
  double depth_cells;
  Poles poles;
};
constexpr FittedPoles kFitted[] = {
#include "dispersion_poles.inc"
};

/// The fitted coefficients on both sides of a depth, and where it lies between them.
struct Between {
  const Poles& low;
  const Poles& high;
  double share;
};

Between between(double depth_cells) {
  const std::span fitted(kFitted);
  if (depth_cells <= fitted.front().depth_cells) return {fitted.front().poles, fitted.front().poles, 0.0};
  if (depth_cells >= fitted.back().depth_cells) return {fitted.back().poles, fitted.back().poles, 0.0};
  const auto above =
      std::ranges::find_if(fitted, [&](const FittedPoles& row) { return row.depth_cells > depth_cells; });
  const FittedPoles& high = *above;
  const FittedPoles& low = *(above - 1);
  return {low.poles, high.poles,
          std::log(depth_cells / low.depth_cells) / std::log(high.depth_cells / low.depth_cells)};
}

/// b_j on a grid of the V-cycle, the finest being 0.
std::array<double, kPoleCount> bAt(double depth_cells, std::size_t grid) {
  const auto& [low, high, share] = between(depth_cells);
  std::array<double, kPoleCount> out{};
  for (std::size_t j = 0; j < kPoleCount; ++j)
    out[j] = low.bOf(grid)[j] * std::pow(high.bOf(grid)[j] / low.bOf(grid)[j], share);
  return out;
}

std::array<double, kPoleCount> cAt(double depth_cells) {
  const auto& [low, high, share] = between(depth_cells);
  std::array<double, kPoleCount> out{};
  for (std::size_t j = 0; j < kPoleCount; ++j) out[j] = std::lerp(low.c[j], high.c[j], share);
  return out;
}

/// A function of the depth that costs several logarithms, and its last result: neighbours often have one depth.
template <class Of>
class LastOf {
 public:
  explicit LastOf(Of of) : of_(std::move(of)) {}
  const std::array<double, kPoleCount>& operator()(double depth_cells) {
    if (depth_cells != depth_cells_) value_ = of_(depth_cells_ = depth_cells);
    return value_;
  }

 private:
  Of of_;
  double depth_cells_ = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kPoleCount> value_{};
};

template <std::size_t kCount>
void roundToHalves(std::vector<std::array<double, kCount>>& texels) {
  core::forRangesInParallel(texels.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) std::ranges::transform(texels[i], texels[i].begin(), core::roundToHalf);
  });
}

/// `k`: number of the grid, 0 for the finest, whose cells have `finest_m`.
std::vector<Four> stiffnessOf(const DispersionGrid& grid, std::size_t k, double finest_m, double scene_depth_m) {
  const double cell_m = std::ldexp(finest_m, static_cast<int>(k));
  std::vector<Four> out(grid.wet.size(), Four{});
  core::forRangesInParallel(out.size(), [&](std::size_t begin, std::size_t end) {
    LastOf last([&](double depth_cells) { return bAt(depth_cells, k); });
    for (std::size_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        if (grid.open[i][axis] > 0.0) out[i][axis] = scene_depth_m * grid.resistance_pm[i][axis] / grid.open[i][axis];
      }
      if (grid.wet[i] <= 0.0) continue;
      const auto& b = last(grid.depth_m[i] / finest_m);
      for (std::size_t j = 0; j < kPoleCount; ++j)
        out[i][2 + j] = scene_depth_m * b[j] * grid.depth_m[i] / (grid.wet[i] * cell_m * cell_m);
    }
  });
  return out;
}

/// DispersionLevel::spread of grid k, a coarse one. Sides of the water count for nothing: a wave along a channel must
/// be equally fast in all of its width. Cells that are in part beyond a side count along each axis by itself. Where
/// walls or ground close faces within the water, cells beside any closed face have none: the fitted resistances there
/// stand for the flow as it is, and with a spread at the sides the slow modes of such basins are less accurate.
std::vector<Four> layOutSpread(const DispersionLevel& level, const DispersionGrid& grid, std::size_t k,
                               const WaveLayout& layout, bool has_walls) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const std::array is_periodic{layout.is_periodic_x, layout.is_periodic_z};
  std::vector<Four> out(level.stiffness.size());
  const auto massOf = [&](std::size_t cell, std::size_t axis) {
    const double mass = level.stiffness[cell][axis];
    return !has_walls && mass == 0.0 && grid.isAtSide(cell, axis) && !is_periodic[axis] ? kNone : mass;
  };
  for (int z = 0; z < grid.nz; ++z) {
    for (int x = 0; x < grid.nx; ++x) {
      const std::size_t i = grid.at(x, z);
      std::array<double, 2> smallest{std::min(massOf(i, 0), massOf(grid.at(x - 1, z), 0)),
                                     std::min(massOf(i, 1), massOf(grid.at(x, z - 1), 1))};
      const double both = std::min(smallest[0], smallest[1]);
      if (both == 0.0 || (grid.shareInside(i, 0) == 1.0 && grid.shareInside(i, 1) == 1.0)) smallest = {both, both};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (smallest[axis] == kNone) continue;  // nothing flows along this axis
        for (std::size_t j = 0; j < kPoleCount; ++j) out[i][2 * axis + j] = spreadOf(k)[j] * smallest[axis];
      }
    }
  }
  return out;
}

}  // namespace

double shareAtOnce(double depth_cells) {
  return std::min(DISPERSION_DEPTH_SHARE, DISPERSION_CELL_SHARE / depth_cells);
}

Poles polesAt(double depth_cells) {
  Poles out;
  for (std::size_t k = 0; k < kFittedGridCount; ++k) out.b[k] = bAt(depth_cells, k);
  out.c = cAt(depth_cells);
  return out;
}

std::vector<CellCounts> dispersionGrids(const WaveLayout& layout) {
  constexpr std::size_t kLeastOdd = 4;
  constexpr std::size_t kBottomCells = (DISPERSION_BOTTOM_SIDE_MAX - 1) * (DISPERSION_BOTTOM_SIDE_MAX - 1);
  const auto isOdd = [](std::uint32_t n) { return n > 1 && n % 2 != 0; };
  std::vector<CellCounts> out;
  CellCounts n = layout.counts();
  while (true) {
    const bool is_small = n.x <= kCoarsestSideCount && n.z <= kCoarsestSideCount;
    // Where only one axis is odd, continuing is more accurate than the sweeps of a coarsest grid that is long.
    const bool is_stuck = (layout.is_periodic_x && isOdd(n.x)) || (layout.is_periodic_z && isOdd(n.z));
    const bool ends_odd =
        out.size() >= kLeastOdd && (is_stuck || (isOdd(n.x) && isOdd(n.z))) && n.total() <= kBottomCells;
    if (!out.empty() && (is_small || ends_odd)) {
      out.push_back(n);
      return out;
    }
    if (is_stuck) return {};
    n = {n.x + n.x % 2, n.z + n.z % 2};
    out.push_back(n);
    n = {n.x / 2, n.z / 2};
  }
}

std::size_t bottomOf(const std::vector<CellCounts>& grids) {
  constexpr std::size_t kCells = DISPERSION_BOTTOM_SIDE * DISPERSION_BOTTOM_SIDE;
  constexpr std::size_t kSmallerCells = kCells / 3 + 1;
  std::size_t k = grids.size() - 1;
  std::size_t smaller = 0;
  while (k > 1) {
    smaller += grids[k].total();
    if (grids[k - 1].total() > kCells || smaller > kSmallerCells) break;
    --k;
  }
  return k;
}

std::uint64_t dispersionBytes(const WaveLayout& layout) {
  constexpr std::uint64_t kCoefficients = 16;
  constexpr std::uint64_t kWeights = 16;
  constexpr std::uint64_t kFaces = 2 * 16;  // and their right side
  constexpr std::uint64_t kStrips = 1;      // two lists of words, strips of at least eight cells
  constexpr std::uint64_t kBottom = 4 * 16 + 8;
  const std::vector<CellCounts> grids = dispersionGrids(layout);
  const std::size_t bottom = bottomOf(grids);
  std::uint64_t bytes = layout.counts().total() * 8;
  for (std::size_t k = 0; k < grids.size(); ++k) {
    bytes +=
        grids[k].total() * (kCoefficients + kWeights + kStrips + (k > 0 ? kFaces : 0) + (k >= bottom ? kBottom : 0));
  }
  return bytes;
}

double dispersedMaxStep(double gravity_mps2, double depth_m, double cell_m) {
  constexpr double kMargin = 0.9;
  constexpr double kShortest = 8.0;  // largest eigenvalue of the 5-point Laplacian, in cells
  // Of all depths up to this one: in deeper water the shortest waves can be slower.
  double highest_cells = 0.0;
  double depth_cells = depth_m / cell_m;
  do {
    const Poles poles = polesAt(depth_cells);
    double share = shareAtOnce(depth_cells);
    for (std::size_t j = 0; j < kPoleCount; ++j)
      share += poles.c[j] / (1.0 + poles.b[0][j] * depth_cells * depth_cells * kShortest);
    highest_cells = std::max(highest_cells, depth_cells * share);
    depth_cells *= 0.9;
  } while (depth_cells > 0.1);
  return kMargin * 2.0 * cell_m / std::sqrt(gravity_mps2 * highest_cells * cell_m * kShortest);
}

Dispersion layOutDispersion(const WaveLayout& layout, const Basin& basin) {
  Dispersion out;
  const std::vector<CellCounts> counts = dispersionGrids(layout);
  // The coarsest grid has no cells beyond the water.
  const auto isExact = [&](std::size_t k) {
    return k == 0 ? counts[0] == layout.counts()
                  : counts[k].x * 2 == counts[k - 1].x && counts[k].z * 2 == counts[k - 1].z;
  };
  out.is_flat = basin.is_flat;
  for (std::size_t k = 0; k < counts.size(); ++k) out.is_flat = out.is_flat && isExact(k);
  out.depth_m = layout.dispersing_depth_m;
  out.cell_m = layout.cell_m;
  out.water = layout.counts();
  DispersionGrid grid(counts[0], {static_cast<double>(layout.count_x), static_cast<double>(layout.count_z)});
  out.root_c.resize(grid.wet.size());
  core::forRangesInParallel(basin.depth_m.size(), [&](std::size_t begin, std::size_t end) {
    LastOf last(cAt);
    for (std::size_t cell = begin; cell < end; ++cell) {
      const double depth_m = basin.depth_m[cell];
      if (depth_m <= 0.0) continue;
      const std::size_t i = cell % layout.count_x + counts[0].x * (cell / layout.count_x);
      grid.wet[i] = 1.0;
      grid.depth_m[i] = depth_m;
      for (int axis = 0; axis < 2; ++axis) {
        const double face_m = basin.conductance_m[cell][axis];
        if (face_m <= 0.0 || (axis == 0 ? layout.count_x : layout.count_z) == 1) continue;
        grid.open[i][axis] = 1.0;
        grid.resistance_pm[i][axis] = 1.0 / face_m;
        const auto& c = last(face_m / layout.cell_m);
        for (std::size_t j = 0; j < kPoleCount; ++j) out.root_c[i][2 * axis + j] = std::sqrt(c[j] * out.depth_m);
      }
    }
  });
  if (!out.is_flat) roundToHalves(out.root_c);
  std::vector<DispersionGrid> grids;
  grids.reserve(counts.size());
  grids.push_back(std::move(grid));
  std::vector<CellOwners> owners;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    DispersionLevel& level = out.levels.emplace_back();
    level.count = counts[k];
    if (k + 1 == counts.size()) break;
    Coarsened coarser = coarsen(grids.back(), counts[k + 1]);
    level.from_coarse_x = std::move(coarser.from_coarse_x);
    level.from_coarse_z = std::move(coarser.from_coarse_z);
    owners.push_back(std::move(coarser.owner));
    grids.push_back(std::move(coarser.grid));
  }
  const bool has_walls = !basin.is_flat && std::ranges::any_of(grids, &DispersionGrid::hasWalls);
  if (has_walls) fitResistances(grids, owners);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    DispersionLevel& level = out.levels[k];
    level.stiffness = stiffnessOf(grids[k], k, layout.cell_m, out.depth_m);
    if (!out.is_flat) {
      for (auto* table : {&level.stiffness, &level.from_coarse_x, &level.from_coarse_z}) roundToHalves(*table);
    }
    if (k == 0) continue;
    level.spread = layOutSpread(level, grids[k], k, layout, has_walls);
    if (!out.is_flat) roundToHalves(level.spread);
  }
  return out;
}

std::vector<Four> sweepWeights(const DispersionLevel& level) {
  std::vector<Four> out(level.stiffness.size(), Four{});
  const int nx = static_cast<int>(level.count.x);
  const int nz = static_cast<int>(level.count.z);
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      const Four& here = level.stiffness[level.index(x, z)];
      const std::array there{level.stiffness[level.index(x + 1, z)], level.stiffness[level.index(x, z + 1)]};
      for (int axis = 0; axis < 2; ++axis) {
        if (here[axis] <= 0.0) continue;
        for (std::size_t j = 0; j < kPoleCount; ++j) {
          out[level.index(x, z)][2 * axis + j] = kSweepWeight / (here[axis] + here[2 + j] + there[axis][2 + j]);
        }
      }
    }
  }
  return out;
}

}  // namespace spindrift::sim
