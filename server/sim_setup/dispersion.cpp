#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/sim_setup/half.h>

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

/// A grid while it is laid out, in doubles. `open`: open share of the x and z face; `resistance`: mean of 1/d over it
/// [1/m]; `wet`: wet share of the cell; `depth`: mean over it [m].
struct Grid {
  int n = 0;
  std::vector<std::array<double, 2>> open;
  std::vector<std::array<double, 2>> resistance_pm;
  std::vector<double> wet;
  std::vector<double> depth_m;

  explicit Grid(int side_count) : n(side_count) {
    const auto cells = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    open.resize(cells);
    resistance_pm.resize(cells);
    wet.resize(cells);
    depth_m.resize(cells);
  }
  [[nodiscard]] std::size_t at(int x, int z) const { return static_cast<std::size_t>((x + n) % n + n * ((z + n) % n)); }
};

/// The four cells of a block: (0, 0), (1, 0), (0, 1), (1, 1). Its inner faces lead from one of them to another.
struct InnerFace {
  int from, to, axis;
};
constexpr InnerFace kInnerFaces[] = {{0, 1, 0}, {2, 3, 0}, {0, 2, 1}, {1, 3, 1}};

std::array<std::size_t, 4> blockOf(const Grid& fine, int x, int z) {
  return {fine.at(2 * x, 2 * z), fine.at(2 * x + 1, 2 * z), fine.at(2 * x, 2 * z + 1), fine.at(2 * x + 1, 2 * z + 1)};
}

/// Marks, in each block, the cells of the largest part that is connected inside the block: a wall can divide a block,
/// and a coarse cell can stand for one side of it only.
std::vector<bool> findMembers(const Grid& fine) {
  std::vector<bool> is_member(fine.wet.size(), false);
  for (int z = 0; z < fine.n / 2; ++z) {
    for (int x = 0; x < fine.n / 2; ++x) {
      const auto block = blockOf(fine, x, z);
      std::array<int, 4> part{0, 1, 2, 3};
      for (int round = 0; round < 3; ++round) {
        for (const InnerFace& face : kInnerFaces) {
          if (fine.open[block[face.from]][face.axis] <= 0.0) continue;
          part[face.from] = part[face.to] = std::min(part[face.from], part[face.to]);
        }
      }
      std::array<double, 4> size{};
      for (int k = 0; k < 4; ++k) size[part[k]] += fine.wet[block[k]];
      const auto largest = static_cast<int>(std::ranges::max_element(size) - size.begin());
      for (int k = 0; k < 4; ++k) is_member[block[k]] = part[k] == largest && fine.wet[block[k]] > 0.0;
    }
  }
  return is_member;
}

/// The two fine faces that a coarse face toward +x (axis 0) or +z covers, and the cells behind them.
struct Covered {
  std::array<std::size_t, 2> face;
  std::array<std::size_t, 2> behind;
};
Covered coveredBy(const Grid& fine, int x, int z, int axis) {
  if (axis == 0) {
    return {{fine.at(2 * x + 1, 2 * z), fine.at(2 * x + 1, 2 * z + 1)},
            {fine.at(2 * x + 2, 2 * z), fine.at(2 * x + 2, 2 * z + 1)}};
  }
  return {{fine.at(2 * x, 2 * z + 1), fine.at(2 * x + 1, 2 * z + 1)},
          {fine.at(2 * x, 2 * z + 2), fine.at(2 * x + 1, 2 * z + 2)}};
}

/// Flux through the inner faces of a block for a net inflow of each cell: the one of least energy. The flux is the
/// difference of a potential, found by Gauss-Seidel iteration over at most four cells.
std::array<double, 4> innerFlux(const std::array<double, 4>& open, const std::array<double, 4>& inflow) {
  constexpr int kRounds = 200;
  std::array<double, 4> potential{};
  for (int round = 0; round < kRounds; ++round) {
    double largest_change = 0.0;
    for (int k = 0; k < 4; ++k) {
      double sum = -inflow[k];
      double weight = 0.0;
      for (int e = 0; e < 4; ++e) {
        const auto [from, to, axis] = kInnerFaces[e];
        if (from != k && to != k) continue;
        weight += open[e];
        sum += open[e] * potential[from == k ? to : from];
      }
      if (weight <= 0.0) continue;
      largest_change = std::max(largest_change, std::abs(sum / weight - potential[k]));
      potential[k] = sum / weight;
    }
    if (largest_change < 1e-15) break;
  }
  std::array<double, 4> flux{};
  for (int e = 0; e < 4; ++e) flux[e] = open[e] * (potential[kInnerFaces[e].from] - potential[kInnerFaces[e].to]);
  return flux;
}

