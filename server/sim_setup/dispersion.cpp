#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/sim_setup/half.h>

#include "dispersion_flows.h"
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

template <std::size_t kCount>
void roundToHalves(std::vector<std::array<double, kCount>>& texels) {
  for (auto& texel : texels) std::ranges::transform(texel, texel.begin(), roundToHalf);
}

/// `k`: number of the grid, 0 for the finest, whose cells have `finest_m`.
std::vector<Four> stiffnessOf(const DispersionGrid& grid, std::size_t k, double finest_m, double scene_depth_m) {
  const double cell_m = std::ldexp(finest_m, static_cast<int>(k));
  std::vector<Four> out(grid.wet.size(), Four{});
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      if (grid.open[i][axis] > 0.0) out[i][axis] = scene_depth_m * grid.resistance_pm[i][axis] / grid.open[i][axis];
    }
    if (grid.wet[i] <= 0.0) continue;
    const auto b = bAt(grid.depth_m[i] / finest_m, k);
    for (std::size_t j = 0; j < kPoleCount; ++j)
      out[i][2 + j] = scene_depth_m * b[j] * grid.depth_m[i] / (grid.wet[i] * cell_m * cell_m);
  }
  return out;
}

/// DispersionLevel::spread of grid k, a coarse one. In a flat basin, whose only closed faces are its sides, all cells
/// have the same. In others the cells beside closed faces have none: the fitted resistances there stand for the flow as
/// it is.
std::vector<std::array<double, kPoleCount>> layOutSpread(const DispersionLevel& level, std::size_t k, bool is_flat) {
  std::vector<std::array<double, kPoleCount>> out(level.stiffness.size());
  const int n = static_cast<int>(level.side_count);
  const auto massOf = [&](int x, int z, int axis) {
    const double mass = level.stiffness[level.index(x, z)][axis];
    return is_flat && mass == 0.0 ? std::numeric_limits<double>::infinity() : mass;
  };
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const double smallest = std::min({massOf(x, z, 0), massOf(x, z, 1), massOf(x - 1, z, 0), massOf(x, z - 1, 1)});
      for (std::size_t j = 0; j < kPoleCount; ++j) out[level.index(x, z)][j] = spreadOf(k)[j] * smallest;
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

bool canDisperse(std::uint32_t resolution_count) {
  while (resolution_count > kBottomSideMax && resolution_count % 2 == 0) resolution_count /= 2;
  return resolution_count <= kBottomSideMax;
}

std::uint64_t dispersionBytes(std::uint32_t resolution_count) {
  constexpr std::uint64_t kCoefficients = 16;
  constexpr std::uint64_t kWeights = 16;
  constexpr std::uint64_t kFaces = 2 * 16;  // and their right side
  constexpr std::uint64_t kBottom = 4 * 16 + 8;
  const auto cells = [](std::uint32_t n) { return std::uint64_t{n} * n; };
  std::uint32_t n = resolution_count;
  std::uint64_t bytes = cells(n) * (kCoefficients + kWeights + 8);
  while (n > kCoarsestSideCount && n % 2 == 0) {
    n /= 2;
    bytes += cells(n) * (kCoefficients + kWeights + kFaces + (n <= kBottomSideMax ? kBottom : 0));
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
  out.is_flat = basin.is_flat;
  out.depth_m = layout.dispersing_depth_m;
  out.cell_m = layout.cell_m;
  DispersionGrid grid(static_cast<int>(layout.resolution_count));
  out.root_c.resize(grid.wet.size());
  for (std::size_t i = 0; i < grid.wet.size(); ++i) {
    const double depth_m = basin.depth_m[i];
    if (depth_m <= 0.0) continue;
    grid.wet[i] = 1.0;
    grid.depth_m[i] = depth_m;
    for (int axis = 0; axis < 2; ++axis) {
      const double face_m = basin.conductance_m[i][axis];
      if (face_m <= 0.0) continue;
      grid.open[i][axis] = 1.0;
      grid.resistance_pm[i][axis] = 1.0 / face_m;
      const auto c = cAt(face_m / layout.cell_m);
      for (std::size_t j = 0; j < kPoleCount; ++j) out.root_c[i][2 * axis + j] = std::sqrt(c[j] * out.depth_m);
    }
  }
  if (!out.is_flat) roundToHalves(out.root_c);
  std::vector<DispersionGrid> grids{std::move(grid)};
  std::vector<CellOwners> owners;
  while (true) {
    DispersionLevel& level = out.levels.emplace_back();
    const auto side_count = static_cast<std::uint32_t>(grids.back().n);
    level.side_count = side_count;
    if (out.levels.size() > 1 && (side_count <= kCoarsestSideCount || side_count % 2 != 0)) break;
    Coarsened coarser = coarsen(grids.back());
    level.from_coarse_x = std::move(coarser.from_coarse_x);
    level.from_coarse_z = std::move(coarser.from_coarse_z);
    owners.push_back(std::move(coarser.owner));
    grids.push_back(std::move(coarser.grid));
  }
  if (!out.is_flat) fitResistances(grids, owners);
  for (std::size_t k = 0; k < grids.size(); ++k) {
    DispersionLevel& level = out.levels[k];
    level.stiffness = stiffnessOf(grids[k], k, layout.cell_m, out.depth_m);
    if (!out.is_flat) {
      for (auto* table : {&level.stiffness, &level.from_coarse_x, &level.from_coarse_z}) roundToHalves(*table);
    }
    if (k == 0) continue;
    level.spread = layOutSpread(level, k, out.is_flat);
    if (!out.is_flat) roundToHalves(level.spread);
  }
  return out;
}

std::vector<Four> sweepWeights(const DispersionLevel& level) {
  std::vector<Four> out(level.stiffness.size(), Four{});
  const int n = static_cast<int>(level.side_count);
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
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
