// Dispersion of the wave: an operator F on the faces that takes the place of the face depth in the momentum step, so
// that waves follow omega^2 = g k tanh(k d). Pure functions of the basin; docs/dispersion.md derives them.
//
//   q_t = -g F grad(eta),   F = a + sum_j sqrt(c_j) (1/d - grad (b_j d) div)^-1 sqrt(c_j)
//
// Every factor is symmetric and positive, so the leapfrog conserves energy over any bed and beside any wall, and a wave
// that runs into shallow water keeps its energy flux. The inverse is one V(2,2) cycle of a multigrid method from zero.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <shared/groups.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

using core::CellCounts;

/// Rational terms of F. Two fit in one texel of a cell: (x face, z face) times two.
inline constexpr std::size_t kPoleCount = 2;

/// Returns a/d: what is left of F for the shortest waves. It is the limit of a term with b = 0, and costs no solution.
[[nodiscard]] double shareAtOnce(double depth_cells);

/// Grids with their own b_j; coarser ones have those of the last.
inline constexpr std::size_t kFittedGridCount = 4;

/// Coefficients at one depth: b_j and c_j of the formula above. The coarser grids of the V-cycle have a b_j of their
/// own, finest grid first: that shapes the speeds of waves that those grids resolve.
struct Poles {
  std::array<std::array<double, kPoleCount>, kFittedGridCount> b{};
  std::array<double, kPoleCount> c{};

  [[nodiscard]] const std::array<double, kPoleCount>& bOf(std::size_t grid) const {
    return b[std::min(grid, kFittedGridCount - 1)];
  }
};

/// Returns the coefficients for water of this depth in cells, fitted to the phase and group speeds that the V-cycle has
/// (tool tests/tools/fit_dispersion.cpp): for depths of 1 to 45 cells and kd up to 10, phase speeds within 1 % for
/// waves of 8 cells and longer and 2.5 % for 4 cells, group speeds within 4 % for waves of 8 cells and longer.
[[nodiscard]] Poles polesAt(double depth_cells);

/// One grid of the V-cycle: cells x fastest. Each cell owns the faces toward +x and +z. A face variable is the
/// flux through the open part of the face per width of the whole face. Arrays of four: x face of pole 0 and 1, then z
/// face of pole 0 and 1.
struct DispersionLevel {
  /// Counts of the storage: even but for the coarsest grid, so an axis may end with a row of dry cells beyond the
  /// water.
  CellCounts count;
  /// 1/d of the x face and of the z face (of coarse faces beside walls: their resistance), over their open share; b_0 d
  /// and b_1 d of the cell, over its wet share and the squared cell size of this grid; all times the scene's depth. 0
  /// where closed or dry.
  std::vector<std::array<double, 4>> stiffness;
  /// f_0 and f_1 of the cell along x, then along z: spreadOf() the grid times the smallest 1/d of its four faces (over
  /// their open share), times the scene's depth; closed sides of the water do not count. Where walls or
  /// ground close faces within the water it is 0 beside all closed faces. In cells that are in part beyond the water,
  /// the smallest along each axis. Empty in the finest grid.
  std::vector<std::array<double, 4>> spread;
  /// Weights of the x and the z face in the coarser grid's faces E, W, N, S of the same block. Empty in the coarsest
  /// grid.
  std::vector<std::array<double, 4>> from_coarse_x;
  std::vector<std::array<double, 4>> from_coarse_z;

  [[nodiscard]] std::size_t index(int x, int z) const {
    const int nx = static_cast<int>(count.x);
    const int nz = static_cast<int>(count.z);
    if (x < 0 || x >= nx) x = (x + nx) % nx;
    if (z < 0 || z >= nz) z = (z + nz) % nz;
    return static_cast<std::size_t>(x + nx * z);
  }
};

/// All numbers fit in 16 bits (core::roundToHalf()), except where it is flat.
struct Dispersion {
  double depth_m = 0.0;  ///< the scene's
  double cell_m = 0.0;
  CellCounts water;  ///< cells of the wave: the first ones along each axis of the finest grid
  /// Finest first, at least two; their cells are those of dispersionGrids().
  std::vector<DispersionLevel> levels;
  std::vector<std::array<double, 4>> root_c;  ///< sqrt(c_j * scene's depth [m]) on the finest faces; 0 where closed
  /// A flat basin whose grids have no cells beyond the water: each table has one value, and 0 at closed faces.
  bool is_flat = false;
};

/// Returns f_j d of a grid of the V-cycle, 0 being the finest. On coarse grids K phi = phi/d - grad(b_j d div phi - f_j
/// D phi), where D takes the difference across a cell along the axis of the face alone; fluxes that are linear inside a
/// block have a mass matrix with f d = 1/8. Chosen so that waves along the axes and along the diagonals are equally
/// fast; none on grid 2, where it would give waves of 8 cells along an axis two frequencies. Less than 1/4, so K is
/// positive.
[[nodiscard]] constexpr std::array<double, kPoleCount> spreadOf(std::size_t grid) {
  if (grid == 1) return {0.12, 0.20};
  if (grid >= 3) return {0.14, 0.14};
  return {0.0, 0.0};
}

/// Weight of the damped Jacobi sweeps.
inline constexpr double kSweepWeight = DISPERSION_SWEEP_WEIGHT;
/// Sweeps before and after the coarser grid, and in the coarsest one.
inline constexpr int kSweepCount = 2;
inline constexpr int kCoarsestSweepCount = DISPERSION_COARSEST_SWEEPS;
/// Returns the storage of each grid of the V-cycle, finest first. Each has half as many cells along each axis as the
/// one before, rounded up; where there is no partner to halve with, a row or column of dry cells is added, which a
/// periodic side cannot have. The last one has at most four cells along each axis, or, at least four grids down, an odd
/// number along both or along a periodic one. Empty where a periodic side stands in the way: multiples of 16 up to 496
/// always have grids.
[[nodiscard]] std::vector<CellCounts> dispersionGrids(const WaveLayout& layout);

/// Returns whether the wave has grids for the V-cycle.
[[nodiscard]] inline bool canDisperse(const WaveLayout& layout) {
  return !dispersionGrids(layout).empty();
}

/// Returns the number of the first grid that one work group solves, with all coarser ones: one with at most
/// DISPERSION_BOTTOM_SIDE squared cells, or the coarsest.
[[nodiscard]] std::size_t bottomOf(const std::vector<CellCounts>& grids);

/// Bytes of its buffers on the device, at most. Precondition: canDisperse().
[[nodiscard]] std::uint64_t dispersionBytes(const WaveLayout& layout);

/// Returns the largest stable step [s]: 2 over the highest frequency of the grid, with the dispersion's coefficients at
/// any depth up to depth_m, with a margin.
[[nodiscard]] double dispersedMaxStep(double gravity_mps2, double depth_m, double cell_m);

/// Lays out the grids for a basin with the 5-point stencil. Precondition: canDisperse().
[[nodiscard]] Dispersion layOutDispersion(const WaveLayout& layout, const Basin& basin);

/// Returns kSweepWeight over the diagonal of the operator for each face of a grid, over the scene's depth; 0 where
/// closed.
[[nodiscard]] std::vector<std::array<double, 4>> sweepWeights(const DispersionLevel& level);

}  // namespace spindrift::sim