/// Fills `level` with the weights of the fine faces in the coarse ones and returns the coarse grid. A coarse flux
/// passes the open part of its face evenly; inside the block it goes where every cell gains the same height.
Grid coarsen(const Grid& fine, DispersionLevel& level) {
  const std::vector<bool> is_member = findMembers(fine);
  Grid coarse(fine.n / 2);
  level.from_coarse_x.assign(fine.wet.size(), Four{});
  level.from_coarse_z.assign(fine.wet.size(), Four{});
  const auto weightsOf = [&](int axis) -> std::vector<Four>& {
    return axis == 0 ? level.from_coarse_x : level.from_coarse_z;
  };
  for (int z = 0; z < coarse.n; ++z) {
    for (int x = 0; x < coarse.n; ++x) {
      const std::size_t i = coarse.at(x, z);
      for (const std::size_t cell : blockOf(fine, x, z)) {
        if (!is_member[cell]) continue;
        coarse.wet[i] += fine.wet[cell] / 4;
        coarse.depth_m[i] += fine.wet[cell] * fine.depth_m[cell] / 4;
      }
      if (coarse.wet[i] > 0.0) coarse.depth_m[i] /= coarse.wet[i];
      for (int axis = 0; axis < 2; ++axis) {
        const Covered covered = coveredBy(fine, x, z, axis);
        double open = 0.0;
        double resistance = 0.0;
        for (int k = 0; k < 2; ++k) {
          const std::size_t face = covered.face[k];
          if (!is_member[face] || !is_member[covered.behind[k]]) continue;
          open += fine.open[face][axis];
          resistance += fine.open[face][axis] * fine.resistance_pm[face][axis];
        }
        if (open <= 0.0) continue;
        coarse.open[i][axis] = open / 2;
        coarse.resistance_pm[i][axis] = resistance / open;
        for (int k = 0; k < 2; ++k) {
          const std::size_t face = covered.face[k];
          if (is_member[face] && is_member[covered.behind[k]])
            weightsOf(axis)[face][axis == 0 ? 0 : 2] = fine.open[face][axis] / coarse.open[i][axis];
        }
      }
    }
  }
  // The faces around a block and the direction in which a flux through them leaves it.
  struct Side {
    int x, z, axis;
    double outward;
  };
  constexpr Side kSides[] = {{0, 0, 0, 1.0}, {-1, 0, 0, -1.0}, {0, 0, 1, 1.0}, {0, -1, 1, -1.0}};
  for (int z = 0; z < coarse.n; ++z) {
    for (int x = 0; x < coarse.n; ++x) {
      const auto block = blockOf(fine, x, z);
      const double wet = 4 * coarse.wet[coarse.at(x, z)];
      if (wet <= 0.0) continue;
      std::array<double, 4> open{};
      for (int e = 0; e < 4; ++e) {
        const auto [from, to, axis] = kInnerFaces[e];
        if (is_member[block[from]] && is_member[block[to]]) open[e] = fine.open[block[from]][axis];
      }
      const bool is_open_block = wet == 4.0 && open == std::array{1.0, 1.0, 1.0, 1.0};
      for (int side = 0; side < 4; ++side) {
        const auto& [dx, dz, axis, outward] = kSides[side];
        if (coarse.open[coarse.at(x + dx, z + dz)][axis] <= 0.0) continue;
        // Outflow of each cell through this side for a unit of coarse flux, and what it lacks to lose as much per area
        // as the others.
        std::array<double, 4> out{};
        double total = 0.0;
        for (int k = 0; k < 2; ++k) {
          const Covered covered = coveredBy(fine, x + dx, z + dz, axis);
          const std::size_t cell = outward > 0 ? covered.face[k] : covered.behind[k];
          const double share = weightsOf(axis)[covered.face[k]][axis == 0 ? 0 : 2];
          out[static_cast<std::size_t>(std::ranges::find(block, cell) - block.begin())] += outward * share;
          total += outward * share;
        }
        std::array<double, 4> inflow{};
        for (int k = 0; k < 4; ++k) {
          if (is_member[block[k]]) inflow[k] = out[k] - total * fine.wet[block[k]] / wet;
        }
        // In an open block, half of the coarse flux passes each inner face of its axis.
        const std::array<double, 4> flux =
            is_open_block ? (axis == 0 ? Four{0.5, 0.5, 0.0, 0.0} : Four{0.0, 0.0, 0.5, 0.5}) : innerFlux(open, inflow);
        for (int e = 0; e < 4; ++e) weightsOf(kInnerFaces[e].axis)[block[kInnerFaces[e].from]][side] = flux[e];
      }
    }
  }
  return coarse;
}

template <std::size_t kCount>
void roundToHalves(std::vector<std::array<double, kCount>>& texels) {
  for (auto& texel : texels) std::ranges::transform(texel, texel.begin(), roundToHalf);
}

/// `k`: number of the grid, 0 for the finest, whose cells have `finest_m`.
std::vector<Four> stiffnessOf(const Grid& grid, std::size_t k, double finest_m, double scene_depth_m) {
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

/// DispersionLevel::spread of grid k, a coarse one.
std::vector<std::array<double, kPoleCount>> layOutSpread(const DispersionLevel& level, std::size_t k) {
  std::vector<std::array<double, kPoleCount>> out(level.stiffness.size());
  const int n = static_cast<int>(level.side_count);
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const Four& here = level.stiffness[level.index(x, z)];
      double smallest = 0.0;
      for (const double mass :
           {here[0], here[1], level.stiffness[level.index(x - 1, z)][0], level.stiffness[level.index(x, z - 1)][1]}) {
        if (mass > 0.0 && (smallest == 0.0 || mass < smallest)) smallest = mass;
      }
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
  Grid grid(static_cast<int>(layout.resolution_count));
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
  while (true) {
    DispersionLevel level;
    level.side_count = static_cast<std::uint32_t>(grid.n);
    level.stiffness = stiffnessOf(grid, out.levels.size(), layout.cell_m, out.depth_m);
    const bool is_coarsest =
        !out.levels.empty() && (level.side_count <= kCoarsestSideCount || level.side_count % 2 != 0);
    if (!is_coarsest) grid = coarsen(grid, level);
    if (!out.is_flat) {
      for (auto* table : {&level.stiffness, &level.from_coarse_x, &level.from_coarse_z}) roundToHalves(*table);
    }
    if (!out.levels.empty()) level.spread = layOutSpread(level, out.levels.size());
    if (!out.is_flat) roundToHalves(level.spread);
    out.levels.push_back(std::move(level));
    if (is_coarsest) return out;
  }
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
