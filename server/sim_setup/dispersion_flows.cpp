#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "dispersion_grid.h"

namespace spindrift::sim {
namespace {

using Cells = std::vector<double>;                 ///< one value per cell
using Faces = std::vector<std::array<double, 2>>;  ///< one value per x and z face

constexpr std::size_t kMotionCount = 4;
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

double dot(const Cells& a, const Cells& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void addTo(Cells& a, double factor, const Cells& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

/// -div d grad on a grid, with the wet shares as areas; lengths in cells of the grid.
class Laplacian {
 public:
  explicit Laplacian(const DispersionGrid& grid) : wet_(grid.wet) {
    for (std::size_t i = 0; i < wet_.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (grid.open[i][axis] > 0.0)
          faces_.push_back({i, grid.behind(i, axis), axis, grid.open[i][axis] / grid.resistance_pm[i][axis]});
      }
    }
  }

  /// Fluxes that belong to the levels: up the slope.
  [[nodiscard]] Faces flux(const Cells& level) const {
    Faces out(level.size());
    for (const Face& face : faces_)
      out[face.from][face.axis] = face.conductance_m * (level[face.to] - level[face.from]);
    return out;
  }

  [[nodiscard]] Cells weighted(Cells level) const {
    for (std::size_t i = 0; i < level.size(); ++i) level[i] *= wet_[i];
    return level;
  }

  /// (-div d grad + shift) level
  [[nodiscard]] Cells apply(const Cells& level, double shift) const {
    Cells out(level.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = shift * wet_[i] * level[i];
    for (const Face& face : faces_) {
      const double flux = face.conductance_m * (level[face.to] - level[face.from]);
      out[face.from] -= flux;
      out[face.to] += flux;
    }
    return out;
  }

  /// <level, -div d grad level>/<level, level> [m]; 0 for a level of 0.
  [[nodiscard]] double eigenvalueOf(const Cells& level) const {
    const double square = dot(level, weighted(level));
    return square > 0.0 ? dot(level, apply(level, 0.0)) / square : 0.0;
  }

  [[nodiscard]] double meanConductance() const {
    double sum = 0.0;
    for (const Face& face : faces_) sum += face.conductance_m;
    return faces_.empty() ? 0.0 : sum / static_cast<double>(faces_.size());
  }

  /// Improves a solution of (-div d grad + shift) level = right by conjugate gradients with the diagonal as
  /// preconditioner. Precondition: shift > 0.
  void improve(Cells& level, const Cells& right, double shift, int iterations) const {
    Cells diagonal(level.size());
    for (std::size_t i = 0; i < diagonal.size(); ++i) diagonal[i] = shift * wet_[i];
    for (const Face& face : faces_) {
      diagonal[face.from] += face.conductance_m;
      diagonal[face.to] += face.conductance_m;
    }
    const auto scaled = [&](Cells x) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = diagonal[i] > 0.0 ? x[i] / diagonal[i] : 0.0;
      return x;
    };
    Cells rest = right;
    addTo(rest, -1.0, apply(level, shift));
    Cells direction = scaled(rest);
    double square = dot(rest, direction);
    for (int k = 0; k < iterations && square > 0.0; ++k) {
      const Cells image = apply(direction, shift);
      const double step = square / dot(direction, image);
      addTo(level, step, direction);
      addTo(rest, -step, image);
      Cells next = scaled(rest);
      const double now = dot(rest, next);
      addTo(next, now / square, direction);
      direction = std::move(next);
      square = now;
    }
  }

 private:
  struct Face {
    std::size_t from, to, axis;
    double conductance_m;
  };
  const Cells& wet_;
  std::vector<Face> faces_;
};

/// Gram-Schmidt with the areas as weights, also against the level surface. What is left of a level that the others make
/// up becomes 0.
void orthonormalize(const Laplacian& laplacian, std::vector<Cells>& levels) {
  std::vector<Cells> done{Cells(levels.front().size(), 1.0)};
  const double area = dot(done.front(), laplacian.weighted(done.front()));
  if (area <= 0.0) return;
  for (double& v : done.front()) v /= std::sqrt(area);
  for (Cells& level : levels) {
    const double before = dot(level, laplacian.weighted(level));
    for (int pass = 0; pass < 2; ++pass) {
      for (const Cells& other : done) addTo(level, -dot(level, laplacian.weighted(other)), other);
    }
    const double square = dot(level, laplacian.weighted(level));
    const double scale = square > 1e-20 * before ? 1 / std::sqrt(square) : 0.0;
    for (double& v : level) v *= scale;
    done.push_back(level);
  }
}

/// The slowest motions on a small grid, by inverse iteration from noise.
std::vector<Cells> slowest(const DispersionGrid& grid) {
  const Laplacian laplacian(grid);
  std::mt19937 random(5);
  std::vector<Cells> levels(kMotionCount, Cells(grid.wet.size()));
  for (Cells& level : levels)
    std::ranges::generate(level, [&] { return static_cast<double>(random()) / 0x1p31 - 1.0; });
  orthonormalize(laplacian, levels);
  // Below the lowest eigenvalue of an open square, and enough for parts without any outflow.
  const double shift =
      laplacian.meanConductance() / (static_cast<double>(std::max(grid.nx, grid.nz)) * std::max(grid.nx, grid.nz));
  for (int round = 0; round < kBaseRounds && shift > 0.0; ++round) {
    for (Cells& level : levels) {
      const Cells right = laplacian.weighted(level);
      std::ranges::fill(level, 0.0);
      laplacian.improve(level, right, shift, kBaseIterations);
    }
    orthonormalize(laplacian, levels);
  }
  return levels;
}

/// A motion on the next finer grid: one inexact inverse iteration from the coarse one.
Cells refined(const Laplacian& coarse, const Cells& level, const Laplacian& fine, const CellOwners& owner) {
  Cells out(owner.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (owner[i]) out[i] = level[*owner[i]];
  }
  const double eigenvalue = coarse.eigenvalueOf(level) / 4;
  if (eigenvalue <= 0.0) return out;
  Cells right = fine.weighted(out);
  for (double& v : right) v *= 2 * eigenvalue;
  fine.improve(out, right, eigenvalue, kIterations);
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
  std::vector<Cells> levels = slowest(grids[base]);
  for (std::size_t k = base; k-- > 0;) {
    const Laplacian fine(grids[k]);
    const Laplacian coarse(grids[k + 1]);
    for (Cells& level : levels) level = refined(coarse, level, fine, owners[k]);
  }
  const Laplacian finest(grids.front());
  std::vector<Motion> motions;
  for (Cells& level : levels) {
    const double eigenvalue_m = finest.eigenvalueOf(level);
    if (eigenvalue_m <= 0.0) continue;
    // The same energy for all.
    const double scale = 1 / std::sqrt(eigenvalue_m * dot(level, finest.weighted(level)));
    for (double& v : level) v *= scale;
    motions.push_back({level, finest.flux(level), eigenvalue_m / finest.meanConductance()});
  }
  double width = 1.0;
  for (std::size_t k = 1; k < grids.size(); ++k) {
    width *= 2;
    for (Motion& motion : motions) motion = coarser(grids[k - 1], grids[k], owners[k - 1], motion);
    fit(grids[k], motions, width);
  }
}

}  // namespace spindrift::sim
