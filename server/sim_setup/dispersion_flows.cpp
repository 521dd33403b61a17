// Resistances of the coarse grids from the slowest motions of the water.
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <spindrift/core/parallel.h>

#include "laplacian.h"

namespace spindrift::sim {
namespace {

/// The motions are found on the finest grid of at most so many cells per side, then refined grid by grid.
constexpr int kBaseSide = 16;
constexpr int kBaseRounds = 12;
constexpr int kBaseIterations = 40;
constexpr int kIterations = 20;
/// Bounds of the change of a resistance.
constexpr double kLeast = 0.3;
constexpr double kMost = 2.5;
/// A face keeps its resistance if the power of its fluxes is small against this share of the mean of all faces.
constexpr double kWeakShare = 1e-3;
/// Over an even bed without walls, the mean levels of two cells of width h differ by (k h)^2/12 less than the slope
/// between them, for a wave with wave number k along this axis. The coefficients are fitted to a cycle that has this
/// error, so it is taken out. In an even mixture of directions, the flux along an axis belongs to waves with 3/4 of
/// their k^2 along it.
constexpr double kAlongShare = 0.75;

/// Gram-Schmidt with the areas as weights, also against the level surface. What is left of a level that the others make
/// up becomes 0.
void orthonormalize(const Laplacian& laplacian, Pairs& levels) {
  const std::size_t cells = levels[0].size();
  const auto value = [&](std::size_t motion, std::size_t i) { return levels[motion / 2][i][motion % 2]; };
  const auto product = [&](std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < cells; ++i) sum += value(a, i) * (value(b, i) * laplacian.wet(i));
    return sum;
  };
  double area = 0.0;
  for (std::size_t i = 0; i < cells; ++i) area += laplacian.wet(i);
  if (area <= 0.0) return;
  const double even = 1.0 / std::sqrt(area);
  for (std::size_t m = 0; m < kMotionCount; ++m) {
    const auto add = [&](std::size_t i, double v) { levels[m / 2][i][m % 2] += v; };
    const double before = product(m, m);
    for (int pass = 0; pass < 2; ++pass) {
      double mean = 0.0;
      for (std::size_t i = 0; i < cells; ++i) mean += value(m, i) * (even * laplacian.wet(i));
      for (std::size_t i = 0; i < cells; ++i) add(i, -mean * even);
      for (std::size_t other = 0; other < m; ++other) {
        const double factor = -product(m, other);
        for (std::size_t i = 0; i < cells; ++i) add(i, factor * value(other, i));
      }
    }
    const double square = product(m, m);
    const double scale = square > 1e-20 * before ? 1 / std::sqrt(square) : 0.0;
    for (Two& level : levels[m / 2]) level[m % 2] *= scale;
  }
}

/// The slowest motions on a small grid, by inverse iteration from noise.
Pairs slowest(const DispersionGrid& grid) {
  const Laplacian laplacian(grid);
  std::mt19937 random(5);
  Pairs levels{Levels(grid.wet.size()), Levels(grid.wet.size())};
  for (std::size_t m = 0; m < kMotionCount; ++m) {
    for (Two& level : levels[m / 2]) level[m % 2] = static_cast<double>(random()) / 0x1p31 - 1.0;
  }
  orthonormalize(laplacian, levels);
  // Below the lowest eigenvalue of an open square, and enough for parts without any outflow.
  const double side = std::max(grid.nx, grid.nz);
  const double shift = laplacian.meanConductance() / (side * side);
  for (int round = 0; round < kBaseRounds && shift > 0.0; ++round) {
    for (Levels& pair : levels) {
      Levels right = laplacian.weighted(std::exchange(pair, Levels(pair.size())), Two{1.0, 1.0});
      laplacian.improve(pair, std::move(right), Two{shift, shift}, kBaseIterations);
    }
    orthonormalize(laplacian, levels);
  }
  return levels;
}

/// The motions on the next finer grid: one inexact inverse iteration from the coarse ones.
Levels refined(const Laplacian& coarse, const Levels& levels, const Laplacian& fine, const CellOwners& owner) {
  Levels out(owner.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (owner[i]) out[i] = levels[*owner[i]];
  }
  Two eigenvalue;
  coarse.findEigenvalues(levels, eigenvalue);
  eigenvalue /= 4.0;
  fine.improve(out, fine.weighted(out, 2.0 * eigenvalue), eigenvalue, kIterations);
  return out;
}

/// A motion as a grid sees it: mean levels of the cells, fluxes through the faces per width of a face, and k^2
/// [1/cells^2 of the finest grid].
struct Motion {
  Cells level;
  Faces flux;
  double k_squared = 0.0;
};

/// The open face between two cells, and the sign of a flux from the first to the second; none if they have no such
/// face.
struct FaceBetween {
  std::size_t cell, axis;
  double sign;
};
std::optional<FaceBetween> faceBetween(const DispersionGrid& grid, std::size_t from, std::size_t to) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (grid.behind(from, axis) == to && grid.open[from][axis] > 0.0) return FaceBetween{from, axis, 1.0};
    if (grid.behind(to, axis) == from && grid.open[to][axis] > 0.0) return FaceBetween{to, axis, -1.0};
  }
  return {};
}

