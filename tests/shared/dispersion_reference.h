// The dispersion's V-cycle in double precision, one grid and one face at a time as sim_setup/dispersion.h defines it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

class DispersionReference {
 public:
  using Four = std::array<double, 4>;
  using Faces = std::vector<Four>;  ///< per cell: x face of pole 0 and 1, z face of pole 0 and 1

  explicit DispersionReference(Dispersion dispersion) : dispersion_(std::move(dispersion)) {
    for (const DispersionLevel& level : dispersion_.levels) sweep_.push_back(sweepWeights(level));
  }

  [[nodiscard]] const Dispersion& dispersion() const { return dispersion_; }

  /// Returns F grad(eta) at the x and the z face of each cell of the wave, for a level at each: [m] times the level's
  /// unit.
  [[nodiscard]] std::vector<std::array<double, 2>> apply(const std::vector<double>& level) const {
    const Faces phi = poles(level);
    std::vector<std::array<double, 2>> out(level.size());
    const DispersionLevel& finest = dispersion_.levels.front();
    const CellCounts water = dispersion_.water;
    forEach(finest, [&](int x, int z, std::size_t i) {
      if (x >= static_cast<int>(water.x) || z >= static_cast<int>(water.z)) return;
      const std::size_t cell = cellOf(x, z);
      const std::array<double, 2> slope = slopeAt(level, x, z);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double stiffness = finest.stiffness[i][axis];
        if (stiffness > 0.0) {
          const double depth_m = dispersion_.depth_m / stiffness;
          out[cell][axis] = shareAtOnce(depth_m / dispersion_.cell_m) * depth_m * slope[axis];
        }
        for (std::size_t j = 0; j < kPoleCount; ++j)
          out[cell][axis] += dispersion_.root_c[i][2 * axis + j] * phi[i][2 * axis + j];
      }
    });
    return out;
  }

  /// The terms of the sum before their last factor sqrt(c_j).
  [[nodiscard]] Faces poles(const std::vector<double>& level) const {
    const DispersionLevel& finest = dispersion_.levels.front();
    Faces right(finest.stiffness.size());
    forEach(finest, [&](int x, int z, std::size_t i) {
      const std::array<double, 2> slope = slopeAt(level, x, z);
      for (std::size_t k = 0; k < 4; ++k) right[i][k] = dispersion_.root_c[i][k] * slope[k / 2];
    });
    return cycle(0, right);
  }

 private:
  template <typename Visit>
  static void forEach(const DispersionLevel& grid, const Visit& visit) {
    for (int z = 0; z < static_cast<int>(grid.count.z); ++z) {
      for (int x = 0; x < static_cast<int>(grid.count.x); ++x) visit(x, z, grid.index(x, z));
    }
  }

  /// The cell of the wave; in place of dry cells of the storage, one that counts for nothing.
  [[nodiscard]] std::size_t cellOf(int x, int z) const {
    const CellCounts grid = dispersion_.levels.front().count;
    const auto along = [](int i, std::uint32_t stored, std::uint32_t cells) {
      return std::min(static_cast<std::uint32_t>(i) % stored, cells - 1);
    };
    return along(x, grid.x, dispersion_.water.x) + dispersion_.water.x * along(z, grid.z, dispersion_.water.z);
  }
  [[nodiscard]] std::array<double, 2> slopeAt(const std::vector<double>& level, int x, int z) const {
    const double here = level[cellOf(x, z)];
    return {level[cellOf(x + 1, z)] - here, level[cellOf(x, z + 1)] - here};
  }

  /// r - K phi
  static Faces left(const DispersionLevel& grid, const Faces& right, const Faces& phi) {
    Faces pressed(phi.size());  // of cells, along x and along z
    forEach(grid, [&](int x, int z, std::size_t i) {
      for (std::size_t j = 0; j < 2; ++j) {
        const double along_x = phi[i][j] - phi[grid.index(x - 1, z)][j];
        const double along_z = phi[i][2 + j] - phi[grid.index(x, z - 1)][2 + j];
        const Four spread = grid.spread.empty() ? Four{} : grid.spread[i];
        pressed[i][j] = grid.stiffness[i][2 + j] * (along_x + along_z) - spread[j] * along_x;
        pressed[i][2 + j] = grid.stiffness[i][2 + j] * (along_x + along_z) - spread[2 + j] * along_z;
      }
    });
    Faces out(phi.size());
    forEach(grid, [&](int x, int z, std::size_t i) {
      for (std::size_t j = 0; j < 2; ++j) {
        out[i][j] = right[i][j] - grid.stiffness[i][0] * phi[i][j] + pressed[grid.index(x + 1, z)][j] - pressed[i][j];
        out[i][2 + j] = right[i][2 + j] - grid.stiffness[i][1] * phi[i][2 + j] + pressed[grid.index(x, z + 1)][2 + j] -
                        pressed[i][2 + j];
      }
    });
    return out;
  }

  void sweep(std::size_t k, const Faces& right, Faces& phi) const {
    const Faces rest = left(dispersion_.levels[k], right, phi);
    for (std::size_t i = 0; i < phi.size(); ++i) {
      for (std::size_t f = 0; f < 4; ++f) phi[i][f] += sweep_[k][i][f] * rest[i][f];
    }
  }

  /// Calls visit(fine face, its component, coarse cell, component, weight) for pole 0 and 1.
  template <typename Visit>
  static void forEachWeight(const DispersionLevel& fine, const DispersionLevel& coarse, const Visit& visit) {
    forEach(fine, [&](int x, int z, std::size_t i) {
      const int bx = x / 2;
      const int bz = z / 2;
      const std::size_t cell[4] = {coarse.index(bx, bz), coarse.index(bx - 1, bz), coarse.index(bx, bz),
                                   coarse.index(bx, bz - 1)};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Four& weights = axis == 0 ? fine.from_coarse_x[i] : fine.from_coarse_z[i];
        for (std::size_t side = 0; side < 4; ++side) {
          for (std::size_t j = 0; j < 2; ++j) visit(i, 2 * axis + j, cell[side], 2 * (side / 2) + j, weights[side]);
        }
      }
    });
  }

  [[nodiscard]] Faces cycle(std::size_t k, const Faces& right) const {
    const DispersionLevel& grid = dispersion_.levels[k];
    Faces phi(right.size());
    const bool is_coarsest = k + 1 == dispersion_.levels.size();
    for (int s = 0; s < (is_coarsest ? kCoarsestSweepCount : kSweepCount); ++s) sweep(k, right, phi);
    if (is_coarsest) return phi;
    const DispersionLevel& coarse = dispersion_.levels[k + 1];
    const Faces rest = left(grid, right, phi);
    Faces coarse_right(coarse.stiffness.size());
    forEachWeight(grid, coarse, [&](std::size_t i, std::size_t f, std::size_t c, std::size_t g, double weight) {
      coarse_right[c][g] += weight * rest[i][f] / 4;
    });
    const Faces correction = cycle(k + 1, coarse_right);
    forEachWeight(grid, coarse, [&](std::size_t i, std::size_t f, std::size_t c, std::size_t g, double weight) {
      phi[i][f] += weight * correction[c][g];
    });
    for (int s = 0; s < kSweepCount; ++s) sweep(k, right, phi);
    return phi;
  }

  Dispersion dispersion_;
  std::vector<Faces> sweep_;
};

}  // namespace spindrift::sim