void addFlux(const DispersionGrid& grid, std::size_t from, std::size_t to, double flux, Faces& out) {
  if (const auto face = faceBetween(grid, from, to)) {
    out[face->cell][face->axis] += face->sign * flux;
    return;
  }
  // Where a strip behind a wall ends, cells meet that have no common face: by way of a neighbour of both.
  const int x = static_cast<int>(from) % grid.nx;
  const int z = static_cast<int>(from) / grid.nx;
  for (const std::size_t by : {grid.at(x + 1, z), grid.at(x - 1, z), grid.at(x, z + 1), grid.at(x, z - 1)}) {
    const auto first = faceBetween(grid, from, by);
    const auto second = faceBetween(grid, by, to);
    if (!first || !second) continue;
    out[first->cell][first->axis] += first->sign * flux;
    out[second->cell][second->axis] += second->sign * flux;
    return;
  }
}

Motion coarser(const DispersionGrid& fine, const DispersionGrid& coarse, const CellOwners& owner,
               const Motion& motion) {
  Motion out{Cells(coarse.wet.size(), 0.0), Faces(coarse.wet.size()), motion.k_squared};
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (!owner[i]) continue;
    out.level[*owner[i]] += fine.wet[i] * motion.level[i] / (4 * coarse.wet[*owner[i]]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double flux = motion.flux[i][axis] / 2;
      const auto& behind = owner[fine.behind(i, axis)];
      if (flux != 0.0 && behind && behind != owner[i]) addFlux(coarse, *owner[i], *behind, flux, out.flux);
    }
  }
  return out;
}

/// Cells at an obstructed face, and those beside them along it.
std::vector<bool> besideWalls(const DispersionGrid& grid) {
  std::vector<bool> out(grid.wet.size(), false);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int x = static_cast<int>(i) % grid.nx;
    const int z = static_cast<int>(i) / grid.nx;
    for (int along = -1; along <= 1; ++along) {
      for (int across = 0; across <= 1; ++across) {
        if (grid.isObstructed(i, 0)) out[grid.at(x + across, z + along)] = true;
        if (grid.isObstructed(i, 1)) out[grid.at(x + along, z + across)] = true;
      }
    }
  }
  return out;
}

/// Fits the resistances of a grid whose cells are `width` cells of the finest one wide.
void fit(DispersionGrid& grid, const std::vector<Motion>& motions, double width) {
  struct Sums {
    double measured = 0.0;  ///< slope of the mean levels times flux
    double mean = 0.0;      ///< the same with the mean resistance
  };
  const auto sumsOf = [&](std::size_t i, std::size_t axis) {
    Sums out;
    for (const Motion& motion : motions) {
      const double flux = motion.flux[i][axis];
      const double slope = (motion.level[grid.behind(i, axis)] - motion.level[i]) / width;
      constexpr double kAtLeast = 0.3;  // motions that are short for this grid
      out.measured += slope * flux / std::max(kAtLeast, 1 - kAlongShare * motion.k_squared * width * width / 12);
      out.mean += grid.resistance_pm[i][axis] / grid.open[i][axis] * flux * flux;
    }
    return out;
  };
  const auto forEachOpen = [&](const auto& visit) {
    for (std::size_t i = 0; i < grid.wet.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (grid.open[i][axis] > 0.0) visit(i, axis);
      }
    }
  };
  double weak = 0.0;
  double count = 0.0;
  forEachOpen([&](std::size_t i, std::size_t axis) {
    weak += sumsOf(i, axis).mean;
    count += 1.0;
  });
  if (!(weak > 0.0)) return;
  weak *= kWeakShare / count;
  const std::vector<bool> is_beside = besideWalls(grid);
  std::vector<std::array<double, 2>> fitted = grid.resistance_pm;
  forEachOpen([&](std::size_t i, std::size_t axis) {
    if (!is_beside[i] && !is_beside[grid.behind(i, axis)]) return;
    const Sums sums = sumsOf(i, axis);
    fitted[i][axis] *= std::clamp((sums.measured + weak) / (sums.mean + weak), kLeast, kMost);
  });
  grid.resistance_pm = std::move(fitted);
}

}  // namespace

void fitResistances(std::vector<DispersionGrid>& grids, const std::vector<CellOwners>& owners) {
  std::size_t base = 0;
  while (base + 1 < grids.size() && std::max(grids[base].nx, grids[base].nz) > kBaseSide) ++base;
  Pairs levels = slowest(grids[base]);
  std::vector<Laplacian> laplacians;
  for (std::size_t k = 0; k <= base; ++k) laplacians.emplace_back(grids[k]);
  core::forEachInParallel(levels.size(), [&](std::size_t pair) {
    for (std::size_t k = base; k-- > 0;)
      levels[pair] = refined(laplacians[k + 1], levels[pair], laplacians[k], owners[k]);
  });
  const Laplacian& finest = laplacians.front();
  std::vector<Motion> motions;
  for (Levels& pair : levels) {
    Two eigenvalues_m, squares;
    finest.findEigenvalues(pair, eigenvalues_m);
    finest.findSquares(pair, squares);
    for (std::size_t m = 0; m < 2; ++m) {
      if (eigenvalues_m[m] <= 0.0) continue;
      // The same energy for all.
      const double scale = 1 / std::sqrt(eigenvalues_m[m] * squares[m]);
      Motion& motion = motions.emplace_back();
      for (Two& level : pair) motion.level.push_back(level[m] *= scale);
      motion.flux = finest.flux(pair, m);
      motion.k_squared = eigenvalues_m[m] / finest.meanConductance();
    }
  }
  double width = 1.0;
  for (std::size_t k = 1; k < grids.size(); ++k) {
    width *= 2;
    for (Motion& motion : motions) motion = coarser(grids[k - 1], grids[k], owners[k - 1], motion);
    fit(grids[k], motions, width);
  }
}

}  // namespace spindrift::sim
